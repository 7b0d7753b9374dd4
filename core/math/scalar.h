#pragma once

#include <cmath>

/// The small vocabulary that physics templates use on their scalar S. It exists for `double`
/// (here), `Pack` (pack.h: lanes side by side) and `Dual` (dual.h: forward derivatives), so that
/// one source serves all three:
///
///   Select(mask, a, b)   mask ? a : b, lane by lane; both sides are evaluated
///   Min, Max, Abs, Sqrt, Exp
///   SinCos(x, s, c)      s = sin x, c = cos x
///   SinCosMinusOne(x, s, c1)  s = sin x, c1 = cos x − 1, cheap for small x
///   InverseSqrtNearOne(u) 1/√(1 + u), cheap for small u
///   Any(mask), All(mask) over the lanes
///   Value(x)             x without its derivatives
///
/// Templates name them without qualification after `using math::Sqrt;` and so on: `double` is found
/// by the using-declaration, the other two by argument-dependent lookup.
///
/// Everything on plain `double` is forced inline: a kernel compiled for one instruction set must
/// not leave a symbol behind that the linker could use for another one (see isa.h).
#define KINGPIN_INLINE [[gnu::always_inline]] inline

namespace kingpin::math {

KINGPIN_INLINE double Select(bool mask, double a, double b) { return mask ? a : b; }
KINGPIN_INLINE double Min(double a, double b) { return a < b ? a : b; }
KINGPIN_INLINE double Max(double a, double b) { return a > b ? a : b; }
KINGPIN_INLINE double Abs(double x) { return __builtin_fabs(x); }
KINGPIN_INLINE double Sqrt(double x) { return __builtin_sqrt(x); }
KINGPIN_INLINE double InverseSqrtNearOne(double u) { return 1.0 / __builtin_sqrt(1.0 + u); }
KINGPIN_INLINE double Exp(double x) { return ::exp(x); }
KINGPIN_INLINE void SinCos(double x, double& s, double& c) {
  s = ::sin(x);
  c = ::cos(x);
}
KINGPIN_INLINE void SinCosMinusOne(double x, double& s, double& c1) {
  s = ::sin(x);
  c1 = ::cos(x) - 1.0;
}
KINGPIN_INLINE bool Any(bool mask) { return mask; }
KINGPIN_INLINE bool All(bool mask) { return mask; }
KINGPIN_INLINE double Value(double x) { return x; }

}  // namespace kingpin::math
