#include "core/mechanism/compile.h"

#include <algorithm>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

#include "core/mechanism/dynamics.h"
#include "core/mechanism/elimination_order.h"
#include "core/mechanism/project.h"

namespace kingpin::mechanism {

namespace {

constexpr int kSamples = 6;

// Coordinates on the way from a link to the world, the link's own last first.
void AppendPath(const Model& model, int link, std::vector<int>& path) {
  if (link == 0) return;
  int dof = model.links[link].v + CountVelocities(model.links[link].kind) - 1;
  for (; dof >= 0; dof = model.dof_parent[dof]) path.push_back(dof);
}

void SetSupport(const Model& model, int a, int b, std::vector<Model::Support>& support) {
  std::vector<int> from_a, from_b;
  AppendPath(model, a, from_a);
  AppendPath(model, b, from_b);
  while (!from_a.empty() && !from_b.empty() && from_a.back() == from_b.back()) {
    from_a.pop_back();
    from_b.pop_back();
  }
  for (int dof : from_a) support.push_back({dof, 1, 0});
  for (int dof : from_b) support.push_back({dof, -1, 0});
}

void SetTree(Model& model) {
  model.dof_link.assign(model.velocities, 0);
  model.dof_parent.assign(model.velocities, -1);
  model.reference_link = 0;
  for (int l = 1; l < static_cast<int>(model.links.size()); ++l) {
    const Link& link = model.links[l];
    int parent = -1;
    if (link.parent != 0) {
      const Link& before = model.links[link.parent];
      parent = before.v + CountVelocities(before.kind) - 1;
    }
    for (int i = 0; i < CountVelocities(link.kind); ++i) {
      model.dof_link[link.v + i] = l;
      model.dof_parent[link.v + i] = i == 0 ? parent : link.v + i - 1;
    }
    if (link.parent == 0 && link.kind == JointKind::kFree && model.reference_link == 0) {
      model.reference_link = l;
    }
  }
}

void SetSupports(Model& model) {
  std::vector<std::vector<Model::Support>> supports(model.rows);
  const auto set = [&](int a, int b, int first, int count) {
    SetSupport(model, a, b, supports[first]);
    for (int r = 1; r < count; ++r) supports[first + r] = supports[first];
  };
  for (const PointClosure& c : model.points) set(c.a, c.b, c.row, __builtin_popcount(c.axes));
  for (const PerpendicularClosure& c : model.perpendiculars) set(c.a, c.b, c.row, 1);
  for (const DistanceClosure& c : model.distances) set(c.a, c.b, c.row, 1);
  for (const RollingDisc& c : model.discs) set(c.a, c.b, c.row, 3);
  model.supports.clear();
  model.support_begin.assign(1, 0);
  for (const auto& row : supports) {
    model.supports.insert(model.supports.end(), row.begin(), row.end());
    model.support_begin.push_back(static_cast<int>(model.supports.size()));
  }
}

std::vector<std::pair<int, int>> ListEntries(const Model& model) {
  std::vector<std::pair<int, int>> entries;
  for (int i = 0; i < model.velocities; ++i) {
    for (int j = model.dof_parent[i]; j >= 0; j = model.dof_parent[j]) entries.emplace_back(i, j);
  }
  for (int r = 0; r < model.rows; ++r) {
    for (int s = model.support_begin[r]; s < model.support_begin[r + 1]; ++s) {
      entries.emplace_back(model.velocities + r, model.supports[s].dof);
    }
  }
  for (const LinearRow& row : model.linear) {
    for (const LinearRow::Term& term : row.terms) {
      entries.emplace_back(model.velocities + row.row, term.v);
    }
  }
  return entries;
}

void SetSlots(Model& model) {
  model.mass_slots.clear();
  model.mass_begin.assign(1, 0);
  for (int i = 0; i < model.velocities; ++i) {
    for (int j = i; j >= 0; j = model.dof_parent[j])
      model.mass_slots.push_back(model.pattern.GetSlot(i, j));
    model.mass_begin.push_back(static_cast<int>(model.mass_slots.size()));
  }
  for (int r = 0; r < model.rows; ++r) {
    for (int s = model.support_begin[r]; s < model.support_begin[r + 1]; ++s) {
      model.supports[s].slot = model.pattern.GetSlot(model.supports[s].dof, model.velocities + r);
    }
  }
  model.linear_slots.clear();
  for (const LinearRow& row : model.linear) {
    for (const LinearRow::Term& term : row.terms) {
      model.linear_slots.push_back(model.pattern.GetSlot(term.v, model.velocities + row.row));
    }
  }
}

// Every motion of the tree must move something that has inertia.
void CheckMass(const Model& model, const Eigen::MatrixXd& K) {
  const int nv = model.velocities;
  Eigen::MatrixXd M = K.topLeftCorner(nv, nv);
  // leaves first, as the elimination goes: the pivot of a coordinate is the inertia that is left to
  // it when the links it carries may move freely
  for (int i = nv - 1; i >= 0; --i) {
    if (!(M(i, i) > 1e-12 * K(i, i)) || !(K(i, i) > 0)) {
      throw std::invalid_argument(fmt::format(
          "nothing that link '{}' carries has inertia along its coordinate {}",
          model.links[model.dof_link[i]].name, i - model.links[model.dof_link[i]].v + 1));
    }
    M.topLeftCorner(i, i) -= M.col(i).head(i) * M.row(i).head(i) / M(i, i);
  }
}

// Units for each unknown in which the matrix has entries near one: coordinates to unit inertia,
// rows to a gradient of unit length in these units. A gradient that is rounding beside the largest
// (an axis turned by 90 degrees leaves 6e-17 of it) counts as none: scaled up it would pass for a
// row that holds something.
Eigen::VectorXd CalcScale(const Model& model, const Eigen::MatrixXd& K) {
  const int nv = model.velocities;
  Eigen::VectorXd scale(K.rows());
  scale.head(nv) = K.diagonal().head(nv).cwiseSqrt().cwiseInverse();
  double largest = 0;
  for (int r = nv; r < K.rows(); ++r) {
    scale[r] = K.col(r).head(nv).cwiseProduct(scale.head(nv)).norm();
    largest = std::max(largest, scale[r]);
  }
  for (int r = nv; r < K.rows(); ++r) {
    const double norm = scale[r] > 1e-13 * largest ? scale[r] : largest;
    scale[r] = norm > 0 ? 1.0 / norm : 1.0;
  }
  return scale;
}

}  // namespace

void CompileTopology(Model& model) {
  SetTree(model);
  SetSupports(model);
  model.redundant.assign(model.rows, 0);
  model.switching.resize(model.rows, 0);
}

void CompileElimination(Model& model, std::span<const double> q) {
  const std::vector<std::pair<int, int>> entries = ListEntries(model);
  const int n = model.velocities + model.rows;
  model.redundant.assign(model.rows, 0);

  // A first plan in the given order, whose storage only serves to read the samples.
  std::vector<int> order(n);
  for (int k = 0; k < n; ++k) order[k] = k;
  model.pattern = math::SparseLdltPattern(order, entries);
  model.pivot_limits.assign(n, 0);
  SetSlots(model);
  if (n == 0) return;  // everything is fixed to the world

  std::vector<Eigen::MatrixXd> samples;
  Eigen::VectorXd scale;
  std::mt19937_64 random(20110129);
  std::normal_distribution<double> normal;
  for (int s = 0; s < kSamples; ++s) {
    std::vector<double> state(q.begin(), q.end());
    if (s > 0) {
      std::vector<double> direction(model.velocities);
      for (double& d : direction) d = 0.3 * normal(random);
      MoveOnConstraints(model, direction, state);
    }
    Eigen::MatrixXd K = CalcEquationMatrix(model, state);
    if (s == 0) CheckMass(model, K);
    if (s == 0) scale = CalcScale(model, K);
    samples.push_back(scale.asDiagonal() * K * scale.asDiagonal());
  }
  EliminationOrder plan =
      ChooseEliminationOrder(model.velocities, samples, model.switching, entries);
  model.pattern = math::SparseLdltPattern(plan.order, entries);
  model.redundant = std::move(plan.redundant);
  for (int k = 0; k < n; ++k) {
    const int unknown = plan.order[k];
    const bool out = unknown >= model.velocities && model.redundant[unknown - model.velocities];
    model.pivot_limits[k] = out ? -0.5 : plan.pivot_limits[k] / (scale[unknown] * scale[unknown]);
  }
  SetSlots(model);
}

}  // namespace kingpin::mechanism
