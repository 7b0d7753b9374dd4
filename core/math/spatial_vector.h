#pragma once

#include "core/math/vector3.h"

namespace kingpin::math {

/// Motion of a rigid body (velocity, acceleration, joint axis): angular part w, and linear part v
/// of the body's point that is at the reference point. All vectors of one computation share the
/// reference point and the axes (Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 2).
template <class S>
struct Motion {
  Vector3<S> w, v;

  KINGPIN_INLINE friend Motion operator+(const Motion& a, const Motion& b) {
    return {a.w + b.w, a.v + b.v};
  }
  KINGPIN_INLINE friend Motion operator-(const Motion& a, const Motion& b) {
    return {a.w - b.w, a.v - b.v};
  }
  KINGPIN_INLINE friend Motion operator*(const S& s, const Motion& a) { return {s * a.w, s * a.v}; }
  /// The same motion with its reference point moved to o.
  KINGPIN_INLINE Motion About(const Vector3<S>& o) const { return {w, v + Cross(w, o)}; }
  /// Velocity of the body's point at p (from the reference point).
  KINGPIN_INLINE Vector3<S> At(const Vector3<S>& p) const { return v + Cross(w, p); }
};

/// Force on a rigid body: torque t about the reference point, and force f.
template <class S>
struct Wrench {
  Vector3<S> t, f;

  KINGPIN_INLINE friend Wrench operator+(const Wrench& a, const Wrench& b) {
    return {a.t + b.t, a.f + b.f};
  }
  KINGPIN_INLINE friend Wrench operator-(const Wrench& a, const Wrench& b) {
    return {a.t - b.t, a.f - b.f};
  }
  KINGPIN_INLINE friend Wrench operator*(const S& s, const Wrench& a) { return {s * a.t, s * a.f}; }
  /// The same wrench with its reference point moved to o.
  KINGPIN_INLINE Wrench About(const Vector3<S>& o) const { return {t - Cross(o, f), f}; }
};

/// The wrench of force f at point p.
template <class S>
KINGPIN_INLINE Wrench<S> MakeWrench(const Vector3<S>& p, const Vector3<S>& f) {
  return {Cross(p, f), f};
}

/// Power of a wrench along a motion.
template <class S>
KINGPIN_INLINE S Dot(const Motion<S>& m, const Wrench<S>& w) {
  return Dot(m.w, w.t) + Dot(m.v, w.f);
}

/// a x b: rate of a motion vector b that is fixed in a body moving with a.
template <class S>
KINGPIN_INLINE Motion<S> Cross(const Motion<S>& a, const Motion<S>& b) {
  return {Cross(a.w, b.w), Cross(a.w, b.v) + Cross(a.v, b.w)};
}

/// a x* b: rate of a wrench b that is fixed in a body moving with a.
template <class S>
KINGPIN_INLINE Wrench<S> Cross(const Motion<S>& a, const Wrench<S>& b) {
  return {Cross(a.w, b.t) + Cross(a.v, b.f), Cross(a.w, b.f)};
}

/// Rigid-body inertia about the reference point: mass m, first moment h = m c, and the inertia
/// tensor about the reference point. Inertias about one point in one set of axes add.
template <class S>
struct SpatialInertia {
  S m{};
  Vector3<S> h;
  S xx{}, yy{}, zz{}, xy{}, xz{}, yz{};  ///< entries of the tensor (xy = -int x y dm)

  KINGPIN_INLINE friend SpatialInertia operator+(const SpatialInertia& a, const SpatialInertia& b) {
    return {a.m + b.m,   a.h + b.h,   a.xx + b.xx, a.yy + b.yy,
            a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  }
  KINGPIN_INLINE friend SpatialInertia operator*(const S& s, const SpatialInertia& a) {
    return {s * a.m, s * a.h, s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
  }
  /// Momentum of a motion: t = I w + h x v, f = m v + w x h.
  KINGPIN_INLINE friend Wrench<S> operator*(const SpatialInertia& I, const Motion<S>& a) {
    return {{I.xx * a.w.x + I.xy * a.w.y + I.xz * a.w.z + (I.h.y * a.v.z - I.h.z * a.v.y),
             I.xy * a.w.x + I.yy * a.w.y + I.yz * a.w.z + (I.h.z * a.v.x - I.h.x * a.v.z),
             I.xz * a.w.x + I.yz * a.w.y + I.zz * a.w.z + (I.h.x * a.v.y - I.h.y * a.v.x)},
            {I.m * a.v.x + (a.w.y * I.h.z - a.w.z * I.h.y),
             I.m * a.v.y + (a.w.z * I.h.x - a.w.x * I.h.z),
             I.m * a.v.z + (a.w.x * I.h.y - a.w.y * I.h.x)}};
  }
};

/// The inertia of a body with mass m, centre of mass c and central tensor J (both in the body frame
/// B), about the reference point and in the axes of the frame that R and p lead to: R rotates from
/// B, p is B's origin. J is given with the body, `central` = {Jxx, Jyy, Jzz, Jxy, Jxz, Jyz}.
template <class S, class P>
KINGPIN_INLINE SpatialInertia<S> MakeInertia(const P& mass, const Vector3<P>& centre,
                                             const P (&central)[6], const Rotation<S>& R,
                                             const Vector3<S>& p) {
  const S m(mass);
  const Vector3<S> c = R * Convert<S>(centre) + p;
  // R J R^T, columns first
  const Vector3<S> a = S(central[0]) * R.x + S(central[3]) * R.y + S(central[4]) * R.z;
  const Vector3<S> b = S(central[3]) * R.x + S(central[1]) * R.y + S(central[5]) * R.z;
  const Vector3<S> d = S(central[4]) * R.x + S(central[5]) * R.y + S(central[2]) * R.z;
  const Vector3<S> h = m * c;
  const S cxx = h.x * c.x, cyy = h.y * c.y, czz = h.z * c.z;
  return {m,
          h,
          a.x * R.x.x + b.x * R.y.x + d.x * R.z.x + (cyy + czz),
          a.y * R.x.y + b.y * R.y.y + d.y * R.z.y + (cxx + czz),
          a.z * R.x.z + b.z * R.y.z + d.z * R.z.z + (cxx + cyy),
          a.x * R.x.y + b.x * R.y.y + d.x * R.z.y - h.x * c.y,
          a.x * R.x.z + b.x * R.y.z + d.x * R.z.z - h.x * c.z,
          a.y * R.x.z + b.y * R.y.z + d.y * R.z.z - h.y * c.z};
}

}  // namespace kingpin::math
