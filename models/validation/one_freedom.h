#pragma once

#include <functional>

#include "models/validation/extrapolation.h"

namespace kingpin::validation {

/// df/dx by central differences of order 8.
inline Real Differentiate(const std::function<Real(Real)>& f, Real x) {
  constexpr Real h = 0.01L;
  Real sum = 0;
  constexpr Real kWeights[] = {4.0L / 5, -1.0L / 5, 4.0L / 105, -1.0L / 280};
  for (int i = 1; i <= 4; ++i) sum += kWeights[i - 1] * (f(x + i * h) - f(x - i * h));
  return sum / h;
}

/// Rates of a mechanism with one coordinate θ, kinetic energy 1/2 A(θ) θ̇² and potential V(θ):
/// A θ̈ = -1/2 A' θ̇² - V'. State: θ, θ̇.
inline Rates MakeOneFreedom(const std::function<Real(Real)>& inertia,
                            const std::function<Real(Real)>& potential) {
  return [=](Real, const State& s, State& r) {
    r[0] = s[1];
    r[1] = -(Differentiate(inertia, s[0]) * s[1] * s[1] / 2 + Differentiate(potential, s[0])) /
           inertia(s[0]);
  };
}

}  // namespace kingpin::validation
