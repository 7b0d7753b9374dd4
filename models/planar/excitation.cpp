#include "models/planar/excitation.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"

namespace kingpin::planar {
namespace {

constexpr double kPi = std::numbers::pi;

struct KindName {
  PulseKind kind;
  std::string_view name;
};
constexpr KindName kKindNames[] = {
    {PulseKind::kHalfSine, "half_sine"},  {PulseKind::kVersine, "versine"},
    {PulseKind::kTrapezoid, "trapezoid"}, {PulseKind::kDouble, "double"},
    {PulseKind::kRingDown, "ring_down"},  {PulseKind::kCubedParabola, "cubed_parabola"},
};

double HalfSine(double u) { return u <= 0 || u >= 1 ? 0.0 : std::sin(kPi * u); }

double CalcPulse(const Pulse& p, double t) {
  const double tau = t - p.start;
  if (tau <= 0) return 0;
  const double u = tau / p.duration;
  switch (p.kind) {
    case PulseKind::kHalfSine:
      return p.amplitude * HalfSine(u);
    case PulseKind::kVersine: {
      // sin² keeps its digits near the ends, where 1 − cos would lose them.
      const double s = HalfSine(u);
      return p.amplitude * s * s;
    }
    case PulseKind::kTrapezoid:
      return p.amplitude * std::max(0.0, std::min({1.0, u / p.rise, (1 - u) / p.fall}));
    case PulseKind::kDouble:
      return p.amplitude *
             (HalfSine(u) - p.rebound * HalfSine((tau - p.duration - p.gap) / p.duration));
    case PulseKind::kRingDown: {
      const double omega = 2 * kPi * p.frequency;
      return p.amplitude * std::exp(-p.damping * omega * tau) * std::sin(omega * tau);
    }
    case PulseKind::kCubedParabola: {
      const double w = std::max(0.0, 4 * u * (1 - u));
      return p.amplitude * w * w * w;
    }
  }
  return 0;
}

// Unique in the process; says nothing about order or content.
std::uint64_t MakeId() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

void Check(bool good, size_t index, std::string_view name, double found, std::string expected) {
  if (good && std::isfinite(found)) return;
  io::InputProblem problem;
  problem.key = fmt::format("pulses[{}].{}", index, name);
  problem.found = fmt::format("{}", found);
  problem.expected = std::move(expected);
  throw io::InputError(problem);
}

void CheckPulse(const Pulse& p, size_t i) {
  Check(true, i, "amplitude", p.amplitude, "a finite force [N]");
  Check(p.start >= 0, i, "start", p.start, "a time >= 0 [s]");
  if (p.kind == PulseKind::kRingDown) {
    Check(p.frequency > 0, i, "frequency", p.frequency, "a frequency > 0 [Hz]");
    Check(p.damping >= 0, i, "damping", p.damping, "a damping ratio >= 0");
  } else {
    Check(p.duration > 0, i, "duration", p.duration, "a duration > 0 [s]");
  }
  if (p.kind == PulseKind::kTrapezoid) {
    Check(p.rise > 0, i, "rise", p.rise, "a fraction of the duration > 0");
    Check(p.fall > 0 && p.rise + p.fall <= 1 + 1e-12, i, "fall", p.fall,
          "a fraction of the duration > 0, at most 1 - rise");
  }
  if (p.kind == PulseKind::kDouble) {
    Check(true, i, "rebound", p.rebound, "a finite ratio");
    Check(p.gap >= 0, i, "gap", p.gap, "a time >= 0 [s]");
  }
}

std::vector<double> MakeMonotoneSlopes(const std::vector<double>& x, const std::vector<double>& f) {
  const size_t n = x.size();
  std::vector<double> h(n - 1), rise(n - 1), slope(n);
  for (size_t k = 0; k + 1 < n; ++k) {
    h[k] = x[k + 1] - x[k];
    rise[k] = (f[k + 1] - f[k]) / h[k];
  }
  if (n == 2) return {rise[0], rise[0]};
  for (size_t k = 1; k + 1 < n; ++k) {
    if (rise[k - 1] * rise[k] <= 0) continue;
    const double w0 = 2 * h[k] + h[k - 1], w1 = h[k] + 2 * h[k - 1];
    slope[k] = (w0 + w1) / (w0 / rise[k - 1] + w1 / rise[k]);
  }
  const auto end = [](double h0, double h1, double r0, double r1) {
    const double g = ((2 * h0 + h1) * r0 - h0 * r1) / (h0 + h1);
    if (g * r0 <= 0) return 0.0;
    return std::abs(g) > 3 * std::abs(r0) ? 3 * r0 : g;
  };
  slope[0] = end(h[0], h[1], rise[0], rise[1]);
  slope[n - 1] = end(h[n - 2], h[n - 3], rise[n - 2], rise[n - 3]);
  return slope;
}

}  // namespace

std::string_view ToString(PulseKind kind) {
  for (const KindName& entry : kKindNames) {
    if (entry.kind == kind) return entry.name;
  }
  return "half_sine";
}

Excitation::Excitation() : id_(MakeId()) {}

Excitation::Excitation(std::vector<Pulse> pulses) : pulses_(std::move(pulses)), id_(MakeId()) {
  start_ = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < pulses_.size(); ++i) {
    CheckPulse(pulses_[i], i);
    if (pulses_[i].amplitude != 0) start_ = std::min(start_, pulses_[i].start);
  }
}

