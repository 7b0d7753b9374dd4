#include "optimisation/report/scatter_chart.h"

#include <algorithm>
#include <cmath>

#include "optimisation/report/line_chart.h"

namespace kingpin::report {
namespace {

void AddPoint(Series& series, const ParetoFront& front, const ParetoPoint& point) {
  series.x.push_back(point.x * front.x_unit.per_si);
  series.y.push_back(point.y * front.y_unit.per_si);
  series.labels.push_back(point.name);
}

}  // namespace

std::string DrawParetoChart(const ParetoFront& front, double width) {
  LineChart chart;
  chart.title = front.name;
  chart.width = width;
  chart.height = 0.62 * width;
  chart.hover = false;
  chart.x = {.name = front.x_name, .unit = front.x_unit.text};
  chart.y = {.name = front.y_name, .unit = front.y_unit.text};
  if (!front.dominated.empty()) {
    Series other;
    other.name = "other designs tried";
    other.line = false;
    other.markers = true;
    other.filled = false;
    other.style = {"#c4c4c4", "", 1.0, Marker::kCircle};
    for (const ParetoPoint& p : front.dominated) AddPoint(other, front, p);
    chart.series.push_back(std::move(other));
  }
  if (!front.front.empty()) {
    Series line;
    line.name = "Pareto front";
    line.markers = true;
    line.steps = true;
    line.style = StyleOf(1);
    std::vector<ParetoPoint> sorted = front.front;
    std::erase_if(sorted,
                  [](const ParetoPoint& p) { return !std::isfinite(p.x) || !std::isfinite(p.y); });
    std::sort(sorted.begin(), sorted.end(), [](const ParetoPoint& a, const ParetoPoint& b) {
      return a.x != b.x ? a.x < b.x : a.y < b.y;
    });
    // With less y for more x, y holds until the next larger x; when more x is better (and costs y),
    // the staircase runs the other way.
    if (!sorted.empty() && sorted.back().y > sorted.front().y) {
      std::reverse(sorted.begin(), sorted.end());
    }
    for (const ParetoPoint& p : sorted) AddPoint(line, front, p);
    chart.series.push_back(std::move(line));
  }
  if (!front.marked.empty()) {
    Series marked;
    marked.name = "named designs";
    marked.line = false;
    marked.markers = true;
    marked.style = {"#D55E00", "", 1.0, Marker::kDiamond};
    for (const ParetoPoint& p : front.marked) AddPoint(marked, front, p);
    chart.series.push_back(std::move(marked));
  }
  return DrawLineChart(chart);
}

}  // namespace kingpin::report
