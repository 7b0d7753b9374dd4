#pragma once

#include <string>
#include <vector>

#include "optimisation/report/series_style.h"
#include "optimisation/report/study_report_data.h"

namespace kingpin::report {

enum class Scale { kLinear, kLog };

/// Values are shown as they are: convert before. A NaN limit is taken from the data, with a margin.
struct Axis {
  std::string name{};
  std::string unit{};
  Scale scale = Scale::kLinear;  ///< logarithmic axes leave out what is not positive
  double min = kMissing;
  double max = kMissing;
  bool include_zero = false;
  std::vector<double> ticks{};  ///< empty: chosen
};

struct Series {
  std::string name{};
  std::vector<double> x{};  ///< a NaN or an infinity in x or y interrupts the line
  std::vector<double> y{};
  SeriesStyle style{};
  bool line = true;
  bool steps = false;                 ///< a value holds until the next x
  bool markers = false;               ///< a marker at each point
  bool filled = true;                 ///< markers filled
  bool secondary = false;             ///< belongs to the axis on the right
  std::vector<std::string> labels{};  ///< beside the points; may be shorter
};

struct Band {
  std::string name{};
  std::vector<double> x{};
  std::vector<double> lower{};
  std::vector<double> upper{};
};

struct ReferenceLine {
  bool vertical = false;
  double value = 0.0;
  std::string name{};
};

struct LineChart {
  std::string title{};
  Axis x{};
  Axis y{};
  Axis right{};  ///< used when a series is secondary
  std::vector<Series> series{};
  std::vector<Band> bands{};
  std::vector<ReferenceLine> reference_lines{};
  double width = 540.0;  ///< pixels; the drawing scales with the page
  double height = 300.0;
  bool legend = true;
  bool hover = true;  ///< read-out under the pointer
  std::string css{};  ///< further classes of the <figure>
};

/// <figure> with a caption and a static SVG drawing. Data that cannot be drawn (empty, all NaN, one
/// point, absurd range) give a drawing that says so or shows what it can; they never throw.
std::string DrawLineChart(const LineChart& chart);

/// The same drawing without <figure>, as wide as the chart, to put several under one caption.
std::string DrawLineChartSvg(const LineChart& chart);

/// A strip with the names of the series, for a group of charts without legends of their own.
std::string DrawLegend(const std::vector<Series>& series, double width);

}  // namespace kingpin::report
