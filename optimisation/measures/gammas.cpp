#include "optimisation/measures/gammas.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"

namespace kingpin::measures {

namespace {

using Map = Eigen::Map<Eigen::ArrayXd>;
using ConstMap = Eigen::Map<const Eigen::ArrayXd>;

constexpr double kMillimetresPerMetre = 1000.0;

/// Weights of the Hermite cubic on a unit cell: value and slope at 0, value and slope at 1.
struct HermiteWeights {
  explicit HermiteWeights(double s)
      : value_0((1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s)),
        slope_0(s * (1.0 - s) * (1.0 - s)),
        value_1(s * s * (3.0 - 2.0 * s)),
        slope_1(s * s * (s - 1.0)) {}
  double value_0, slope_0, value_1, slope_1;
};

/// The band of [f1, f2] that line k stands for when lines lie `width` apart, from 0 to the Nyquist
/// frequency.
double CalcBandWidth(double frequency, double width, double nyquist, double f1, double f2) {
  const double low = std::max({frequency - 0.5 * width, 0.0, f1});
  const double high = std::min({frequency + 0.5 * width, nyquist, f2});
  return std::max(0.0, high - low);
}

}  // namespace

GammaPlan::GammaPlan(std::size_t samples, double time_step, Conventions conventions)
    : samples_(samples), time_step_(time_step), conventions_(std::move(conventions)) {
  CheckConventions(conventions_);
  if (samples < 2) {
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = "record",
                          .found = fmt::format("{} samples", samples),
                          .expected = "at least two",
                          .suggestion = {}});
  }
  if (!std::isfinite(time_step) || time_step <= 0.0) {
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = "record",
                          .found = fmt::format("a time step of {:g} s", time_step),
                          .expected = "a positive one",
                          .suggestion = {}});
  }

  const double half_width = 0.5 * conventions_.window / time_step;
  if (half_width >= static_cast<double>(samples)) {
    whole_ = samples;  // the window always holds the whole record
  } else {
    // 0.3 s / 1 ms is 300 steps, not 299.99999999999994.
    const double rounded = std::round(half_width);
    const bool on_samples = std::abs(half_width - rounded) < 1e-9 * rounded;
    whole_ = static_cast<std::size_t>(on_samples ? rounded : std::floor(half_width));
    fraction_ = on_samples ? 0.0 : half_width - std::floor(half_width);
  }
  if (conventions_.window_ends == WindowEnds::kNormalised) {
    const double end = duration();
    for (std::size_t i = 0; i < samples; ++i) {
      const double t = static_cast<double>(i) * time_step;
      const double overlap = std::min(end, t + 0.5 * conventions_.window) -
                             std::max(0.0, t - 0.5 * conventions_.window);
      window_scale_.push_back(conventions_.window / overlap);
    }
  }

  const auto period = static_cast<double>(samples - 1);
  const bool integral = conventions_.spectrum_scaling == SpectrumScaling::kFourierIntegral;
  const double spacing = 1.0 / duration();
  const double nyquist = 0.5 / time_step;
  for (std::size_t k = 0; k <= (samples - 1) / 2; ++k) {
    const double frequency = static_cast<double>(k) * spacing;
    double weight = 0.0;
    if (integral) {
      weight = time_step * time_step *
               CalcBandWidth(frequency, spacing, nyquist, conventions_.f1, conventions_.f2);
    } else if (frequency >= conventions_.f1 * (1.0 - 1e-9) &&
               frequency <= conventions_.f2 * (1.0 + 1e-9)) {
      weight = 4.0 / (period * period);
    }
    if (weight > 0.0) {
      const double factor = conventions_.weighting.CalcMagnitude(frequency);
      weight *= conventions_.gamma_3_scale * factor * factor;
    }
    if (line_weight_.empty() && weight == 0.0) {
      first_line_ = k + 1;
    } else {
      line_weight_.push_back(weight);
    }
  }
  while (!line_weight_.empty() && line_weight_.back() == 0.0) line_weight_.pop_back();

  const double mm = kMillimetresPerMetre;
  const double gamma_3_unit = conventions_.gamma_3_root ? mm : (integral ? mm * mm : 1.0);
  unit_ = {mm, mm, gamma_3_unit, 1.0, mm};
}

