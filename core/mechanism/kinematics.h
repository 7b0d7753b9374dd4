#pragma once

#include "core/math/quaternion.h"
#include "core/mechanism/workspace.h"

namespace kingpin::mechanism {

namespace internal {

/// The rotation by `angle` about the frame's own z axis, after R.
template <class S>
KINGPIN_INLINE Rotation<S> TurnAboutZ(const Rotation<S>& R, const S& angle) {
  using math::SinCos;
  S s, c;
  SinCos(angle, s, c);
  return {c * R.x + s * R.y, c * R.y - s * R.x, R.z};
}

}  // namespace internal

/// Poses of all links and the joint axes S_i, from q.
///
///   X_WL = X_WP X_PF X_FL(q)
///
/// A joint's axes: revolute S = (z, p×z), prismatic (0, z), screw (z, p×z + h z), spherical (e_k,
/// p×e_k) with e_k the link's own axes, free the same after three translations (0, e_k) along them;
/// p from the reference point.
template <class S>
KINGPIN_INLINE void UpdatePositions(const Model& model, const S* q, Workspace<S>& w) {
  using math::Convert;
  w.R[0] = {};
  w.reference = {};
  if (const int root = model.reference_link) {
    const Link& link = model.links[root];
    const S* x = q + link.q;
    w.reference = Convert<S>(link.X_PF.R) * Vector3<S>{x[0], x[1], x[2]} + Convert<S>(link.X_PF.p);
  }
  w.p[0] = -w.reference;
  const int links = static_cast<int>(model.links.size());
  for (int l = 1; l < links; ++l) {
    const Link& link = model.links[l];
    const Rotation<S>& R_P = w.R[link.parent];
    const Rotation<S> R_F = R_P * Convert<S>(link.X_PF.R);
    Vector3<S> p = R_P * Convert<S>(link.X_PF.p) + w.p[link.parent];
    const S* x = q + link.q;
    Motion<S>* axes = &w.axes[link.v];
    switch (link.kind) {
      case JointKind::kRevolute:
        w.R[l] = internal::TurnAboutZ(R_F, x[0]);
        axes[0] = {R_F.z, Cross(p, R_F.z)};
        break;
      case JointKind::kPrismatic:
        w.R[l] = R_F;
        p += x[0] * R_F.z;
        axes[0] = {{}, R_F.z};
        break;
      case JointKind::kScrew:
        w.R[l] = internal::TurnAboutZ(R_F, x[0]);
        axes[0] = {R_F.z, Cross(p, R_F.z) + S(link.pitch) * R_F.z};
        p += (S(link.pitch) * x[0]) * R_F.z;
        break;
      case JointKind::kFree:
        if (l == model.reference_link) {
          p = {};  // exactly, instead of the difference of two large numbers
        } else {
          p += R_F * Vector3<S>{x[0], x[1], x[2]};
        }
        x += 3;
        [[fallthrough]];
      case JointKind::kSpherical: {
        const Rotation<S> R = R_F * MakeRotation(math::Quaternion<S>{x[0], x[1], x[2], x[3]});
        w.R[l] = R;
        if (link.kind == JointKind::kFree) {
          axes[0] = {{}, R.x};
          axes[1] = {{}, R.y};
          axes[2] = {{}, R.z};
          axes += 3;
        }
        axes[0] = {R.x, Cross(p, R.x)};
        axes[1] = {R.y, Cross(p, R.y)};
        axes[2] = {R.z, Cross(p, R.z)};
        break;
      }
    }
    w.p[l] = p;
  }
}

/// Velocities of all links, and their accelerations at zero joint accelerations.
///
///   V_L = V_P + V_J,   V_J = Σ S_i v_i,   A_L = A_P + V_P × V_J,   A_world = -g
///
/// One rule for every joint: axes fixed in the parent turn with V_P, axes fixed in the link with
/// V_L, and V_L × V_J = V_P × V_J.
template <class S>
KINGPIN_INLINE void UpdateVelocities(const Model& model, const S* v, Workspace<S>& w) {
  w.V[0] = {};
  w.A[0] = {{}, -math::Convert<S>(model.gravity)};
  const int links = static_cast<int>(model.links.size());
  for (int l = 1; l < links; ++l) {
    const Link& link = model.links[l];
    const Motion<S>* axes = &w.axes[link.v];
    Motion<S> joint = v[link.v] * axes[0];
    const int dofs = CountVelocities(link.kind);
    for (int i = 1; i < dofs; ++i) joint = joint + v[link.v + i] * axes[i];
    w.V[l] = w.V[link.parent] + joint;
    w.A[l] = w.A[link.parent] + Cross(w.V[link.parent], joint);
  }
}

/// dq/dt of v.
template <class S>
KINGPIN_INLINE void CalcPositionRates(const Model& model, const S* q, const S* v, S* rate) {
  const int links = static_cast<int>(model.links.size());
  for (int l = 1; l < links; ++l) {
    const Link& link = model.links[l];
    const S* x = q + link.q;
    const S* u = v + link.v;
    S* dx = rate + link.q;
    if (CountVelocities(link.kind) == 1) {
      dx[0] = u[0];
      continue;
    }
    if (link.kind == JointKind::kFree) {
      const Vector3<S> dp =
          MakeRotation(math::Quaternion<S>{x[3], x[4], x[5], x[6]}) * Vector3<S>{u[0], u[1], u[2]};
      dx[0] = dp.x, dx[1] = dp.y, dx[2] = dp.z;
      x += 3, u += 3, dx += 3;
    }
    const auto dq =
        CalcRate(math::Quaternion<S>{x[0], x[1], x[2], x[3]}, Vector3<S>{u[0], u[1], u[2]});
    dx[0] = dq.w, dx[1] = dq.x, dx[2] = dq.y, dx[3] = dq.z;
  }
}

}  // namespace kingpin::mechanism
