#include "optimisation/report/line_chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/decimation.h"
#include "optimisation/report/html.h"
#include "optimisation/report/label_placer.h"
#include "optimisation/report/plot_area.h"
#include "optimisation/report/svg.h"

namespace kingpin::report {
namespace {

constexpr double kFont = 11.0;
constexpr double kLegendRow = 17.0;
constexpr double kSwatch = 26.0;

struct LegendItem {
  std::string name;
  const Series* series = nullptr;  ///< null: a band
};

struct LegendRows {
  std::string svg;
  double height = 0.0;
};

LegendRows DrawLegendRows(const std::vector<LegendItem>& items, double left, double right,
                          double top) {
  LegendRows rows;
  double x = left;
  double y = top + 0.5 * kLegendRow;
  if (items.empty()) return rows;
  for (const LegendItem& item : items) {
    const double needed = kSwatch + 6.0 + EstimateTextWidth(item.name, kFont) + 16.0;
    if (x > left && x + needed > right) {
      x = left;
      y += kLegendRow;
    }
    if (item.series == nullptr) {
      rows.svg += fmt::format(R"(<rect class="band" x="{}" y="{}" width="{}" height="10"/>)",
                              FormatPixel(x), FormatPixel(y - 5), FormatPixel(kSwatch));
    } else {
      const Series& s = *item.series;
      if (s.line) {
        rows.svg +=
            fmt::format(R"(<path class="ln" d="M{0},{2}L{1},{2}"{3}/>)", FormatPixel(x),
                        FormatPixel(x + kSwatch), FormatPixel(y), StrokeAttributes(s.style));
      }
      if (s.markers) {
        rows.svg += SvgMarker(s.style.marker, x + 0.5 * kSwatch, y, 3.2, s.style.colour, s.filled);
      }
    }
    rows.svg += SvgText(x + kSwatch + 6.0, y + 0.36 * kFont, "start", SymbolSvg(item.name));
    x += needed;
  }
  rows.height = y + 0.5 * kLegendRow - top;
  return rows;
}

std::vector<LegendItem> MakeLegendItems(const LineChart& chart) {
  std::vector<LegendItem> items;
  for (const Series& s : chart.series) {
    if (!s.name.empty()) items.push_back({s.name, &s});
  }
  for (const Band& b : chart.bands) {
    if (!b.name.empty()) items.push_back({b.name, nullptr});
  }
  return items;
}

std::string MakePath(const std::vector<PixelPoint>& points, double column) {
  std::string d;
  for (const std::vector<PixelPoint>& piece : DecimateLine(points, column)) {
    std::string last;
    const char* command = "M";
    for (const PixelPoint& p : piece) {
      std::string text = FormatPoint(p.x, p.y);
      if (text == last) continue;
      d += command;
      d += text;
      last = std::move(text);
      command = "L";
    }
    // A single point between two gaps would be invisible.
    if (piece.size() == 1) d += "h0.1";
  }
  return d;
}

std::string DrawBand(const Band& band, const AxisMap& x, const AxisMap& y) {
  const size_t n = std::min({band.x.size(), band.lower.size(), band.upper.size()});
  std::vector<std::string> lower;
  std::vector<std::string> upper;
  for (size_t i = 0; i < n; ++i) {
    const double px = x.ToPixel(band.x[i]);
    const double low = y.ToPixel(band.lower[i]);
    const double high = y.ToPixel(band.upper[i]);
    if (std::isnan(px) || std::isnan(low) || std::isnan(high)) continue;
    lower.push_back(FormatPoint(px, low));
    upper.push_back(FormatPoint(px, high));
  }
  if (lower.size() < 2) return {};
  std::reverse(upper.begin(), upper.end());
  return fmt::format(R"(<path class="band" d="M{}L{}Z"/>)", fmt::join(lower, "L"),
                     fmt::join(upper, "L"));
}

std::string DrawSeries(const Series& s, const AxisMap& x, const AxisMap& y) {
  const size_t n = std::min(s.x.size(), s.y.size());
  std::vector<PixelPoint> points;
  points.reserve(s.steps ? 2 * n : n);
  for (size_t i = 0; i < n; ++i) {
    const PixelPoint p = {x.ToPixel(s.x[i]), y.ToPixel(s.y[i])};
    if (s.steps && !points.empty() && std::isfinite(p.x)) points.push_back({p.x, points.back().y});
    points.push_back(std::isnan(p.x) ? PixelPoint{0.0, kMissing} : p);
  }
  std::string out;
  if (s.line) {
    const std::string d = MakePath(points, 1.0);
    if (!d.empty()) {
      out += fmt::format(R"(<path class="ln" data-name="{}"{} d="{}"{}/>)", EscapeHtml(s.name),
                         s.secondary ? R"( data-right="1")" : "", d, StrokeAttributes(s.style));
    }
  }
  if (s.markers) {
    for (size_t i = 0; i < n; ++i) {
      out += SvgMarker(s.style.marker, x.ToPixel(s.x[i]), y.ToPixel(s.y[i]), 3.2, s.style.colour,
                       s.filled);
    }
  }
  return out;
}

std::vector<double> CollectValues(const LineChart& chart, bool secondary) {
  std::vector<double> values;
  for (const Series& s : chart.series) {
    if (s.secondary != secondary) continue;
    const size_t n = std::min(s.x.size(), s.y.size());
    for (size_t i = 0; i < n; ++i) {
      // Only what lies within a fixed x range decides about the y range.
      if ((std::isfinite(chart.x.min) && s.x[i] < chart.x.min) ||
          (std::isfinite(chart.x.max) && s.x[i] > chart.x.max) || !std::isfinite(s.x[i])) {
        continue;
      }
      values.push_back(s.y[i]);
    }
  }
  if (!secondary) {
    for (const Band& b : chart.bands) {
      values.insert(values.end(), b.lower.begin(), b.lower.end());
      values.insert(values.end(), b.upper.begin(), b.upper.end());
    }
    for (const ReferenceLine& r : chart.reference_lines) {
      if (!r.vertical) values.push_back(r.value);
    }
  }
  return values;
}

}  // namespace

std::string DrawLineChartSvg(const LineChart& chart) {
  const bool has_right = std::any_of(chart.series.begin(), chart.series.end(),
                                     [](const Series& s) { return s.secondary; });
  std::vector<double> xs;
  for (const Series& s : chart.series) {
    const size_t n = std::min(s.x.size(), s.y.size());
    for (size_t i = 0; i < n; ++i) {
      if (std::isfinite(s.y[i])) xs.push_back(s.x[i]);
    }
  }
  for (const Band& b : chart.bands) xs.insert(xs.end(), b.x.begin(), b.x.end());
  const bool scatter = std::none_of(chart.series.begin(), chart.series.end(),
                                    [](const Series& s) { return s.line && !s.steps; });
  AxisMap x(chart.x, xs, scatter ? 0.05 : 0.0, static_cast<int>(chart.width / 75.0));
  AxisMap y(chart.y, CollectValues(chart, false), 0.05, static_cast<int>(chart.height / 48.0));
  AxisMap right_axis(chart.right, CollectValues(chart, true), 0.05,
                     static_cast<int>(chart.height / 48.0));

  const LegendRows legend =
      chart.legend ? DrawLegendRows(MakeLegendItems(chart), 4.0, chart.width, 0.0) : LegendRows{};
  // At least 30 pixels for the labels, so that stacked charts line up.
  const double left = 26.0 + std::max(30.0, y.CalcLabelWidth(kFont));
  const double right = chart.width - (has_right ? 28.0 + right_axis.CalcLabelWidth(kFont) : 12.0);
  const double top = legend.height + 9.0;
  const double bottom = chart.height - 36.0;
  x.SetPixels(left, right);
  y.SetPixels(bottom, top);
  right_axis.SetPixels(bottom, top);

  std::string hover;
  if (chart.hover && x.has_data() && (y.has_data() || right_axis.has_data())) {
    hover = fmt::format(R"( data-x="{}" data-y="{}" data-xname="{}" data-yname="{}")",
                        x.MakeScript(), y.MakeScript(), WithUnit(chart.x.name, chart.x.unit),
                        EscapeHtml(PrettyUnit(chart.y.unit)));
    if (has_right) hover += fmt::format(R"( data-y2="{}")", right_axis.MakeScript());
  }
  std::string out =
      fmt::format(R"(<svg class="plot" viewBox="0 0 {} {}" role="img" aria-label="{}"{}>)",
                  FormatPixel(chart.width), FormatPixel(chart.height),
                  EscapeHtml(chart.title.empty() ? chart.y.name : chart.title), hover);
  out += legend.svg;
  out += R"(<g class="grid">)";
  for (const double tick : x.ticks())
    out += SvgLine(x.ToPixel(tick), top, x.ToPixel(tick), bottom, "g");
  for (const double tick : y.ticks())
    out += SvgLine(left, y.ToPixel(tick), right, y.ToPixel(tick), "g");
  if (!y.logarithmic() && y.low() < 0.0 && y.high() > 0.0) {
    out += SvgLine(left, y.ToPixel(0.0), right, y.ToPixel(0.0), "zero");
  }
  out += "</g>";

  // A nested drawing of its own clips what lies outside the axes without needing an id.
  out += fmt::format(R"(<svg x="{0}" y="{1}" width="{2}" height="{3}" viewBox="{0} {1} {2} {3}">)",
                     FormatPixel(left), FormatPixel(top), FormatPixel(right - left),
                     FormatPixel(bottom - top));
  for (const Band& b : chart.bands) out += DrawBand(b, x, y);
  for (const Series& s : chart.series) {
    out += DrawSeries(s, x, s.secondary ? right_axis : y);
  }
  out += "</svg>";
  LabelPlacer labels(left, top, right, bottom);
  for (const Series& s : chart.series) {
    for (size_t i = 0; i < std::min({s.x.size(), s.y.size(), s.labels.size()}); ++i) {
      const double py = (s.secondary ? right_axis : y).ToPixel(s.y[i]);
      labels.Add(x.ToPixel(s.x[i]), py, s.labels[i]);
    }
  }
  out += labels.Draw("halo");
  for (const ReferenceLine& r : chart.reference_lines) {
    const double p = r.vertical ? x.ToPixel(r.value) : y.ToPixel(r.value);
    if (std::isnan(p) || (r.vertical ? p < left || p > right : p < top || p > bottom)) continue;
    if (r.vertical) {
      out += SvgLine(p, top, p, bottom, "ref");
      const bool flip = p + EstimateTextWidth(r.name, kFont) + 8.0 > right;
      out += SvgText(flip ? p - 4 : p + 4, top + kFont, flip ? "end" : "start", SymbolSvg(r.name),
                     "halo small");
    } else {
      out += SvgLine(left, p, right, p, "ref");
      out += SvgText(right - 4, p - 4, "end", SymbolSvg(r.name), "halo small");
    }
  }
  if (!y.has_data() && !right_axis.has_data()) {
    out +=
        SvgText(0.5 * (left + right), 0.5 * (top + bottom), "middle", "no data to draw", "muted");
  }

  out += fmt::format(R"(<rect class="frame" x="{}" y="{}" width="{}" height="{}"/>)",
                     FormatPixel(left), FormatPixel(top), FormatPixel(right - left),
                     FormatPixel(bottom - top));
  for (size_t i = 0; i < x.ticks().size(); ++i) {
    out +=
        SvgText(x.ToPixel(x.ticks()[i]), bottom + kFont + 4.0, "middle", EscapeHtml(x.labels()[i]));
  }
  for (size_t i = 0; i < y.ticks().size(); ++i) {
    out += SvgText(left - 6.0, y.ToPixel(y.ticks()[i]) + 0.36 * kFont, "end",
                   EscapeHtml(y.labels()[i]));
  }
  out += SvgText(0.5 * (left + right), chart.height - 5.0, "middle", x.MakeTitle(), "at");
  const auto vertical_title = [&](double px, const std::string& title) {
    return fmt::format(
        R"svg(<text class="at" text-anchor="middle" transform="translate({},{})rotate(-90)">{}</text>)svg",
        FormatPixel(px), FormatPixel(0.5 * (top + bottom)), title);
  };
  out += vertical_title(11.0, y.MakeTitle());
  if (has_right) {
    for (size_t i = 0; i < right_axis.ticks().size(); ++i) {
      out += SvgText(right + 6.0, right_axis.ToPixel(right_axis.ticks()[i]) + 0.36 * kFont, "start",
                     EscapeHtml(right_axis.labels()[i]));
    }
    out += vertical_title(chart.width - 4.0, right_axis.MakeTitle());
  }
  return out + "</svg>\n";
}

std::string DrawLineChart(const LineChart& chart) {
  return fmt::format("<figure class=\"chart{}\">{}{}</figure>\n",
                     chart.css.empty() ? std::string() : fmt::format(" {}", EscapeHtml(chart.css)),
                     chart.title.empty()
                         ? std::string()
                         : fmt::format("<figcaption>{}</figcaption>", SymbolHtml(chart.title)),
                     DrawLineChartSvg(chart));
}

std::string DrawLegend(const std::vector<Series>& series, double width) {
  std::vector<LegendItem> items;
  items.reserve(series.size());
  for (const Series& s : series) items.push_back({s.name, &s});
  const LegendRows rows = DrawLegendRows(items, 0.0, width, 0.0);
  return fmt::format(
      R"(<svg class="plot legend" viewBox="0 0 {} {}" role="img" aria-label="Legend">{}</svg>)",
      FormatPixel(width), FormatPixel(std::max(rows.height, 1.0)), rows.svg);
}

}  // namespace kingpin::report
