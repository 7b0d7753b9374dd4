#pragma once

#include <span>
#include <string_view>

namespace kingpin::signal {

/// How a sampled function is integrated from one sample to the next.
enum class Quadrature {
  /// dt (f_i + f_{i+1})/2: second order, exact for piecewise linear functions.
  kTrapezoid,
  /// dt (13 (f_i + f_{i+1}) − f_{i−1} − f_{i+2})/24: the integral of the cubic through four
  /// samples,
  /// fourth order inside the record. A missing neighbour at an end of the record is replaced by the
  /// end's own value (second order there). The rule of the identified paper sets.
  kCubic,
};

std::string_view ToString(Quadrature rule);

/// C_0 = 0, C_{i+1} = C_i + ∫_{t_i}^{t_{i+1}} f dt for uniform samples. `integral` has the size of
/// `function`.
void UpdateRunningIntegral(Quadrature rule, double time_step, std::span<const double> function,
                           std::span<double> integral);

/// The adjoint of UpdateRunningIntegral: given ∂G/∂C_i, adds Σ_j ∂G/∂C_j ∂C_j/∂f_i to `function`.
void AddRunningIntegralAdjoint(Quadrature rule, double time_step, std::span<const double> integral,
                               std::span<double> function);

}  // namespace kingpin::signal
