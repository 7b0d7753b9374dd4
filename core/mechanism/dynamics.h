#pragma once

#include "core/mechanism/closures.h"
#include "core/mechanism/kinematics.h"
#include "core/mechanism/segments.h"

namespace kingpin::mechanism {

/// Inertias and inertia forces of the links about the reference point:
///
///   I_L in world axes,   f_L = I_L A_L + V_L ×* (I_L V_L) - f_applied
///
/// Reads the applied wrenches in w.f and replaces them.
template <class S>
KINGPIN_INLINE void UpdateInertias(const Model& model, Workspace<S>& w) {
  const int links = static_cast<int>(model.links.size());
  for (int l = 1; l < links; ++l) {
    const Link& link = model.links[l];
    if (link.mass == 0) {
      w.I[l] = {};
      w.f[l] = Wrench<S>{} - w.f[l];
      continue;
    }
    w.I[l] = math::MakeInertia(link.mass, link.centre, link.central_inertia, w.R[l], w.p[l]);
    w.f[l] = w.I[l] * w.A[l] + Cross(w.V[l], w.I[l] * w.V[l]) - w.f[l];
  }
}

/// Writes M into the factor's storage and F = τ - bias into the right side, leaves to root
/// (composite rigid bodies and the recursive Newton-Euler algorithm in one sweep).
template <class S>
KINGPIN_INLINE void AssembleMassAndForces(const Model& model, Workspace<S>& w) {
  const Motion<S>* axes = model.CountCuts() > 0 ? w.local_axes.data() : w.axes.data();
  const int* cut_slot = model.cut_slots.data();
  // the last coordinate of the free root that carries the reference point
  const int root = model.reference_link != 0 ? model.links[model.reference_link].v + 5 : -1;
  for (int l = static_cast<int>(model.links.size()) - 1; l > 0; --l) {
    const Link& link = model.links[l];
    if (const int s = model.starts_segment[l]) AssembleCut(model, s, cut_slot, w);
    for (int i = link.v + CountVelocities(link.kind) - 1; i >= link.v; --i) {
      w.k[model.pattern.GetRightSideSlot(i)] = w.generalised[i] - Dot(axes[i], w.f[l]);
      const Wrench<S> momentum = w.I[l] * axes[i];
      const int* slot = &model.mass_slots[model.mass_begin[i]];
      const auto& [t, f] = momentum;
      int j = i;
      for (; j >= 0 && j != root; j = model.segment_parent[j]) {
        w.k[*slot++] = Dot(axes[j], momentum);
      }
      if (j >= 0) {  // the free root's axes pass through the reference point
        const Rotation<S>& R = w.R[model.reference_link];
        for (const S& x :
             {Dot(R.z, t), Dot(R.y, t), Dot(R.x, t), Dot(R.z, f), Dot(R.y, f), Dot(R.x, f)}) {
          w.k[*slot++] = x;
        }
      }
      if (model.segment[l] == 0) continue;
      for (const S& x : {t.x, t.y, t.z, f.x, f.y, f.z}) w.k[*slot++] = x;
    }
    if (const int carrier = model.carrier[l]) {
      w.I[carrier] = w.I[carrier] + w.I[l];
      w.f[carrier] = w.f[carrier] + w.f[l];
    }
  }
}

/// Writes D and the right side of the constraint rows, Dᵀ q̈ = s̈ - J̇v. A row that is not active gets
/// the equation R_r = 0.
template <class S>
KINGPIN_INLINE void AssembleConstraints(const Model& model, const S* drive_acceleration,
                                        Workspace<S>& w) {
  for (int r = 0; r < model.rows; ++r) {
    const S active = w.active[r];
    const int position = model.pattern.position(model.coordinates + r);
    w.k[position] = active - S(1.0);
    w.k[model.pattern.GetRightSideSlot(model.coordinates + r)] =
        active * (drive_acceleration[r] - w.bias[r]);
    if (model.IsLeftOut(r)) continue;
    for (int s = model.row_term_begin[r]; s < model.row_term_begin[r + 1]; ++s) {
      const Model::RowTerm& term = model.row_terms[s];
      w.k[term.slot] = (active * S(term.sign)) * Dot(w.axes[term.dof], w.W[r]);
    }
  }
  AssembleCutTerms(model, w);
  const int* slot = model.linear_slots.data();
  for (const LinearRow& row : model.linear) {
    if (model.IsLeftOut(row.row)) continue;
    for (const LinearRow::Term& term : row.terms) w.k[*slot++] = w.active[row.row] * S(term.factor);
  }
}

/// Whether every pivot kept its sign and stayed away from zero (`Model::pivot_limits`). If not, the
/// factorisation has lost digits, or the mechanism is in a singular position: SolveAccelerations
/// then takes a dense way.
template <class S>
bool PivotsAreSafe(const Model& model, const Workspace<S>& w) {
  using math::Value;
  bool safe = true;
  for (int k = 0; k < model.pattern.unknowns(); ++k) {
    // the factor keeps 1/d: d beyond a limit of its sign is 1/d of that sign and below 1/limit in
    // size
    const double share = Value(w.k[k]) * model.pivot_limits[k];
    safe &= share > 0 && share < 1;
  }
  return safe;
}

/// Forms the equations at (q, v) with the wrenches in w.f and forces in w.generalised:
///
///   [ M  D ; Dᵀ  0 ] [q̈ ; -R] = [F ; s̈ - J̇v]
///
/// that is M q̈ - D R = F, -Dᵀ q̈ = G of the paper's (4.1) with G = J̇v - s̈; of a deep tree in the
/// larger but sparser form of segments.h.
template <class S>
KINGPIN_INLINE void AssembleEquations(const Model& model, const S* drive_acceleration,
                                      Workspace<S>& w) {
  for (int slot : model.fill_slots) w.k[slot] = S(0.0);
  if (model.CountCuts() > 0) {
    UpdateSegmentInertias(model, w);
  } else {
    UpdateInertias(model, w);
  }
  AssembleMassAndForces(model, w);
  AssembleConstraints(model, drive_acceleration, w);
}

}  // namespace kingpin::mechanism
