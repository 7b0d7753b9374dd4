#pragma once

#include <vector>

#include "core/math/spatial_vector.h"
#include "core/mechanism/model.h"

namespace kingpin::mechanism {

using math::Motion;
using math::SpatialInertia;
using math::Wrench;

/// Every scratch value of one thread's evaluations. World axes; positions, motions and wrenches
/// refer to the origin of `model.reference_link` (at this instant: the point itself stands still,
/// so no term of its motion appears).
template <class S>
struct Workspace {
  explicit Workspace(const Model& model);

  // per link, [0] the world
  std::vector<Rotation<S>> R;        ///< R_WL
  std::vector<Vector3<S>> p;         ///< origin
  std::vector<Motion<S>> V;          ///< velocity
  std::vector<Motion<S>> A;          ///< acceleration at zero joint accelerations, minus gravity
  std::vector<SpatialInertia<S>> I;  ///< of the link, then of the subtree it carries; halves of
                                     ///< links that are cut come after all links
  std::vector<Wrench<S>>
      f;  ///< applied wrenches (input), then inertia minus applied force of the subtree
  std::vector<Motion<S>> axes;        ///< per velocity coordinate: S_i
  std::vector<Motion<S>> local_axes;  ///< S_i about the segment's own point, if the tree is cut

  std::vector<S> generalised;  ///< per velocity coordinate: applied force (input)
  std::vector<Wrench<S>> W;    ///< per row of a closure: unit reaction on link a
  std::vector<S> residual;     ///< per row: Φ
  std::vector<S> bias;         ///< per row: Dᵀ-rate, J̇ v
  std::vector<S> k;            ///< the equations, then their factor
  std::vector<S> x;            ///< solution, in elimination order
  std::vector<S> kept_k;       ///< the equations, for when the pivots turn out unsafe
  std::vector<S> active;  ///< per row: 1, or 0 for a row that is out (redundant, or dry friction
                          ///< unless it sticks)
  bool singular = false;  ///< the last equations were near a singular position, solved densely

  /// Where the reference point is in the world [m].
  Vector3<S> reference;
};

template <class S>
Workspace<S>::Workspace(const Model& model)
    : R(model.links.size()),
      p(model.links.size()),
      V(model.links.size()),
      A(model.links.size()),
      I(model.links.size() + model.CountCuts()),
      f(model.links.size() + model.CountCuts()),
      axes(model.velocities),
      local_axes(model.CountCuts() > 0 ? model.velocities : 0),
      generalised(model.velocities, S(0.0)),
      W(model.rows),
      residual(model.rows, S(0.0)),
      bias(model.rows, S(0.0)),
      k(model.pattern.size(), S(0.0)),
      x(model.pattern.unknowns(), S(0.0)),
      kept_k(k),
      active(model.rows, S(1.0)) {
  for (int r = 0; r < model.rows; ++r) {
    if (model.redundant[r] || model.switching[r]) active[r] = S(0.0);
  }
}

}  // namespace kingpin::mechanism
