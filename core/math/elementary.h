#pragma once

#include <cmath>

#include "core/math/dual.h"

namespace kingpin::math {

// Functions that packs do not have; force elements are evaluated on double and Dual<double, N>
// only.

/// The angle of (x, y) in (-π, π]. At (0, 0) the value is 0 and the derivative not finite.
KINGPIN_INLINE double Atan2(double y, double x) { return ::atan2(y, x); }

template <int N>
KINGPIN_INLINE Dual<double, N> Atan2(const Dual<double, N>& y, const Dual<double, N>& x) {
  Dual<double, N> angle(::atan2(y.v, x.v));
  const double scale = 1.0 / (x.v * x.v + y.v * y.v);
  for (int i = 0; i < N; ++i) angle.d[i] = scale * (x.v * y.d[i] - y.v * x.d[i]);
  return angle;
}

/// x^exponent for x >= 0, exponent >= 1.
KINGPIN_INLINE double Power(double x, double exponent) { return ::pow(x, exponent); }

template <int N>
KINGPIN_INLINE Dual<double, N> Power(const Dual<double, N>& x, double exponent) {
  Dual<double, N> power(::pow(x.v, exponent));
  const double slope = exponent * ::pow(x.v, exponent - 1.0);
  for (int i = 0; i < N; ++i) power.d[i] = slope * x.d[i];
  return power;
}

}  // namespace kingpin::math
