#pragma once

#include "core/math/scalar.h"

namespace kingpin::math {

/// Three components along axes that the context names. A plain struct instead of an Eigen vector:
/// GCC 12 keeps it in registers, and it works unchanged for every scalar.
template <class S>
struct Vector3 {
  S x{}, y{}, z{};

  KINGPIN_INLINE friend Vector3 operator+(const Vector3& a, const Vector3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  KINGPIN_INLINE friend Vector3 operator-(const Vector3& a, const Vector3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  KINGPIN_INLINE friend Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
  KINGPIN_INLINE friend Vector3 operator*(const S& s, const Vector3& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
  KINGPIN_INLINE Vector3& operator+=(const Vector3& b) { return *this = *this + b; }
  KINGPIN_INLINE Vector3& operator-=(const Vector3& b) { return *this = *this - b; }
};

template <class S>
KINGPIN_INLINE S Dot(const Vector3<S>& a, const Vector3<S>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class S>
KINGPIN_INLINE Vector3<S> Cross(const Vector3<S>& a, const Vector3<S>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// |a|.
template <class S>
KINGPIN_INLINE S CalcNorm(const Vector3<S>& a) {
  using math::Sqrt;
  return Sqrt(Dot(a, a));
}

/// A constant vector (a parameter of the model) as one of scalar S.
template <class S, class P>
KINGPIN_INLINE Vector3<S> Convert(const Vector3<P>& a) {
  return {S(a.x), S(a.y), S(a.z)};
}

/// Rotation matrix by its columns: the unit vectors x, y, z of frame B expressed in frame A. `R_AB
/// * p_B` gives p_A.
template <class S>
struct Rotation {
  Vector3<S> x{S(1.0), S(0.0), S(0.0)}, y{S(0.0), S(1.0), S(0.0)}, z{S(0.0), S(0.0), S(1.0)};

  KINGPIN_INLINE friend Vector3<S> operator*(const Rotation& R, const Vector3<S>& p) {
    return {R.x.x * p.x + R.y.x * p.y + R.z.x * p.z, R.x.y * p.x + R.y.y * p.y + R.z.y * p.z,
            R.x.z * p.x + R.y.z * p.y + R.z.z * p.z};
  }
  KINGPIN_INLINE friend Rotation operator*(const Rotation& a, const Rotation& b) {
    return {a * b.x, a * b.y, a * b.z};
  }
  /// R^T p.
  KINGPIN_INLINE Vector3<S> TransposeTimes(const Vector3<S>& p) const {
    return {Dot(x, p), Dot(y, p), Dot(z, p)};
  }
  KINGPIN_INLINE Rotation Transpose() const {
    return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
  }
};

template <class S, class P>
KINGPIN_INLINE Rotation<S> Convert(const Rotation<P>& R) {
  return {Convert<S>(R.x), Convert<S>(R.y), Convert<S>(R.z)};
}

/// The homogeneous transform X_AB stored as rotation and translation: p_A = R_AB p_B + p_AB.
template <class S>
struct Transform {
  Rotation<S> R;
  Vector3<S> p;

  KINGPIN_INLINE friend Vector3<S> operator*(const Transform& X, const Vector3<S>& r) {
    return X.R * r + X.p;
  }
  KINGPIN_INLINE friend Transform operator*(const Transform& a, const Transform& b) {
    return {a.R * b.R, a.R * b.p + a.p};
  }
  KINGPIN_INLINE Transform Inverse() const { return {R.Transpose(), -(R.TransposeTimes(p))}; }
};

}  // namespace kingpin::math
