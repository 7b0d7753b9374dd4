#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/math/elementary.h"
#include "joints/relative_motion.h"

/// Where forces with one degree of freedom act. Each place computes its quantity x with its rate,
/// and applies a force F along it so that the power is F ẋ exactly: on bodies that is the force
/// F ∂x/∂q, on a potential U(x) its exact gradient.
namespace kingpin::joints {

using mechanism::Dual8;
using mechanism::ForceContext;

namespace internal {

/// x without its derivatives.
template <class S>
double GetNumber(const S& x) {
  using math::Value;
  return Value(x);
}

}  // namespace internal

/// x = |p_B - p_A|, ẋ = n·(v_B - v_A), with n from A to B. Where the points meet, n is zero.
struct PointPlace {
  mechanism::Frame a, b;

  template <class S>
  struct Value {
    S x, rate;
    Vector3<S> n, p_A, p_B;
  };
  template <class S>
  Value<S> Calc(const ForceContext<S>& context) const {
    using math::Sqrt;
    const auto& w = context.w;
    Value<S> value;
    value.p_A = w.R[a.link] * math::Convert<S>(a.X_LF.p) + w.p[a.link];
    value.p_B = w.R[b.link] * math::Convert<S>(b.X_LF.p) + w.p[b.link];
    const Vector3<S> d = value.p_B - value.p_A;
    // the addend is below the rounding of any distance, and keeps zero from being divided by zero
    value.x = Sqrt(Dot(d, d) + S(1e-300));
    value.n = (S(1.0) / value.x) * d;
    value.rate = Dot(value.n, w.V[b.link].At(value.p_B) - w.V[a.link].At(value.p_A));
    return value;
  }
  template <class S>
  void Apply(const ForceContext<S>& context, const Value<S>& value, const S& force) const {
    AddBetween(context.w, a.link, b.link, value.p_B, force * value.n, Vector3<S>{});
  }
};

/// The twist of B against A about A's z axis: with the relative rotation's quaternion (w, x, y, z)
///
///   θ = 2 atan(z/w) = atan2(s, c),  s = x_B·y_A - y_B·x_A,  c = x_B·x_A + y_B·y_A
///
/// θ̇ = n·(ω_B - ω_A) with n = (c (x_B×y_A - y_B×x_A) - s (x_B×x_A + y_B×y_A))/(c² + s²), which is
/// z when the axes are parallel. Undefined when the z axes are opposite.
///
/// θ jumps from π to -π. Where joints that turn about the axis alone lie between the frames, full
/// turns come from their coordinates: θ is the one nearest to offset + Σ sign q.
struct AxisPlace {
  mechanism::Frame a, b;
  struct Turn {
    int q = 0;
    double sign = 1;
  };
  std::vector<Turn> turns;  ///< empty: θ in (-π, π]
  double offset = 0;

  template <class S>
  struct Value {
    S x, rate;
    Vector3<S> n;
  };
  template <class S>
  Value<S> Calc(const ForceContext<S>& context) const {
    using math::Atan2;
    const auto& w = context.w;
    const Rotation<S> A = w.R[a.link] * math::Convert<S>(a.X_LF.R);
    const Rotation<S> B = w.R[b.link] * math::Convert<S>(b.X_LF.R);
    const S s = Dot(B.x, A.y) - Dot(B.y, A.x), c = Dot(B.x, A.x) + Dot(B.y, A.y);
    Value<S> value;
    value.x = Atan2(s, c);
    if (!turns.empty()) {
      double counted = offset;
      for (const Turn& turn : turns) counted += turn.sign * internal::GetNumber(context.q[turn.q]);
      constexpr double kFull = 2 * std::numbers::pi;
      value.x = value.x + S(kFull * std::round((counted - internal::GetNumber(value.x)) / kFull));
    }
    value.n = (S(1.0) / (s * s + c * c)) *
              (c * (Cross(B.x, A.y) - Cross(B.y, A.x)) - s * (Cross(B.x, A.x) + Cross(B.y, A.y)));
    value.rate = Dot(value.n, w.V[b.link].w - w.V[a.link].w);
    return value;
  }
  template <class S>
  void Apply(const ForceContext<S>& context, const Value<S>& value, const S& force) const {
    AddBetween(context.w, a.link, b.link, Vector3<S>{}, Vector3<S>{}, force * value.n);
  }
};

/// x = q, ẋ = v of one coordinate.
struct CoordinatePlace {
  int q = 0, v = 0;

  template <class S>
  struct Value {
    S x, rate;
  };
  template <class S>
  Value<S> Calc(const ForceContext<S>& context) const {
    return {context.q[q], context.v[v]};
  }
  template <class S>
  void Apply(const ForceContext<S>& context, const Value<S>& /*value*/, const S& force) const {
    context.w.generalised[v] += force;
  }
};

}  // namespace kingpin::joints
