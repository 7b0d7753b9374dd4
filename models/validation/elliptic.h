#pragma once

#include <cmath>
#include <numbers>

#include "models/validation/extrapolation.h"

namespace kingpin::validation {

/// Jacobi's elliptic functions sn, cn, dn of u at modulus k, and the amplitude am.
struct Jacobi {
  Real sn, cn, dn, am;
};

/// By descending arithmetic-geometric means (Abramowitz and Stegun, 16.4).
/// @param complement k'² = 1 - k², given by itself: it loses all digits where k is near one
inline Jacobi CalcJacobi(Real u, Real complement) {
  constexpr int kLevels = 32;
  Real a[kLevels], c[kLevels];
  a[0] = 1;
  Real b = std::sqrt(complement);
  int n = 0;
  while (n + 1 < kLevels) {
    ++n;
    a[n] = (a[n - 1] + b) / 2;
    c[n] = (a[n - 1] - b) / 2;
    b = std::sqrt(a[n - 1] * b);
    if (std::abs(c[n]) < 1e-19L * a[n]) break;
  }
  Real angle = std::ldexp(a[n] * u, n);
  for (; n > 0; --n) angle = (angle + std::asin(c[n] / a[n] * std::sin(angle))) / 2;
  const Real sn = std::sin(angle), cn = std::cos(angle);
  return {sn, cn, std::sqrt(cn * cn + complement * sn * sn), angle};
}

/// K(k), the quarter period.
inline Real CalcQuarterPeriod(Real complement) {
  Real a = 1, b = std::sqrt(complement);
  for (int n = 0; n < 32 && std::abs(a - b) > 1e-19L * a; ++n) {
    const Real mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi_v<Real> / (2 * a);
}

}  // namespace kingpin::validation
