#pragma once

#include <string>
#include <vector>

#include "optimisation/report/line_chart.h"

namespace kingpin::report {

/// One axis after its range and ticks are chosen, and the map from values to pixels.
class AxisMap {
 public:
  /// Range from the axis' limits, else from the values (NaN, infinite and, on a logarithmic axis,
  /// non-positive ones do not count).
  AxisMap(const Axis& axis, const std::vector<double>& values, double margin, int wanted_ticks);

  void SetPixels(double at_low, double at_high);
  /// NaN for what cannot be drawn.
  double ToPixel(double value) const;

  bool has_data() const { return has_data_; }
  bool logarithmic() const { return logarithmic_; }
  double low() const { return low_; }
  double high() const { return high_; }
  const std::vector<double>& ticks() const { return ticks_; }
  const std::vector<std::string>& labels() const { return labels_; }
  /// Name, unit and the power of ten taken out of the labels; escaped.
  std::string MakeTitle() const;
  /// `[pixel at low, pixel at high, low, high, logarithmic]` for the read-out script.
  std::string MakeScript() const;
  double CalcLabelWidth(double font_size) const;

 private:
  std::string name_;
  std::string unit_;
  bool logarithmic_ = false;
  bool has_data_ = false;
  double low_ = 0.0;
  double high_ = 1.0;
  double pixel_low_ = 0.0;
  double pixel_high_ = 1.0;
  std::vector<double> ticks_;
  std::vector<std::string> labels_;
  int exponent_ = 0;
};

}  // namespace kingpin::report
