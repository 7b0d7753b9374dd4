#pragma once

#include <string>
#include <vector>

#include "optimisation/report/series_style.h"

namespace kingpin::report {

struct BarSeries {
  std::string name{};
  std::vector<double> values{};  ///< parallel to BarChart::categories; NaN: no bar
  SeriesStyle style{};
};

/// Horizontal bars with sign, one group per category: sensitivities.
struct BarChart {
  std::string title{};  ///< may hold a symbol
  std::string axis_name{};
  std::string unit{};
  std::vector<std::string> categories{};  ///< symbols or names
  std::vector<BarSeries> series{};
  double limit = 0.0;  ///< half range of the axis; 0: from the values
  double width = 360.0;
};

std::string DrawBarChart(const BarChart& chart);

}  // namespace kingpin::report