GammaWorkspace::GammaWorkspace(const GammaPlan& plan)
    : plan_(&plan),
      fft_(plan.samples() - 1),
      values_(plan.samples()),
      period_(plan.samples() - 1),
      spectrum_(fft_.spectrum_size()),
      square_(plan.samples()),
      running_(plan.samples()),
      window_energy_(plan.samples()),
      root_(plan.samples()),
      window_adjoint_(plan.samples()),
      running_adjoint_(plan.samples()),
      square_adjoint_(plan.samples()),
      period_adjoint_(plan.samples() - 1),
      gradient_(plan.samples() * kMeasureCount) {}

std::span<double> GammaWorkspace::row(int measure) {
  const std::size_t n = plan_->samples();
  return std::span(gradient_).subspan(static_cast<std::size_t>(measure) * n, n);
}

std::span<const double> GammaWorkspace::gradient(int measure) const {
  const std::size_t n = plan_->samples();
  return std::span(gradient_).subspan(static_cast<std::size_t>(measure) * n, n);
}

GammaWorkspace::Peak GammaWorkspace::CalcPeak(std::span<const double> record, double sign) const {
  const auto size = static_cast<Eigen::Index>(record.size());
  const ConstMap samples(record.data(), size);
  // Two passes: the maximum without its index is found in SIMD lanes.
  const double extreme = sign > 0.0 ? samples.maxCoeff() : samples.minCoeff();
  Peak peak;
  peak.index =
      static_cast<std::size_t>(std::find(record.begin(), record.end(), extreme) - record.begin());
  peak.value = extreme;
  peak.slope = {0.0, 1.0, 0.0};
  const std::size_t i = peak.index;
  if (!plan_->conventions().refine_peaks || i == 0 || i + 1 == record.size()) return peak;
  // Vertex of the parabola: y − Δ²/(8 c), Δ = y₊ − y₋, c = y₋ − 2 y + y₊.
  const double difference = record[i + 1] - record[i - 1];
  const double curvature = record[i - 1] - 2.0 * record[i] + record[i + 1];
  if (curvature == 0.0) return peak;
  const double ratio = difference / curvature;
  peak.value -= 0.125 * difference * ratio;
  const double bend = 0.125 * ratio * ratio;
  peak.slope = {bend + 0.25 * ratio, 1.0 - 2.0 * bend, bend - 0.25 * ratio};
  return peak;
}

void GammaWorkspace::UpdateWindowEnergy() {
  const std::size_t n = plan_->samples();
  const std::size_t m = plan_->whole_;
  const double* c = running_.data();
  double* g = window_energy_.data();
  if (plan_->fraction_ == 0.0) {
    const double total = c[n - 1];
    // In three parts without conditions: before the window's ends are both inside, between, after.
    const std::size_t start = std::min(m, n);
    const std::size_t end = n - start;
    for (std::size_t i = 0; i < std::min(start, end); ++i) g[i] = c[i + m];
    for (std::size_t i = end; i < start; ++i) g[i] = total;
    for (std::size_t i = start; i < end; ++i) g[i] = c[i + m] - c[i - m];
    for (std::size_t i = std::max(start, end); i < n; ++i) g[i] = total - c[i - m];
  } else {
    const double dt = plan_->time_step();
    const double* f = square_.data();
    const auto at = [=](std::size_t cell, const HermiteWeights& w) {
      return w.value_0 * c[cell] + w.value_1 * c[cell + 1] +
             dt * (w.slope_0 * f[cell] + w.slope_1 * f[cell + 1]);
    };
    const HermiteWeights right(plan_->fraction_);
    const HermiteWeights left(1.0 - plan_->fraction_);
    for (std::size_t i = 0; i < n; ++i) {
      g[i] = (i + m + 1 < n ? at(i + m, right) : c[n - 1]) - (i > m ? at(i - m - 1, left) : 0.0);
    }
  }
  Map energy(g, static_cast<Eigen::Index>(n));
  if (!plan_->window_scale_.empty()) {
    energy *= ConstMap(plan_->window_scale_.data(), static_cast<Eigen::Index>(n));
  }
  energy = energy.max(0.0);
}

