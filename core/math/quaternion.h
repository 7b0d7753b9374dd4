#pragma once

#include "core/math/vector3.h"

namespace kingpin::math {

/// Unit quaternion w + x i + y j + z k of the rotation R_AB: p_A = q p_B q*. The two signs stand
/// for the same rotation.
template <class S>
struct Quaternion {
  S w{1.0}, x{}, y{}, z{};

  /// Hamilton's product; composes rotations like their matrices.
  KINGPIN_INLINE friend Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
  }
};

/// The rotation matrix of q/|q|: a quaternion that integration has carried off the unit sphere
/// still gives an exact rotation.
template <class S>
KINGPIN_INLINE Rotation<S> MakeRotation(const Quaternion<S>& q) {
  const S s = S(2.0) / (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const S xs = s * q.x, ys = s * q.y, zs = s * q.z;
  const S wx = q.w * xs, wy = q.w * ys, wz = q.w * zs;
  const S xx = q.x * xs, xy = q.x * ys, xz = q.x * zs;
  const S yy = q.y * ys, yz = q.y * zs, zz = q.z * zs;
  const S one(1.0);
  return {{one - (yy + zz), xy + wz, xz - wy},
          {xy - wz, one - (xx + zz), yz + wx},
          {xz + wy, yz - wx, one - (xx + yy)}};
}

/// dq/dt = 1/2 q (0, w_B) for the angular velocity w_B of B in A, expressed in B.
template <class S>
KINGPIN_INLINE Quaternion<S> CalcRate(const Quaternion<S>& q, const Vector3<S>& w_B) {
  const S half(0.5);
  return {-half * (q.x * w_B.x + q.y * w_B.y + q.z * w_B.z),
          half * (q.w * w_B.x + q.y * w_B.z - q.z * w_B.y),
          half * (q.w * w_B.y + q.z * w_B.x - q.x * w_B.z),
          half * (q.w * w_B.z + q.x * w_B.y - q.y * w_B.x)};
}

/// Quaternion of a rotation matrix, w >= 0, by Shepperd's choice of the largest component.
Quaternion<double> MakeQuaternion(const Rotation<double>& R);

/// The rotation by |r| about r (exponential map).
Quaternion<double> MakeQuaternion(const Vector3<double>& rotation_vector);

/// A rotation whose z axis is the unit vector `z`; x is the projection of the coordinate axis least
/// aligned with z.
Rotation<double> MakeRotationWithZ(const Vector3<double>& z);

}  // namespace kingpin::math
