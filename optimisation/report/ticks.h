#pragma once

#include <string>
#include <vector>

namespace kingpin::report {

/// Round positions (1, 2 or 5 times a power of ten apart) inside [low, high], about `wanted` of
/// them. Needs low < high, both finite; otherwise one tick at low.
std::vector<double> MakeTicks(double low, double high, int wanted);

/// Positions for a logarithmic axis, 0 < low < high: powers of ten, and 2 and 5 times these when
/// there are fewer than three decades; every n-th power when there are many.
std::vector<double> MakeLogTicks(double low, double high, int wanted);

/// Labels with one number of decimals. Large or small values are divided by 10^exponent (a multiple
/// of three), which the axis title must then show.
struct TickLabels {
  std::vector<std::string> texts;
  int exponent = 0;
};
TickLabels MakeTickLabels(const std::vector<double>& ticks);

/// Labels of a logarithmic axis: plain from 0.001 to 10 000, else powers of ten.
std::vector<std::string> MakeLogTickLabels(const std::vector<double>& ticks);

}  // namespace kingpin::report