double GammaWorkspace::UpdateSpectrumSum(std::span<const double> record) {
  std::copy(record.begin(), record.end() - 1, period_.begin());
  if (plan_->conventions().end_sample == EndSample::kFolded) {
    period_[0] = 0.5 * (record.front() + record.back());
  }
  fft_.UpdateSpectrum(period_, spectrum_);
  double sum = 0.0;
  for (std::size_t k = 0; k < plan_->line_weight_.size(); ++k) {
    sum += plan_->line_weight_[k] * std::norm(spectrum_[plan_->first_line_ + k]);
  }
  return sum;
}

GammaWorkspace::Crossing GammaWorkspace::CalcCrossing(bool first) const {
  const std::vector<double>& g = window_energy_;
  const std::size_t n = g.size();
  Crossing crossing;
  std::size_t high = first ? 0 : n - 1;
  while (g[high] < level_) high += first ? 1 : std::size_t(-1);
  crossing.high = crossing.low = high;
  crossing.time = static_cast<double>(high);
  if (high != (first ? 0 : n - 1)) {
    crossing.low = first ? high - 1 : high + 1;
    const double share = (g[high] - level_) / (g[high] - g[crossing.low]);
    crossing.time += first ? -share : share;
  }
  crossing.time *= plan_->time_step();
  return crossing;
}

double GammaWorkspace::CalcTimeAbove() const {
  const std::vector<double>& g = window_energy_;
  double cells = 0.0;
  for (std::size_t i = 0; i + 1 < g.size(); ++i) {
    const auto [low, high] = std::minmax(g[i], g[i + 1]);
    if (low >= level_) {
      cells += 1.0;
    } else if (high > level_) {
      cells += (high - level_) / (high - low);
    }
  }
  return cells * plan_->time_step();
}

Gammas<double> GammaWorkspace::Update(std::span<const double> record) {
  const std::size_t n = plan_->samples();
  if (record.size() != n) {
    throw std::invalid_argument("a record does not have the number of samples it was planned for");
  }
  const Conventions& conventions = plan_->conventions();
  const auto size = static_cast<Eigen::Index>(n);
  const double dt = plan_->time_step();

  Gammas<double> gammas;
  gammas.fill(std::numeric_limits<double>::quiet_NaN());
  Map(square_.data(), size) = ConstMap(record.data(), size).square();
  signal::UpdateRunningIntegral(conventions.quadrature, dt, square_, running_);
  const double energy = std::max(0.0, running_.back());
  if (!std::isfinite(running_.back())) return gammas;

  highest_ = CalcPeak(record, 1.0);
  lowest_ = CalcPeak(record, -1.0);
  UpdateWindowEnergy();
  const ConstMap window_energy(window_energy_.data(), size);
  Map root(root_.data(), size);
  root = (window_energy * (1.0 / conventions.window)).sqrt();
  const double spectrum_sum = UpdateSpectrumSum(record);
  const double strongest = window_energy.maxCoeff();
  level_ = conventions.decay_level * strongest;

  gammas[0] = highest_.value - lowest_.value;
  gammas[1] = dt * (root.sum() - 0.5 * (root_.front() + root_.back()));
  gammas[2] = conventions.gamma_3_root ? std::sqrt(spectrum_sum) : spectrum_sum;
  gammas[3] = 0.0;
  if (strongest > 0.0) {
    if (conventions.decay_time == DecayTime::kFirstToLastCrossing) {
      first_ = CalcCrossing(true);
      last_ = CalcCrossing(false);
      gammas[3] = last_.time - first_.time;
    } else {
      gammas[3] = CalcTimeAbove();
    }
  }
  gammas[4] = std::sqrt(energy / plan_->duration());
  bool finite = true;
  for (std::size_t k = 0; k < kMeasureCount; ++k) {
    gammas[k] *= plan_->unit_[k];
    finite = finite && std::isfinite(gammas[k]);
  }
  if (!finite) gammas.fill(std::numeric_limits<double>::quiet_NaN());
  return gammas;
}

