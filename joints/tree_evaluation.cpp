#include "joints/tree_evaluation.h"

#include <algorithm>
#include <stdexcept>

#include "core/mechanism/accelerations.h"
#include "core/mechanism/inverse_dynamics.h"
#include "core/mechanism/project.h"
#include "core/mechanism/system.h"

namespace kingpin::joints {

namespace {

using mechanism::Model;
using mechanism::Workspace;

void SetEnergy(const Model& model, const Workspace<double>& w, TreeEvaluation& result) {
  Vector3<double> moment;  // about the reference point
  for (size_t l = 1; l < model.links.size(); ++l) {
    const mechanism::Link& link = model.links[l];
    if (link.mass == 0) continue;
    const auto I = math::MakeInertia(link.mass, link.centre, link.central_inertia, w.R[l], w.p[l]);
    result.kinetic += 0.5 * Dot(w.V[l], I * w.V[l]);
    moment += I.h;
    result.mass += link.mass;
  }
  if (result.mass > 0) result.centre = w.reference + (1 / result.mass) * moment;
  result.potential = -result.mass * Dot(model.gravity, result.centre);
}

FrameMotion CalcFrameMotion(const Model& model, const Workspace<double>& w,
                            const mechanism::Frame& frame) {
  const int l = frame.link;
  FrameMotion motion;
  const Vector3<double> p = w.R[l] * frame.X_LF.p + w.p[l];  // from the reference point
  motion.X_WF = {w.R[l] * frame.X_LF.R, l == 0 ? frame.X_LF.p : w.reference + p};
  motion.v = w.V[l].At(p);
  motion.w = w.V[l].w;
  motion.alpha = w.A[l].w;
  // the acceleration field of the link, then what its point has on top for moving through it
  const math::Motion<double> A{w.A[l].w, w.A[l].v + model.gravity};
  motion.acc = A.At(p) + Cross(motion.w, motion.v);
  return motion;
}

}  // namespace

TreeEvaluation CalcTreeEvaluation(const Mechanism& mechanism, std::span<const double> q,
                                  std::span<const double> v, std::span<const double> force,
                                  std::span<const double> acceleration,
                                  std::span<const mechanism::Frame> frames) {
  const Model& model = mechanism.system.model;
  if (model.rows > 0) throw std::invalid_argument("a tree evaluation of a mechanism with closures");
  const int n = model.velocities;
  Workspace<double> w(model);
  TreeEvaluation result;
  result.bias.resize(n);
  result.qdd.resize(n);
  result.tau.resize(n);

  mechanism::UpdatePositions(model, q.data(), w);
  mechanism::UpdateVelocities(model, v.data(), w);
  SetEnergy(model, w, result);

  result.M = mechanism::CalcEquationMatrix(model, q);
  const std::vector<double> still(n, 0.0);
  mechanism::ClearForces(w);
  mechanism::CalcInverseDynamics(model, still.data(), w, result.bias.data());

  mechanism::UpdateVelocities(model, v.data(), w);
  mechanism::ClearForces(w);
  std::copy(force.begin(), force.end(), w.generalised.begin());
  mechanism::SolveAccelerations(model, {}, w, {result.qdd.data(), static_cast<size_t>(n)}, {});

  mechanism::ClearForces(w);
  mechanism::CalcInverseDynamics(model, acceleration.data(), w, result.tau.data());
  for (const mechanism::Frame& frame : frames) {
    result.frames.push_back(CalcFrameMotion(model, w, frame));
  }
  return result;
}

}  // namespace kingpin::joints
