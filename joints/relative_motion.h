#pragma once

#include "core/mechanism/system.h"

namespace kingpin::joints {

using math::Rotation;
using math::Vector3;

/// How frame B stands and moves against frame A, in the axes of A: position of B's origin, its
/// velocity as seen from A, and the angular velocity against A.
template <class S>
struct RelativeMotion {
  Rotation<S> R;
  Vector3<S> p, v, w;
};

/// Two frames in the world while a force between them is evaluated.
template <class S>
struct FramePair {
  Rotation<S> R_A, R_B;
  Vector3<S> p_A, p_B;  ///< from the reference point

  FramePair(const mechanism::Workspace<S>& w, const mechanism::Frame& a, const mechanism::Frame& b)
      : R_A(w.R[a.link] * math::Convert<S>(a.X_LF.R)),
        R_B(w.R[b.link] * math::Convert<S>(b.X_LF.R)),
        p_A(w.R[a.link] * math::Convert<S>(a.X_LF.p) + w.p[a.link]),
        p_B(w.R[b.link] * math::Convert<S>(b.X_LF.p) + w.p[b.link]) {}

  RelativeMotion<S> CalcMotion(const mechanism::Workspace<S>& w, int link_a, int link_b) const {
    const math::Motion<S> V = w.V[link_b] - w.V[link_a];
    return {R_A.Transpose() * R_B, R_A.TransposeTimes(p_B - p_A), R_A.TransposeTimes(V.At(p_B)),
            R_A.TransposeTimes(V.w)};
  }
};

/// Adds a force at a point (from the reference point) and a torque, world axes, to link b, and the
/// opposite to link a.
template <class S>
void AddBetween(mechanism::Workspace<S>& w, int link_a, int link_b, const Vector3<S>& point,
                const Vector3<S>& force, const Vector3<S>& torque) {
  const math::Wrench<S> wrench{Cross(point, force) + torque, force};
  w.f[link_b] = w.f[link_b] + wrench;
  w.f[link_a] = w.f[link_a] - wrench;
}

}  // namespace kingpin::joints