Excitation::Excitation(std::vector<Pulse> pulses, std::vector<double> time,
                       std::vector<double> value)
    : Excitation(std::move(pulses)) {
  time_ = std::move(time);
  value_ = std::move(value);
  io::InputProblem problem;
  problem.key = "history";
  if (time_.size() < 2 || value_.size() != time_.size()) {
    problem.found = fmt::format("{} times and {} forces", time_.size(), value_.size());
    problem.expected = "at least two samples, as many forces as times";
    throw io::InputError(problem);
  }
  for (size_t i = 0; i < time_.size(); ++i) {
    problem.key = fmt::format("history[{}]", i);
    if (!std::isfinite(time_[i]) || !std::isfinite(value_[i])) {
      problem.found = fmt::format("time {}, force {}", time_[i], value_[i]);
      problem.expected = "finite numbers";
      throw io::InputError(problem);
    }
    if (i > 0 && !(time_[i] > time_[i - 1])) {
      problem.found = fmt::format("time {} after {}", time_[i], time_[i - 1]);
      problem.expected = "a later time than in the row before";
      throw io::InputError(problem);
    }
  }
  slope_ = MakeMonotoneSlopes(time_, value_);
  if (value_[0] != 0) {
    start_ = 0;
  } else {
    for (size_t i = 1; i < time_.size(); ++i) {
      if (value_[i] != 0) {
        start_ = std::min(start_, std::max(0.0, time_[i - 1]));
        break;
      }
    }
  }
}

double Excitation::CalcForce(double t) const {
  double sum = 0;
  for (const Pulse& p : pulses_) sum += CalcPulse(p, t);
  if (!time_.empty()) {
    if (t <= time_.front()) {
      sum += value_.front();
    } else if (t >= time_.back()) {
      sum += value_.back();
    } else {
      const size_t k =
          static_cast<size_t>(std::upper_bound(time_.begin(), time_.end(), t) - time_.begin()) - 1;
      const double h = time_[k + 1] - time_[k];
      const double u = (t - time_[k]) / h;
      const double rise = value_[k + 1] - value_[k];
      const double a = h * slope_[k] - rise;
      const double b = rise - h * slope_[k + 1];
      sum += value_[k] + u * rise + u * (1 - u) * (a * (1 - u) + b * u);
    }
  }
  return sum;
}

std::vector<double> Excitation::MakeKinks(double end) const { return MakeKinks(end, false); }

std::vector<double> Excitation::MakeStrongKinks(double end) const { return MakeKinks(end, true); }

std::vector<double> Excitation::MakeKinks(double end, bool strong) const {
  std::vector<double> kinks;
  for (const Pulse& p : pulses_) {
    // Its third derivative is the first that jumps.
    if (strong && p.kind == PulseKind::kCubedParabola) continue;
    kinks.push_back(p.start);
    if (p.kind == PulseKind::kRingDown) continue;
    kinks.push_back(p.start + p.duration);
    if (p.kind == PulseKind::kTrapezoid) {
      kinks.push_back(p.start + p.rise * p.duration);
      kinks.push_back(p.start + (1 - p.fall) * p.duration);
    }
    if (p.kind == PulseKind::kDouble) {
      kinks.push_back(p.start + p.duration + p.gap);
      kinks.push_back(p.start + 2 * p.duration + p.gap);
    }
  }
  for (size_t i = 0; i < time_.size(); ++i) {
    const bool dense = i > 0 && i + 1 < time_.size() &&
                       std::min(time_[i] - time_[i - 1], time_[i + 1] - time_[i]) < 2.5e-3;
    if (!strong || !dense) kinks.push_back(time_[i]);
  }
  std::sort(kinks.begin(), kinks.end());
  // Two kinks closer than rounding would only make an empty step.
  std::vector<double> apart;
  for (double t : kinks) {
    if (t <= 0 || t >= end) continue;
    if (apart.empty() || t - apart.back() > 1e-12 * (1 + t)) apart.push_back(t);
  }
  return apart;
}

Excitation Excitation::MakeScaled(double factor) const {
  Excitation scaled = *this;
  for (Pulse& p : scaled.pulses_) p.amplitude *= factor;
  for (double& f : scaled.value_) f *= factor;
  for (double& f : scaled.slope_) f *= factor;
  scaled.id_ = MakeId();
  return scaled;
}

}  // namespace kingpin::planar
