#include "optimisation/report/bar_chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/html.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/plot_area.h"
#include "optimisation/report/svg.h"

namespace kingpin::report {

std::string DrawBarChart(const BarChart& chart) {
  constexpr double kFont = 11.0;
  constexpr double kBar = 9.0;
  const double group = kBar * static_cast<double>(std::max<size_t>(chart.series.size(), 1)) + 9.0;
  std::vector<double> values = {0.0};
  for (const BarSeries& s : chart.series)
    values.insert(values.end(), s.values.begin(), s.values.end());
  double left = 40.0;
  for (const std::string& c : chart.categories) {
    left = std::max(left, 14.0 + EstimateTextWidth(c, kFont));
  }
  left = std::min(left, 0.45 * chart.width);
  const double right = chart.width - 14.0;
  const double top = 6.0;
  const double bottom = top + group * static_cast<double>(chart.categories.size()) + 4.0;
  const double height = bottom + 36.0;

  Axis axis = {.name = chart.axis_name, .unit = chart.unit, .include_zero = true};
  if (chart.limit > 0.0) {
    axis.min = -chart.limit;
    axis.max = chart.limit;
  }
  AxisMap x(axis, values, 0.08, 5);
  x.SetPixels(left, right);

  std::string out =
      fmt::format(R"(<svg class="plot" viewBox="0 0 {} {}" role="img" aria-label="{}">)",
                  FormatPixel(chart.width), FormatPixel(height), EscapeHtml(chart.title));
  out += R"(<g class="grid">)";
  for (const double tick : x.ticks())
    out += SvgLine(x.ToPixel(tick), top, x.ToPixel(tick), bottom, "g");
  out += "</g>";
  const double zero = x.ToPixel(0.0);
  for (size_t c = 0; c < chart.categories.size(); ++c) {
    const double y0 = top + group * static_cast<double>(c) + 4.5;
    out += SvgText(left - 8.0, y0 + 0.5 * (group - 9.0) + 0.36 * kFont, "end",
                   SymbolSvg(chart.categories[c]));
    for (size_t k = 0; k < chart.series.size(); ++k) {
      const BarSeries& s = chart.series[k];
      if (c >= s.values.size()) continue;
      const double p = std::clamp(x.ToPixel(s.values[c]), left, right);
      if (std::isnan(p)) continue;
      out += fmt::format(
          R"(<rect x="{}" y="{}" width="{}" height="{}" fill="{}" stroke="{}"><title>{}: {}</title></rect>)",
          FormatPixel(std::min(zero, p)), FormatPixel(y0 + kBar * static_cast<double>(k)),
          FormatPixel(std::abs(p - zero)), FormatPixel(kBar - 1.5), EscapeHtml(s.style.colour),
          EscapeHtml(s.style.colour), EscapeHtml(s.name), FormatNumber(s.values[c], 3));
    }
  }
  out += SvgLine(zero, top, zero, bottom, "zero");
  out += fmt::format(R"(<rect class="frame" x="{}" y="{}" width="{}" height="{}"/>)",
                     FormatPixel(left), FormatPixel(top), FormatPixel(right - left),
                     FormatPixel(bottom - top));
  for (size_t i = 0; i < x.ticks().size(); ++i) {
    out +=
        SvgText(x.ToPixel(x.ticks()[i]), bottom + kFont + 4.0, "middle", EscapeHtml(x.labels()[i]));
  }
  out += SvgText(0.5 * (left + right), height - 5.0, "middle", x.MakeTitle(), "at");
  return fmt::format("<figure class=\"chart\"><figcaption>{}</figcaption>{}</svg></figure>\n",
                     SymbolHtml(chart.title), out);
}

}  // namespace kingpin::report
