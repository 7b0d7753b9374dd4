#include "models/planar/linear_frequency_response.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "core/io/error.h"

namespace kingpin::planar {
namespace {

std::size_t FindName(const std::vector<std::string>& names, const std::string& name,
                     const char* what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument(fmt::format("frequency response: no {} '{}' among: {}", what, name,
                                            fmt::join(names, ", ")));
  }
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

std::vector<double> MakeFrequencyGrid(const Modes& modes, double lowest, double highest,
                                      int per_decade) {
  if (!(lowest > 0.0) || !(highest > lowest) || !std::isfinite(highest) || per_decade <= 0) {
    throw std::invalid_argument(
        fmt::format("frequency grid: found {} to {} Hz with {} points per decade, expected 0 < "
                    "lowest < highest and at least one point",
                    lowest, highest, per_decade));
  }
  const double decades = std::log10(highest / lowest);
  const int count = std::max(2, static_cast<int>(std::ceil(decades * per_decade)) + 1);
  std::vector<double> grid;
  grid.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    grid.push_back(lowest * std::pow(10.0, decades * i / (count - 1)));
  }
  grid.back() = highest;
  for (const Mode& mode : modes.modes) {
    if (mode.kind != ModeKind::kOscillatory) continue;
    // Half-power bandwidth 2 ζ f around the damped peak, steps growing outwards. An undamped mode
    // has no bandwidth: points at a relative distance of 1e-6 show its spike without dividing by
    // zero on it.
    const double half_width = std::max(std::abs(mode.damping_ratio), 1e-6) * mode.frequency;
    const double zeta = mode.damping_ratio;
    const double peak = zeta * zeta < 0.5 ? mode.frequency * std::sqrt(1.0 - 2.0 * zeta * zeta)
                                          : mode.damped_frequency;
    for (const double step : {0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0}) {
      for (const double f : {peak - step * half_width, peak + step * half_width}) {
        if (f > lowest && f < highest && (step > 0.0 || std::abs(zeta) > 1e-9)) grid.push_back(f);
      }
    }
  }
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  return grid;
}

FrequencyResponse CalcFrequencyResponse(const LinearModel& model, const std::vector<double>& grid) {
  const Eigen::Index n = model.a.rows();
  FrequencyResponse result;
  result.frequency = grid;
  result.inputs = model.input_names;
  result.outputs = model.output_names;
  result.input_units = model.input_units;
  result.output_units = model.output_units;
  result.value.assign(result.outputs.size(),
                      std::vector<std::vector<std::complex<double>>>(
                          result.inputs.size(), std::vector<std::complex<double>>(grid.size())));
  Eigen::MatrixXcd resolvent(n, n);
  Eigen::PartialPivLU<Eigen::MatrixXcd> lu(n);
  Eigen::MatrixXcd h(model.c.rows(), model.b.cols());
  const Eigen::MatrixXcd b = model.b.cast<std::complex<double>>();
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const std::complex<double> s{0.0, 2.0 * std::numbers::pi * grid[k]};
    resolvent = -model.a.cast<std::complex<double>>();
    resolvent.diagonal().array() += s;
    lu.compute(resolvent);
    h = model.c * lu.solve(b) + model.d;
    if (!h.allFinite()) {
      throw io::RunError(fmt::format(
          "frequency response: {} Hz is an eigenvalue of the model, which does not answer there "
          "with anything finite; leave that frequency out or add damping",
          grid[k]));
    }
    for (Eigen::Index o = 0; o < h.rows(); ++o) {
      for (Eigen::Index i = 0; i < h.cols(); ++i) {
        result.value[static_cast<std::size_t>(o)][static_cast<std::size_t>(i)][k] = h(o, i);
      }
    }
  }
  return result;
}

BodeCurve CalcBodeCurve(const FrequencyResponse& response, const std::string& input,
                        const std::string& output) {
  const std::size_t i = FindName(response.inputs, input, "input");
  const std::size_t o = FindName(response.outputs, output, "output");
  BodeCurve curve;
  curve.input = input;
  curve.output = output;
  curve.unit = fmt::format("({})/({})", response.output_units[o], response.input_units[i]);
  curve.frequency = response.frequency;
  double turns = 0.0;
  double last = 0.0;
  for (const auto& value : response.value[o][i]) {
    const double magnitude = std::abs(value);
    const double phase = std::arg(value) * 180.0 / std::numbers::pi;
    if (!curve.phase.empty()) {
      if (phase - last > 180.0) turns -= 360.0;
      if (phase - last < -180.0) turns += 360.0;
    }
    last = phase;
    curve.magnitude.push_back(magnitude);
    curve.magnitude_db.push_back(magnitude > 0.0 ? 20.0 * std::log10(magnitude)
                                                 : -std::numeric_limits<double>::infinity());
    curve.phase.push_back(phase + turns);
  }
  return curve;
}

}  // namespace kingpin::planar
