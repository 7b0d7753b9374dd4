#pragma once

#include "core/math/elementary.h"
#include "core/math/vector3.h"

namespace kingpin::joints {

using math::Rotation;
using math::Vector3;

/// The rotation vector r of R = exp(r×), |r| <= π, and the map between its rate and the angular
/// velocity ω (in the axes that R leads to, where r has the same components as in those it comes
/// from):
///
///   ṙ = ω - 1/2 r×ω + g r×(r×ω),  g = (1 - θ/2 cot θ/2)/θ²,  θ = |r|
///
/// (Bullo and Murray 1995; the inverse left Jacobian of SO(3).) A moment m that works on r, with
/// power m·ṙ, is the torque m + 1/2 r×m + g r×(r×m), with the same power along ω. At θ = π the
/// vector jumps to its opposite.
template <class S>
struct RotationVector {
  Vector3<S> r;
  S g;

  explicit RotationVector(const Rotation<S>& R);

  Vector3<S> CalcRate(const Vector3<S>& w) const {
    const Vector3<S> rw = Cross(r, w);
    return w - S(0.5) * rw + g * Cross(r, rw);
  }
  Vector3<S> CalcTorque(const Vector3<S>& m) const {
    const Vector3<S> rm = Cross(r, m);
    return m + S(0.5) * rm + g * Cross(r, rm);
  }
};

template <class S>
RotationVector<S>::RotationVector(const Rotation<S>& R) {
  using math::Atan2;
  using math::Sqrt;
  using math::Value;
  // The quaternion by Shepperd's choice of its largest component, times four times that component.
  const S xx = R.x.x, yy = R.y.y, zz = R.z.z, trace = xx + yy + zz;
  const S x = R.y.z - R.z.y, y = R.z.x - R.x.z, z = R.x.y - R.y.x;
  const double t = Value(trace), dx = Value(xx), dy = Value(yy), dz = Value(zz);
  S w;
  Vector3<S> u;
  if (t >= dx && t >= dy && t >= dz) {
    w = S(1.0) + trace;
    u = {x, y, z};
  } else if (dx >= dy && dx >= dz) {
    w = x;
    u = {S(1.0) + xx - yy - zz, R.x.y + R.y.x, R.z.x + R.x.z};
  } else if (dy >= dz) {
    w = y;
    u = {R.x.y + R.y.x, S(1.0) + yy - xx - zz, R.y.z + R.z.y};
  } else {
    w = z;
    u = {R.z.x + R.x.z, R.y.z + R.z.y, S(1.0) + zz - xx - yy};
  }
  if (Value(w) < 0) {
    w = -w;
    u = -u;
  }
  const S s2 = Dot(u, u) / (Dot(u, u) + w * w);  // sin² θ/2
  if (Value(s2) < 1e-2) {
    // θ = 2 asin s and its g as series in s² and θ², where quotients would divide zero by zero.
    // Odd terms of asin: (2k)!/(4ᵏ k!² (2k+1)).
    const S asin_over_s =
        1.0 +
        s2 * (1.0 / 6 +
              s2 * (3.0 / 40 +
                    s2 * (5.0 / 112 +
                          s2 * (35.0 / 1152 + s2 * (63.0 / 2816 + s2 * (231.0 / 13312 +
                                                                        s2 * (143.0 / 10240)))))));
    r = (2.0 * asin_over_s / Sqrt(Dot(u, u) + w * w)) * u;
    const S theta2 = Dot(r, r);
    g = 1.0 / 12 +
        theta2 * (1.0 / 720 +
                  theta2 * (1.0 / 30240 + theta2 * (1.0 / 1209600 + theta2 * (1.0 / 47900160))));
  } else {
    const S sine = Sqrt(Dot(u, u));
    const S half = Atan2(sine, w);
    r = (2.0 * half / sine) * u;
    g = (1.0 - half * w / sine) / (4.0 * half * half);
  }
}

}  // namespace kingpin::joints
