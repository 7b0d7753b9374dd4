#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/signal/fft.h"
#include "optimisation/measures/conventions.h"

namespace kingpin::math {
template <class T, int N>
struct Dual;
}

/// The paper's five measures of steering-wheel vibration and the sum that is optimised.
namespace kingpin::measures {

inline constexpr int kMeasureCount = 5;

/// Γ_1 .. Γ_5 at indices 0 .. 4, in the units that DescribeUnits() names (rim acceleration in
/// mm/s²).
template <class S>
using Gammas = std::array<S, kMeasureCount>;

/// The prepared evaluation of the measures for records of one length, step and convention.
/// Immutable: shared by all threads.
///
///     Γ_1 = max a − min a                                            (3.10)
///     Γ_2 = ∫_0^T √(g(t)/Δt_w) dt,  g(t) = ∫_{t−Δt_w/2}^{t+Δt_w/2} a² dτ  (3.11)
///     Γ_3 = √(∫_{f1}^{f2} |A(f) W(f)|² df)                           (3.12)
///     Γ_4 = time with g >= κ_DS max g                                (3.13)
///     Γ_5 = √(1/T ∫_0^T a² dt)                                       (3.14)
///
/// g is evaluated at the samples from the running integral of a²; between samples the running
/// integral is the Hermite cubic with slopes a² (exact for the trapezoidal rule). A negative g,
/// which the fourth-order rule can give next to a jump, counts as 0.
///
/// Bounds that hold for every record: Γ_2 <= T Γ_5 (Cauchy-Schwarz, truncated windows), and with
/// W = 1 and the full band Γ_3 = Γ_5 √(T/2) (Parseval).
class GammaPlan {
 public:
  /// @param samples number of samples, both ends of the record included; T = (samples − 1)
  /// time_step
  /// @throws io::InputError for conventions out of range, fewer than two samples, a step that is
  ///         not positive.
  GammaPlan(std::size_t samples, double time_step, Conventions conventions);

  std::size_t samples() const { return samples_; }
  double time_step() const { return time_step_; }
  double duration() const { return time_step_ * static_cast<double>(samples_ - 1); }
  const Conventions& conventions() const { return conventions_; }

 private:
  friend class GammaWorkspace;

  std::size_t samples_;
  double time_step_;
  Conventions conventions_;
  // The window's half width in steps: whole_ + fraction_.
  std::size_t whole_ = 0;
  double fraction_ = 0.0;
  std::size_t first_line_ = 0;
  std::vector<double> line_weight_;   // Γ_3² = Σ_k line_weight_[k] |X_{first_line_ + k}|²
  std::vector<double> window_scale_;  // window/overlap per sample; empty when truncated
  std::array<double, kMeasureCount> unit_{};  // from SI to the printed unit
};

/// Scratch memory of one thread for one plan; the plan must outlive it. Evaluations allocate
/// nothing.
class GammaWorkspace {
 public:
  explicit GammaWorkspace(const GammaPlan& plan);

  const GammaPlan& plan() const { return *plan_; }

  /// The measures of a record [m/s²]. A record with a value that is not finite (or whose energy
  /// overflows) gives NaN for all five: a bad design, not an error. A record of zeros gives zeros.
  /// @throws std::invalid_argument when the record does not have plan().samples() samples.
  Gammas<double> Update(std::span<const double> rim_acceleration);

  /// As Update(); gradient(k)[i] then holds ∂Γ_{k+1}/∂a_i. Exact (adjoint) derivatives of the
  /// numbers that Update() returns. Where a measure is not differentiable (two equal peaks; a
  /// record of zeros) they are those of one side, or zero.
  Gammas<double> UpdateWithGradient(std::span<const double> rim_acceleration);

  std::span<const double> gradient(int measure) const;

  /// Room for one record, for callers that have theirs in another form.
  std::span<double> values() { return values_; }

