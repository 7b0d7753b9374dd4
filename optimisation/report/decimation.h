#pragma once

#include <vector>

namespace kingpin::report {

/// A point of a drawing, in pixels; y may be NaN, which interrupts the line.
struct PixelPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Splits a line at its gaps and thins each piece: of all consecutive points in one column of
/// `column` pixels, the first, the lowest, the highest and the last stay, in their order. Extremes
/// of the line therefore survive, and what is drawn differs by less than a column.
std::vector<std::vector<PixelPoint>> DecimateLine(const std::vector<PixelPoint>& points,
                                                  double column);

}  // namespace kingpin::report
