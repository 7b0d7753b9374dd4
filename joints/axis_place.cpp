#include "joints/axis_place.h"

#include <cmath>
#include <numbers>

#include "core/mechanism/kinematics.h"

namespace kingpin::joints {

namespace {

using mechanism::JointKind;
using mechanism::Link;
using mechanism::Model;

constexpr double kParallel = 1e-9;  // sine of the angle between axes [rad]

// The links from `link` to the world.
std::vector<int> ListPath(const Model& model, int link) {
  std::vector<int> path;
  for (; link != 0; link = model.links[link].parent) path.push_back(link);
  return path;
}

// Adds the turn of each link in `path` to `turns`; false if one turns about another axis than n.
bool AddTurns(const Model& model, const mechanism::Workspace<double>& w,
              const std::vector<int>& path, const Vector3<double>& n, double sign,
              std::vector<AxisPlace::Turn>& turns) {
  for (int l : path) {
    const Link& link = model.links[l];
    if (link.kind == JointKind::kPrismatic) continue;
    if (link.kind != JointKind::kRevolute && link.kind != JointKind::kScrew) return false;
    const Vector3<double>& axis = w.R[l].z;
    if (CalcNorm(Cross(axis, n)) > kParallel) return false;
    turns.push_back({link.q, Dot(axis, n) > 0 ? sign : -sign});
  }
  return true;
}

}  // namespace

AxisPlace MakeAxisPlace(const Mechanism& mechanism, const AboutAxis& axis) {
  const Model& model = mechanism.system.model;
  AxisPlace place;
  place.a = mechanism.MakeFrame(axis.a);
  place.b = mechanism.MakeFrame(axis.b);
  mechanism::Workspace<double> w(model);
  const std::vector<double> rest(model.velocities, 0.0);
  UpdatePositions(model, mechanism.start.data(), w);
  UpdateVelocities(model, rest.data(), w);
  const Vector3<double> n = w.R[place.a.link] * place.a.X_LF.R.z;
  const Vector3<double> m = w.R[place.b.link] * place.b.X_LF.R.z;
  if (Dot(n, m) < 0 || CalcNorm(Cross(n, m)) > kParallel) return place;
  std::vector<int> from_a = ListPath(model, place.a.link), from_b = ListPath(model, place.b.link);
  while (!from_a.empty() && !from_b.empty() && from_a.back() == from_b.back()) {
    from_a.pop_back();
    from_b.pop_back();
  }
  std::vector<AxisPlace::Turn> turns;
  if (!AddTurns(model, w, from_a, n, -1, turns) || !AddTurns(model, w, from_b, n, 1, turns)) {
    return place;
  }
  double sum = 0;
  for (const AxisPlace::Turn& turn : turns) sum += turn.sign * mechanism.start[turn.q];
  const double angle = place
                           .Calc(mechanism::ForceContext<double>{model, 0.0, mechanism.start.data(),
                                                                 rest.data(), nullptr, nullptr, w})
                           .x;
  place.turns = std::move(turns);
  place.offset = std::remainder(angle - sum, 2 * std::numbers::pi);
  return place;
}

}  // namespace kingpin::joints
