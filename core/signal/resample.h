#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace kingpin::signal {

/// How values between the samples of a record are defined.
enum class Interpolant {
  /// Straight lines: error O(h²), never leaves the range of its two neighbours.
  kLinear,
  /// Piecewise cubic with a continuous first derivative: in each interval the Hermite cubic whose
  /// end slopes are those of the parabola through the sample and its two neighbours (at the ends of
  /// the record, through the outer three). Exact for parabolas on any grid; error O(h³), O(h⁴) on a
  /// uniform grid away from its ends. Local: a spike reaches two intervals far.
  kCubic,
};

std::string_view ToString(Interpolant interpolant);

/// Values of the record (time strictly increasing, at least one sample) at `new_time`; outside the
/// record the end values are held.
std::vector<double> MakeResampled(std::span<const double> time, std::span<const double> value,
                                  std::span<const double> new_time, Interpolant interpolant);

/// True if every time lies within 0.1 % of a step from a uniform grid over the whole record: files
/// print times with few digits.
bool IsUniform(std::span<const double> time);

/// A record with one step between all its samples.
struct UniformRecord {
  double start = 0.0;      ///< [s]
  double time_step = 0.0;  ///< [s]
  std::vector<double> value;
  bool resampled = false;  ///< false: the samples of the file as they are
};

/// The record on a uniform grid. A uniform record is returned as it is (unless `time_step` asks for
/// another step). A non-uniform one is resampled over its whole span with a step of at most
/// `time_step`, or, when that is 0, of the shortest interval in the record, but no more than
/// 8 times as many samples as it has: an integrator with a variable step takes short steps
/// where something happens, and that must not be lost. The number of intervals is rounded up to a
/// length that is fast to transform.
UniformRecord MakeUniform(std::span<const double> time, std::span<const double> value,
                          Interpolant interpolant, double time_step = 0.0);

}  // namespace kingpin::signal
