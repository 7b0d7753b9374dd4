#include "optimisation/measures/companions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/signal/running_integral.h"
#include "optimisation/measures/gammas.h"

namespace kingpin::measures {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool IsFinite(std::span<const double> record) {
  return std::all_of(record.begin(), record.end(), [](double x) { return std::isfinite(x); });
}

std::vector<double> MakeRunningIntegral(std::span<const double> function, double time_step) {
  std::vector<double> integral(function.size());
  signal::UpdateRunningIntegral(signal::Quadrature::kCubic, time_step, function, integral);
  return integral;
}

/// max over t of √(1/τ ∫_{t−τ}^t a² dt), from the running integral of a² (whose slopes are a²).
double CalcLargestRunningRms(std::span<const double> running, double time_step, double window) {
  const double steps = window / time_step;
  double largest = 0.0;
  for (std::size_t i = 0; i < running.size(); ++i) {
    const double start = static_cast<double>(i) - steps;
    double before = 0.0;
    if (start > 0.0) {
      const auto cell = static_cast<std::size_t>(start);
      const double s = start - static_cast<double>(cell);
      before = running[cell] + s * (running[cell + 1] - running[cell]);
    }
    largest = std::max(largest, running[i] - before);
  }
  return std::sqrt(largest / window);
}

}  // namespace

Extremes CalcExtremes(std::span<const double> record, double time_step) {
  if (record.empty() || !IsFinite(record)) return {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  Extremes extremes;
  const auto [low, high] = std::minmax_element(record.begin(), record.end());
  extremes.minimum = *low;
  extremes.maximum = *high;
  const auto peak = -*low > *high ? low : high;
  extremes.peak = std::abs(*peak);
  extremes.time_of_peak = static_cast<double>(peak - record.begin()) * time_step;
  extremes.peak_to_peak = *high - *low;
  extremes.impulse = MakeRunningIntegral(record, time_step).back();
  return extremes;
}

VibrationStatistics CalcVibrationStatistics(std::span<const double> record, double time_step) {
  if (record.size() < 2 || !IsFinite(record)) return {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  VibrationStatistics statistics;
  std::vector<double> square(record.size());
  std::vector<double> fourth(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    statistics.peak = std::max(statistics.peak, std::abs(record[i]));
    square[i] = record[i] * record[i];
    fourth[i] = square[i] * square[i];
  }
  const double duration = time_step * static_cast<double>(record.size() - 1);
  const std::vector<double> energy = MakeRunningIntegral(square, time_step);
  const double dose = std::max(0.0, MakeRunningIntegral(fourth, time_step).back());
  statistics.rms = std::sqrt(std::max(0.0, energy.back()) / duration);
  statistics.rmq = std::pow(dose / duration, 0.25);
  statistics.vdv = std::pow(dose, 0.25);
  statistics.mtvv = CalcLargestRunningRms(energy, time_step, 1.0);
  statistics.mtvv_eighth = CalcLargestRunningRms(energy, time_step, 0.125);
  statistics.crest_factor = statistics.rms > 0.0 ? statistics.peak / statistics.rms : 0.0;
  return statistics;
}

Companions CalcCompanions(const CompanionRecords& records, double time_step,
                          const CompanionOptions& options) {
  Companions companions;
  const std::span<const double> rim = records.rim_acceleration;
  if (!rim.empty()) {
    companions.unweighted = CalcVibrationStatistics(rim, time_step);
    companions.weighted =
        CalcVibrationStatistics(signal::MakeWeighted(options.weighting, rim, time_step), time_step);
    Conventions conventions;
    conventions.window = options.short_window;
    conventions.decay_level = options.decay_level;
    const GammaPlan plan(rim.size(), time_step, conventions);
    GammaWorkspace workspace(plan);
    companions.short_decay_time = workspace.Update(rim)[3];
  }
  const auto calc = [&](std::span<const double> record) -> std::optional<Extremes> {
    if (record.empty()) return std::nullopt;
    return CalcExtremes(record, time_step);
  };
  companions.torsion_torque = calc(records.torsion_torque);
  companions.rack_force = calc(records.rack_force);
  companions.tie_rod_force = calc(records.tie_rod_force);
  return companions;
}

double CalcRoadFeelGain(std::span<const double> frequency, std::span<const double> magnitude,
                        double f_low, double f_high) {
  const std::size_t n = frequency.size();
  bool increasing = n > 0 && magnitude.size() == n;
  for (std::size_t i = 1; increasing && i < n; ++i) increasing = frequency[i] > frequency[i - 1];
  if (!increasing || !(f_high > f_low) || !(frequency[n - 1] >= f_high)) {
    throw io::InputError(
        {.file = {},
         .line = 0,
         .key = "road feel",
         .found = n == 0 ? std::string("no points of the frequency response")
                         : fmt::format("{} frequencies ending at {:g} Hz", n, frequency[n - 1]),
         .expected =
             fmt::format("increasing frequencies that cover {:g} to {:g} Hz", f_low, f_high),
         .suggestion = {}});
  }
  // Integral of the broken line, clipped to the band.
  double integral = 0.0;
  if (frequency[0] > f_low) integral += magnitude[0] * (std::min(frequency[0], f_high) - f_low);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double low = std::max(frequency[i], f_low);
    const double high = std::min(frequency[i + 1], f_high);
    if (high <= low) continue;
    const double slope = (magnitude[i + 1] - magnitude[i]) / (frequency[i + 1] - frequency[i]);
    const double middle = magnitude[i] + slope * (0.5 * (low + high) - frequency[i]);
    integral += middle * (high - low);
  }
  return integral / (f_high - f_low);
}

}  // namespace kingpin::measures
