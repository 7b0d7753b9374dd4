#pragma once

#include "core/math/cubic_spline.h"
#include "models/planar/parameters.h"

namespace kingpin::planar {

/// The spline of a curve's kind through its nodes; everything that evaluates a curve goes through
/// here.
template <class S>
math::CubicSpline<S, kMaxCurveNodes> MakeSpline(const Curve<S>& curve) {
  using Spline = math::CubicSpline<S, kMaxCurveNodes>;
  return curve.kind == CurveKind::kMonotone
             ? Spline::MakeMonotone(curve.count, curve.x.data(), curve.f.data())
             : Spline::MakeNatural(curve.count, curve.x.data(), curve.f.data());
}

}  // namespace kingpin::planar