 private:
  struct Peak {
    double value = 0.0;
    std::size_t index = 0;
    std::array<double, 3> slope{};  // with respect to the samples index − 1, index, index + 1
  };
  // Where g crosses the level: between the neighbours `low` (below it) and `high`; the two are
  // equal at an end of the record.
  struct Crossing {
    double time = 0.0;
    std::size_t low = 0, high = 0;
  };

  Peak CalcPeak(std::span<const double> record, double sign) const;
  Crossing CalcCrossing(bool first) const;
  double CalcTimeAbove() const;
  void UpdateWindowEnergy();
  double UpdateSpectrumSum(std::span<const double> record);

  std::span<double> row(int measure);
  void UpdatePeakGradient();
  void UpdateRootGradient(std::span<const double> record);
  void UpdateSpectrumGradient(double gamma_3);
  void UpdateDecayGradient(std::span<const double> record);
  void UpdateRmsGradient(std::span<const double> record, double gamma_5);
  void PullBackWindowEnergy();
  void PullBackRunningIntegral(std::span<const double> record, int measure);

  const GammaPlan* plan_;
  signal::RealFft fft_;
  std::vector<double> values_;  // of a record of dual numbers
  std::vector<double> period_;  // the record as one period
  std::vector<std::complex<double>> spectrum_;
  std::vector<double> square_;         // a²
  std::vector<double> running_;        // ∫ a²
  std::vector<double> window_energy_;  // g at the samples
  std::vector<double> root_;           // √(g/Δt_w)
  Peak highest_, lowest_;
  Crossing first_, last_;
  double level_ = 0.0;  // κ max g
  // Adjoints: ∂Γ/∂g, ∂Γ/∂(running integral), ∂Γ/∂a², ∂Γ/∂(period), and one row ∂Γ_k/∂a per measure.
  std::vector<double> window_adjoint_, running_adjoint_, square_adjoint_, period_adjoint_,
      gradient_;
};

/// The measures of a record of rim accelerations [m/s²].
inline Gammas<double> CalcGammas(std::span<const double> rim_acceleration,
                                 GammaWorkspace& workspace) {
  return workspace.Update(rim_acceleration);
}

/// The same for dual numbers, `math::Dual<double, N>`. The five rows ∂Γ/∂a are computed once by the
/// adjoint, whatever N is, and the derivative channels follow as scalar products: one more Fourier
/// transform instead of N.
template <int N>
Gammas<math::Dual<double, N>> CalcGammas(std::span<const math::Dual<double, N>> rim_acceleration,
                                         GammaWorkspace& workspace) {
  const std::span<double> values = workspace.values();
  if (rim_acceleration.size() != values.size()) {
    throw std::invalid_argument("a record does not have the number of samples it was planned for");
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = rim_acceleration[i].v;
  const Gammas<double> plain = workspace.UpdateWithGradient(values);
  Gammas<math::Dual<double, N>> gammas;
  for (int k = 0; k < kMeasureCount; ++k) {
    math::Dual<double, N> sum(0.0);
    const std::span<const double> slope = workspace.gradient(k);
    for (std::size_t i = 0; i < values.size(); ++i) {
      for (int j = 0; j < N; ++j) sum.d[j] += slope[i] * rim_acceleration[i].d[j];
    }
    sum.v = plain[static_cast<std::size_t>(k)];
    gammas[static_cast<std::size_t>(k)] = sum;
  }
  return gammas;
}

/// Γ = Σ_k ε_k Γ_k/Γ_k^0, (3.9); with Γ^0 of the initial design and Γ of the optimum it is I_V,
/// (3.18).
template <class S>
S CalcObjective(const Gammas<S>& gammas, const Gammas<double>& reference,
                const std::array<double, kMeasureCount>& weights = {1.0, 1.0, 1.0, 1.0, 1.0}) {
  S sum{};
  for (std::size_t k = 0; k < kMeasureCount; ++k) {
    if (weights[k] != 0.0) sum = sum + gammas[k] * (weights[k] / reference[k]);
  }
  return sum;
}

}  // namespace kingpin::measures