Gammas<double> GammaWorkspace::UpdateWithGradient(std::span<const double> record) {
  const Gammas<double> gammas = Update(record);
  if (std::isnan(gammas[0])) {
    std::fill(gradient_.begin(), gradient_.end(), std::numeric_limits<double>::quiet_NaN());
    return gammas;
  }
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  UpdatePeakGradient();
  UpdateRootGradient(record);
  UpdateSpectrumGradient(gammas[2]);
  UpdateDecayGradient(record);
  UpdateRmsGradient(record, gammas[4]);
  return gammas;
}

void GammaWorkspace::UpdatePeakGradient() {
  const auto slope = row(0);
  const auto add = [&](const Peak& peak, double factor) {
    slope[peak.index] += factor * peak.slope[1];
    if (peak.index > 0) slope[peak.index - 1] += factor * peak.slope[0];
    if (peak.index + 1 < slope.size()) slope[peak.index + 1] += factor * peak.slope[2];
  };
  add(highest_, plan_->unit_[0]);
  add(lowest_, -plan_->unit_[0]);
}

void GammaWorkspace::UpdateRootGradient(std::span<const double> record) {
  // ∂√(g/Δ)/∂g = 1/(2 Δ √(g/Δ)).
  const std::size_t n = plan_->samples();
  const double factor = 0.5 * plan_->time_step() / plan_->conventions().window;
  for (std::size_t i = 0; i < n; ++i) {
    const double share = i == 0 || i + 1 == n ? 0.5 : 1.0;
    window_adjoint_[i] = root_[i] > 0.0 ? share * factor / root_[i] : 0.0;
  }
  PullBackWindowEnergy();
  PullBackRunningIntegral(record, 1);
}

void GammaWorkspace::UpdateSpectrumGradient(double gamma_3) {
  // Γ_3² = Σ w_k |X_k|², so ∂Γ_3²/∂x_i = 2 Re Σ w_k X_k e^{+j 2π i k/N}: the inverse transform of
  // N w_k X_k, where lines without a mirror image (0 and N/2) count twice.
  double outer = plan_->unit_[2];
  if (plan_->conventions().gamma_3_root) {
    if (gamma_3 <= 0.0) return;
    outer *= plan_->unit_[2] / (2.0 * gamma_3);
  }
  const std::size_t period = period_.size();
  const std::size_t begin = plan_->first_line_;
  const std::size_t end = begin + plan_->line_weight_.size();
  for (std::size_t k = 0; k < spectrum_.size(); ++k) {
    const double weight = k >= begin && k < end ? plan_->line_weight_[k - begin] : 0.0;
    const double mirror = k == 0 || 2 * k == period ? 2.0 : 1.0;
    spectrum_[k] *= outer * mirror * weight * static_cast<double>(period);
  }
  fft_.UpdateRecord(spectrum_, period_adjoint_);
  const auto slope = row(2);
  std::copy(period_adjoint_.begin(), period_adjoint_.end(), slope.begin());
  if (plan_->conventions().end_sample == EndSample::kFolded) {
    slope.front() = slope.back() = 0.5 * period_adjoint_.front();
  }
}

