#include "core/signal/resample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/signal/fft.h"

namespace kingpin::signal {

namespace {

/// Slope at t_b of the parabola through (t_a, a), (t_b, b), (t_c, c); the three in any order.
double CalcParabolaSlope(double t_a, double a, double t_b, double b, double t_c, double c) {
  const double left = (b - a) / (t_b - t_a);
  const double right = (c - b) / (t_c - t_b);
  return (left * (t_c - t_b) + right * (t_b - t_a)) / (t_c - t_a);
}

double CalcSlope(std::span<const double> t, std::span<const double> x, std::size_t i) {
  const std::size_t n = t.size();
  if (n == 2) return (x[1] - x[0]) / (t[1] - t[0]);
  if (i == 0) return CalcParabolaSlope(t[1], x[1], t[0], x[0], t[2], x[2]);
  if (i == n - 1) {
    return CalcParabolaSlope(t[n - 2], x[n - 2], t[n - 1], x[n - 1], t[n - 3], x[n - 3]);
  }
  return CalcParabolaSlope(t[i - 1], x[i - 1], t[i], x[i], t[i + 1], x[i + 1]);
}

}  // namespace

std::string_view ToString(Interpolant interpolant) {
  return interpolant == Interpolant::kLinear
             ? "straight lines"
             : "piecewise cubic with the slopes of the parabolas through three samples";
}

std::vector<double> MakeResampled(std::span<const double> time, std::span<const double> value,
                                  std::span<const double> new_time, Interpolant interpolant) {
  const std::size_t n = time.size();
  std::vector<double> result;
  result.reserve(new_time.size());
  for (const double t : new_time) {
    if (n == 1 || t <= time.front()) {
      result.push_back(value.front());
      continue;
    }
    if (t >= time.back()) {
      result.push_back(value.back());
      continue;
    }
    const auto above = std::upper_bound(time.begin(), time.end(), t);
    const auto i = static_cast<std::size_t>(above - time.begin()) - 1;
    const double h = time[i + 1] - time[i];
    const double s = (t - time[i]) / h;
    if (interpolant == Interpolant::kLinear) {
      result.push_back(value[i] + s * (value[i + 1] - value[i]));
      continue;
    }
    const double slope_0 = CalcSlope(time, value, i) * h;
    const double slope_1 = CalcSlope(time, value, i + 1) * h;
    const double step = value[i + 1] - value[i];
    result.push_back(value[i] + s * (slope_0 + s * (3.0 * step - 2.0 * slope_0 - slope_1 +
                                                    s * (slope_0 + slope_1 - 2.0 * step))));
  }
  return result;
}

bool IsUniform(std::span<const double> time) {
  if (time.size() < 3) return true;
  const double step = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double expected = time.front() + static_cast<double>(i) * step;
    if (!(std::abs(time[i] - expected) <= 1e-3 * step)) return false;
  }
  return true;
}

UniformRecord MakeUniform(std::span<const double> time, std::span<const double> value,
                          Interpolant interpolant, double time_step) {
  UniformRecord record;
  record.start = time.front();
  const double span = time.back() - time.front();
  const auto intervals = static_cast<double>(time.size() - 1);
  if (time.size() < 2) {
    record.value.assign(value.begin(), value.end());
    return record;
  }
  const double own_step = span / intervals;
  if (IsUniform(time) && (time_step <= 0.0 || std::abs(time_step - own_step) <= 1e-6 * own_step)) {
    record.time_step = own_step;
    record.value.assign(value.begin(), value.end());
    return record;
  }
  if (time_step <= 0.0) {
    time_step = own_step;
    for (std::size_t i = 0; i + 1 < time.size(); ++i) {
      time_step = std::min(time_step, time[i + 1] - time[i]);
    }
    time_step = std::max(time_step, own_step / 8.0);
  }
  // The tolerance keeps 1 s / 1 ms at 1000 intervals.
  const auto wanted = static_cast<std::size_t>(std::ceil(span / time_step * (1.0 - 1e-9)));
  const std::size_t count = CalcFastLength(std::max<std::size_t>(wanted, 1));
  record.resampled = true;
  record.time_step = span / static_cast<double>(count);
  std::vector<double> grid(count + 1);
  for (std::size_t i = 0; i <= count; ++i) {
    grid[i] = record.start + static_cast<double>(i) * record.time_step;
  }
  record.value = MakeResampled(time, value, grid, interpolant);
  return record;
}

}  // namespace kingpin::signal
