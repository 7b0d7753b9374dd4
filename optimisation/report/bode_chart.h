#pragma once

#include <complex>
#include <string>
#include <vector>

#include "optimisation/report/series_style.h"

namespace kingpin::report {

struct BodeSeries {
  std::string name{};
  std::vector<double> frequency_hz{};
  std::vector<std::complex<double>> response{};  ///< in the shown unit
  SeriesStyle style{};
};

struct BodeChart {
  std::string title{};
  std::string unit{};  ///< of the gain
  std::vector<BodeSeries> series{};
  double width = 540.0;
};

/// Gain (both axes logarithmic) over phase in degrees. The phase is unwrapped along the frequency
/// and starts in (-180°, 180°]; points where the gain vanishes or is not finite leave a gap.
std::string DrawBodeChart(const BodeChart& chart);

/// Phase in degrees without jumps of more than half a turn; NaN where the gain is 0 or not finite.
std::vector<double> CalcUnwrappedPhaseDegrees(const std::vector<std::complex<double>>& response);

}  // namespace kingpin::report