void GammaWorkspace::UpdateDecayGradient(std::span<const double> record) {
  if (level_ <= 0.0) return;
  const std::vector<double>& g = window_energy_;
  const double dt = plan_->time_step();
  std::fill(window_adjoint_.begin(), window_adjoint_.end(), 0.0);
  double level_adjoint = 0.0;
  // The share (g_high − L)/(g_high − g_low) of a cell is above the level.
  const auto add_share = [&](std::size_t low, std::size_t high) {
    const double rise = g[high] - g[low];
    const double above = g[high] - level_;
    level_adjoint -= dt / rise;
    window_adjoint_[high] += dt * (rise - above) / (rise * rise);
    window_adjoint_[low] += dt * above / (rise * rise);
  };
  if (plan_->conventions().decay_time == DecayTime::kFirstToLastCrossing) {
    if (first_.low != first_.high) add_share(first_.low, first_.high);
    if (last_.low != last_.high) add_share(last_.low, last_.high);
  } else {
    for (std::size_t i = 0; i + 1 < g.size(); ++i) {
      if (g[i] < level_ && g[i + 1] > level_) add_share(i, i + 1);
      if (g[i] > level_ && g[i + 1] < level_) add_share(i + 1, i);
    }
  }
  const auto strongest = static_cast<std::size_t>(std::max_element(g.begin(), g.end()) - g.begin());
  window_adjoint_[strongest] += plan_->conventions().decay_level * level_adjoint;
  PullBackWindowEnergy();
  PullBackRunningIntegral(record, 3);
}

void GammaWorkspace::UpdateRmsGradient(std::span<const double> record, double gamma_5) {
  if (gamma_5 <= 0.0) return;
  std::fill(running_adjoint_.begin(), running_adjoint_.end(), 0.0);
  std::fill(square_adjoint_.begin(), square_adjoint_.end(), 0.0);
  running_adjoint_.back() = plan_->unit_[4] / (2.0 * gamma_5 * plan_->duration());
  PullBackRunningIntegral(record, 4);
}

void GammaWorkspace::PullBackWindowEnergy() {
  const std::size_t n = plan_->samples();
  const std::size_t m = plan_->whole_;
  const double dt = plan_->time_step();
  std::fill(running_adjoint_.begin(), running_adjoint_.end(), 0.0);
  std::fill(square_adjoint_.begin(), square_adjoint_.end(), 0.0);
  const HermiteWeights right(plan_->fraction_);
  const HermiteWeights left(1.0 - plan_->fraction_);
  const bool on_samples = plan_->fraction_ == 0.0;
  const auto add = [&](std::size_t cell, const HermiteWeights& w, double adjoint) {
    running_adjoint_[cell] += adjoint * w.value_0;
    running_adjoint_[cell + 1] += adjoint * w.value_1;
    square_adjoint_[cell] += adjoint * dt * w.slope_0;
    square_adjoint_[cell + 1] += adjoint * dt * w.slope_1;
  };
  for (std::size_t i = 0; i < n; ++i) {
    double adjoint = window_adjoint_[i];
    if (adjoint == 0.0 || window_energy_[i] == 0.0) continue;
    if (!plan_->window_scale_.empty()) adjoint *= plan_->window_scale_[i];
    if (on_samples) {
      running_adjoint_[std::min(i + m, n - 1)] += adjoint;
      if (i > m) running_adjoint_[i - m] -= adjoint;
      continue;
    }
    if (i + m + 1 < n) {
      add(i + m, right, adjoint);
    } else {
      running_adjoint_[n - 1] += adjoint;
    }
    if (i > m) add(i - m - 1, left, -adjoint);
  }
}

void GammaWorkspace::PullBackRunningIntegral(std::span<const double> record, int measure) {
  signal::AddRunningIntegralAdjoint(plan_->conventions().quadrature, plan_->time_step(),
                                    running_adjoint_, square_adjoint_);
  const auto slope = row(measure);
  const double unit = plan_->unit_[static_cast<std::size_t>(measure)];
  for (std::size_t i = 0; i < record.size(); ++i) {
    slope[i] = 2.0 * unit * record[i] * square_adjoint_[i];
  }
}

}  // namespace kingpin::measures
