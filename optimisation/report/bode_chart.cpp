#include "optimisation/report/bode_chart.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "optimisation/report/html.h"
#include "optimisation/report/line_chart.h"

namespace kingpin::report {

std::vector<double> CalcUnwrappedPhaseDegrees(const std::vector<std::complex<double>>& response) {
  std::vector<double> phase;
  phase.reserve(response.size());
  double last = kMissing;
  for (const std::complex<double>& h : response) {
    const double gain = std::abs(h);
    if (!std::isfinite(gain) || gain == 0.0) {
      phase.push_back(kMissing);
      continue;
    }
    double degrees = std::arg(h) * 180.0 / std::numbers::pi;
    if (std::isfinite(last)) degrees += 360.0 * std::round((last - degrees) / 360.0);
    last = degrees;
    phase.push_back(degrees);
  }
  return phase;
}

std::string DrawBodeChart(const BodeChart& chart) {
  LineChart gain;
  gain.title = chart.title + ": gain";
  gain.width = chart.width;
  gain.height = 250.0;
  gain.x = {.name = "Frequency", .unit = "Hz", .scale = Scale::kLog};
  gain.y = {.name = "Gain", .unit = chart.unit, .scale = Scale::kLog};
  LineChart phase = gain;
  phase.title = chart.title + ": phase";
  phase.height = 180.0;
  phase.legend = false;
  phase.y = {.name = "Phase", .unit = "deg"};
  double low = 0.0;
  double high = 0.0;
  for (const BodeSeries& s : chart.series) {
    Series g;
    g.name = s.name;
    g.style = s.style;
    g.x = s.frequency_hz;
    Series p = g;
    for (const std::complex<double>& h : s.response) g.y.push_back(std::abs(h));
    p.y = CalcUnwrappedPhaseDegrees(s.response);
    for (const double v : p.y) {
      low = std::fmin(low, v);
      high = std::fmax(high, v);
    }
    gain.series.push_back(std::move(g));
    phase.series.push_back(std::move(p));
  }
  const double step = high - low > 540.0 ? 180.0 : 90.0;
  if (high - low < 5400.0) {
    for (double t = step * std::floor(low / step); t <= high + step; t += step) {
      phase.y.ticks.push_back(t);
    }
  }
  return fmt::format("<figure class=\"chart\"><figcaption>{}</figcaption>{}{}</figure>\n",
                     SymbolHtml(chart.title), DrawLineChartSvg(gain), DrawLineChartSvg(phase));
}

}  // namespace kingpin::report
