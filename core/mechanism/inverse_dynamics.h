#pragma once

#include "core/mechanism/dynamics.h"

namespace kingpin::mechanism {

/// Accelerations of all links at given joint accelerations, after UpdatePositions and
/// UpdateVelocities:
///
///   A_L = A_P + V_P × V_J + Σ S_i q̈_i,   A_world = -g
///
/// A link's acceleration without gravity is A_L + g in its linear part. V_P × V_J is V_P × V_L,
/// because V_J = V_L - V_P.
template <class S>
KINGPIN_INLINE void UpdateAccelerations(const Model& model, const S* acceleration,
                                        Workspace<S>& w) {
  w.A[0] = {{}, -math::Convert<S>(model.gravity)};
  const int links = static_cast<int>(model.links.size());
  for (int l = 1; l < links; ++l) {
    const Link& link = model.links[l];
    Motion<S> A = w.A[link.parent] + Cross(w.V[link.parent], w.V[l]);
    for (int i = link.v; i < link.v + CountVelocities(link.kind); ++i) {
      A = A + acceleration[i] * w.axes[i];
    }
    w.A[l] = A;
  }
}

/// τ = M q̈ + bias, the generalised forces of the tree that go with the joint accelerations, by the
/// recursive Newton-Euler algorithm, after UpdatePositions and UpdateVelocities. The applied
/// wrenches in w.f and forces in w.generalised count as helping: without them τ is what the joints
/// must supply, with them what is still missing. Closures exert nothing here.
///
/// Leaves the accelerations in w.A, the inertias of the links in w.I, and in w.f what the subtrees
/// need; UpdateVelocities and new applied wrenches are due before the next evaluation.
///
/// Source: Featherstone (2008), table 5.1, with all vectors about one point.
///
/// @param force out: τ per velocity coordinate [N, N m]
template <class S>
KINGPIN_INLINE void CalcInverseDynamics(const Model& model, const S* acceleration, Workspace<S>& w,
                                        S* force) {
  UpdateAccelerations(model, acceleration, w);
  UpdateInertias(model, w);
  for (int l = static_cast<int>(model.links.size()) - 1; l > 0; --l) {
    const Link& link = model.links[l];
    for (int i = link.v; i < link.v + CountVelocities(link.kind); ++i) {
      force[i] = Dot(w.axes[i], w.f[l]) - w.generalised[i];
    }
    if (link.parent != 0) w.f[link.parent] = w.f[link.parent] + w.f[l];
  }
}

}  // namespace kingpin::mechanism
