#pragma once

#include "core/mechanism/workspace.h"

namespace kingpin::mechanism {

/// Deep trees. In joint coordinates every body's inertia couples all joints on its way to the root,
/// so that M of a chain of n bodies is dense. A tree that is deep is therefore cut through some of
/// its links: one half, with half the inertia, stays with the joint of the link, the other half
/// begins a segment of its own and carries the link's children. The halves are held together by six
/// rows. With â the acceleration of a segment's first half body beyond what it is at zero joint
/// accelerations, taken at the segment's own point o (the origin of the cut link), the unknowns are
/// q̈, â, the reactions R of the closures and the wrenches λ through the cuts:
///
///   [ M  D  C ; Dᵀ 0 0 ; Cᵀ 0 0 ] [(q̈, â) ; -R ; -λ] = [F ; s̈ - J̇v ; 0]
///
///   Cᵀ:  â_s - X (â_p + Σ S_j q̈_j) = 0,  p the segment that s hangs on, j the joints between
///
/// where M is block diagonal, a block per segment. This is an exact restatement, no approximation:
/// q̈ and R are those of the uncut equations. Eliminated in a fitting order (from the leaves, a
/// segment at a time) it costs what the articulated-body recursion costs, grows linearly with the
/// number of segments, and takes closures, derivatives and lanes as they come.
///
/// Each segment counts its motions and wrenches about its own point: inertias about a point r away
/// lose the digits of (r/ℓ)², ℓ the size of a link.
///
/// A link is fit to be cut if its own inertia is regular, so that both halves have inertia in every
/// direction (compile.cpp).

namespace internal {

/// o of a segment, from the reference point of the workspace.
template <class S>
KINGPIN_INLINE Vector3<S> GetSegmentPoint(const Model& model, int segment, const Workspace<S>& w) {
  return segment == 0 ? Vector3<S>{} : w.p[model.segments[segment].link];
}

/// Inertia and inertia force of a share of a link about the point o.
template <class S>
KINGPIN_INLINE void CalcInertia(const Link& link, double share, const Vector3<S>& o, int l,
                                const Workspace<S>& w, SpatialInertia<S>& I, Wrench<S>& f) {
  I = S(share) *
      math::MakeInertia(link.mass, link.centre, link.central_inertia, w.R[l], w.p[l] - o);
  const Motion<S> V = w.V[l].About(o);
  f = I * w.A[l].About(o) + Cross(V, I * V);
}

}  // namespace internal

/// What UpdateInertias does (dynamics.h), for a tree that is cut.
template <class S>
KINGPIN_INLINE void UpdateSegmentInertias(const Model& model, Workspace<S>& w) {
  const int links = static_cast<int>(model.links.size());
  for (int l = 1; l < links; ++l) {
    const Link& link = model.links[l];
    const Vector3<S> o = internal::GetSegmentPoint(model, model.segment[l], w);
    for (int i = link.v; i < link.v + CountVelocities(link.kind); ++i) {
      w.local_axes[i] = w.axes[i].About(o);
    }
    const Wrench<S> applied = w.f[l].About(o);
    const int s = model.starts_segment[l];
    w.I[l] = {};
    w.f[l] = {};
    if (link.mass != 0) internal::CalcInertia(link, s == 0 ? 1.0 : 0.5, o, l, w, w.I[l], w.f[l]);
    w.f[l] = w.f[l] - applied;
    if (s != 0) {
      const int half = links + s - 1;
      internal::CalcInertia(link, 0.5, w.p[l], l, w, w.I[half], w.f[half]);
    }
  }
}

/// Writes M and F of the coordinates of a cut, and the rows that hold its halves together, when
/// everything that the segment carries has been handed to its half body.
template <class S>
KINGPIN_INLINE void AssembleCut(const Model& model, int segment, const int*& slot,
                                Workspace<S>& w) {
  const Model::Segment& cut = model.segments[segment];
  const int half = static_cast<int>(model.links.size()) + segment - 1;
  const auto write = [&](const Motion<S>& a) {
    for (const S& x : {a.w.x, a.w.y, a.w.z, a.v.x, a.v.y, a.v.z}) w.k[*slot++] = x;
  };
  // the composite inertia, columns of its upper triangle
  const SpatialInertia<S>& I = w.I[half];
  const Vector3<S>& h = I.h;
  const S zero(0.0);
  for (const S& x : {I.xx,                         //
                     I.xy, I.yy,                   //
                     I.xz, I.yz, I.zz,             //
                     zero, h.z,  -h.y, I.m,        //
                     -h.z, zero, h.x,  zero, I.m,  //
                     h.y,  -h.x, zero, zero, zero, I.m}) {
    w.k[*slot++] = x;
  }
  const Wrench<S>& f = w.f[half];
  for (const S& x : {f.t.x, f.t.y, f.t.z, f.f.x, f.f.y, f.f.z}) w.k[*slot++] = -x;
  for (int c = 0; c < 6; ++c) w.k[*slot++] = S(1.0);
  const Link& link = model.links[cut.link];
  const Vector3<S>& o = w.p[cut.link];
  for (int j = link.v + CountVelocities(link.kind) - 1; j >= 0; j = model.segment_parent[j]) {
    write(S(-1.0) * w.axes[j].About(o));
  }
  if (cut.parent == 0) return;
  const Vector3<S> d = o - w.p[model.segments[cut.parent].link];
  for (int c = 0; c < 6; ++c) w.k[*slot++] = S(-1.0);
  // v at o = v + ω × d
  for (const S& x : {-d.z, d.y, d.z, -d.x, -d.y, d.x}) w.k[*slot++] = x;
}

/// The coordinates of cuts in the rows of closures.
template <class S>
KINGPIN_INLINE void AssembleCutTerms(const Model& model, Workspace<S>& w) {
  for (const Model::CutTerm& term : model.cut_terms) {
    if (model.IsLeftOut(term.row)) continue;
    const S factor = w.active[term.row] * S(term.sign);
    const Wrench<S> W =
        factor * w.W[term.row].About(internal::GetSegmentPoint(model, term.segment, w));
    const int* slot = term.slots;
    for (const S& x : {W.t.x, W.t.y, W.t.z, W.f.x, W.f.y, W.f.z}) w.k[*slot++] = x;
  }
}

/// The entries of the equations that AssembleCut writes, in its order: `entry(i, j)` for unknowns i
/// and j, `right(i)` for the right side of i.
template <class Entry, class Right>
void ListCutEntries(const Model& model, int segment, const Entry& entry, const Right& right) {
  const Model::Segment& cut = model.segments[segment];
  const int first = model.GetCutCoordinate(segment), row = model.GetCutRow(segment);
  for (int c = 0; c < 6; ++c) {
    for (int d = 0; d <= c; ++d) entry(first + c, first + d);
  }
  for (int c = 0; c < 6; ++c) right(first + c);
  for (int c = 0; c < 6; ++c) entry(first + c, row + c);
  const Link& link = model.links[cut.link];
  for (int j = link.v + CountVelocities(link.kind) - 1; j >= 0; j = model.segment_parent[j]) {
    for (int c = 0; c < 6; ++c) entry(j, row + c);
  }
  if (cut.parent == 0) return;
  const int before = model.GetCutCoordinate(cut.parent);
  for (int c = 0; c < 6; ++c) entry(before + c, row + c);
  // (ω y, v x), (ω z, v x), (ω x, v y), ...
  constexpr int kTurn[6] = {1, 2, 0, 2, 0, 1}, kMove[6] = {3, 3, 4, 4, 5, 5};
  for (int k = 0; k < 6; ++k) entry(before + kTurn[k], row + kMove[k]);
}

}  // namespace kingpin::mechanism
