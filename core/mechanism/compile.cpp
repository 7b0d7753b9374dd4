#include "core/mechanism/compile.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

#include "core/mechanism/dynamics.h"
#include "core/mechanism/elimination_order.h"
#include "core/mechanism/entries.h"
#include "core/mechanism/project.h"
#include "core/mechanism/row_groups.h"

namespace kingpin::mechanism {

namespace {

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
  for (int dof : from_a) support.push_back({dof, 1});
  for (int dof : from_b) support.push_back({dof, -1});
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

// The coordinates in groups that M does not couple, the last of the tree first within a group.
std::vector<std::vector<int>> GroupCoordinates(const Model& model) {
  std::vector<std::vector<int>> groups;
  std::vector<int> group(model.velocities, -1);
  std::vector<int> of_segment(model.segments.size(), -1);
  for (int i = 0; i < model.velocities; ++i) {
    const int segment = model.segment[model.dof_link[i]], before = model.segment_parent[i];
    int& own = group[i];
    own = before >= 0 ? group[before] : segment != 0 ? of_segment[segment] : -1;
    if (own < 0) {
      own = static_cast<int>(groups.size());
      groups.emplace_back();
      if (segment != 0) of_segment[segment] = own;
    }
    groups[own].push_back(i);
  }
  for (std::vector<int>& members : groups) std::reverse(members.begin(), members.end());
  for (int s = 1; s <= model.CountCuts(); ++s) {
    for (int c = 5; c >= 0; --c) groups[of_segment[s]].push_back(model.GetCutCoordinate(s) + c);
  }
  return groups;
}

Eigen::MatrixXd GetMassBlock(const Model& model, const std::vector<int>& group,
                             const Workspace<double>& w) {
  const int n = static_cast<int>(group.size());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const int slot = model.pattern.GetSlot(group[i], group[j]);
      if (slot >= 0) M(i, j) = M(j, i) = w.k[slot];
    }
  }
  return M;
}

// Every motion of the tree must move something that has inertia.
void CheckMass(const Model& model, const std::vector<int>& group, Eigen::MatrixXd M) {
  const Eigen::VectorXd whole = M.diagonal();
  const int n = static_cast<int>(group.size());
  // leaves first, as the elimination goes: the pivot of a coordinate is the inertia that is left to
  // it when the links it carries may move freely
  for (int k = 0; k < n && group[k] < model.velocities; ++k) {
    const int i = group[k], rest = n - k - 1;
    if (!(M(k, k) > 1e-12 * whole[k]) || !(whole[k] > 0)) {
      throw std::invalid_argument(fmt::format(
          "nothing that link '{}' carries has inertia along its coordinate {}",
          model.links[model.dof_link[i]].name, i - model.links[model.dof_link[i]].v + 1));
    }
    M.bottomRightCorner(rest, rest) -= M.col(k).tail(rest) * M.row(k).tail(rest) / M(k, k);
  }
}

using Entries = std::vector<std::pair<int, int>>;

// Units for each unknown in which the matrix has entries near one: coordinates to unit inertia,
// rows to a gradient of unit length in these units. A gradient that is rounding beside the largest
// (an axis turned by 90 degrees leaves 6e-17 of it) counts as none: scaled up it would pass for a
// row that holds something.
std::vector<double> CalcScale(const Model& model, const Entries& entries,
                              const Workspace<double>& w) {
  std::vector<double> scale(model.unknowns(), 0.0);
  for (int i = 0; i < model.coordinates; ++i) scale[i] = 1 / std::sqrt(w.k[i]);
  for (const auto& [row, coordinate] : entries) {
    if (row < model.coordinates) continue;
    const double x = w.k[model.pattern.GetSlot(row, coordinate)] * scale[coordinate];
    scale[row] += x * x;
  }
  double largest = 0;
  for (int r = model.coordinates; r < model.unknowns(); ++r) {
    scale[r] = std::sqrt(scale[r]);
    largest = std::max(largest, scale[r]);
  }
  for (int r = model.coordinates; r < model.unknowns(); ++r) {
    const double norm = scale[r] > 1e-13 * largest ? scale[r] : largest;
    scale[r] = norm > 0 ? 1 / norm : 1.0;
  }
  return scale;
}

// The largest pivots that rows can have: the diagonal of Dᵀ M⁻¹ D.
std::vector<double> CalcLargestPivots(const Model& model,
                                      const std::vector<std::vector<int>>& groups,
                                      const Entries& entries, const std::vector<double>& scale,
                                      const Workspace<double>& w) {
  std::vector<int> group_of(model.coordinates, 0), place(model.coordinates, 0);
  for (size_t g = 0; g < groups.size(); ++g) {
    for (size_t k = 0; k < groups[g].size(); ++k) {
      group_of[groups[g][k]] = static_cast<int>(g);
      place[groups[g][k]] = static_cast<int>(k);
    }
  }
  // the parts of the rows in each group: (row, place) -> gradient
  std::vector<std::map<int, Eigen::VectorXd>> parts(groups.size());
  for (const auto& [row, coordinate] : entries) {
    if (row < model.coordinates) continue;
    Eigen::VectorXd& part = parts[group_of[coordinate]][row];
    if (part.size() == 0) part.setZero(static_cast<int>(groups[group_of[coordinate]].size()));
    part[place[coordinate]] = w.k[model.pattern.GetSlot(row, coordinate)] * scale[row];
  }
  std::vector<double> largest(model.unknowns(), 0.0);
  for (size_t g = 0; g < groups.size(); ++g) {
    if (parts[g].empty()) continue;
    const Eigen::LDLT<Eigen::MatrixXd> M(GetMassBlock(model, groups[g], w));
    for (const auto& [row, part] : parts[g]) largest[row] += part.dot(M.solve(part));
  }
  return largest;
}

}  // namespace

void CompileTopology(Model& model) {
  SetTree(model);
  SetSupports(model);
  SetWholeTree(model);
  model.redundant.assign(model.rows, 0);
  model.switching.resize(model.rows, 0);
}

void CompileElimination(Model& model, std::span<const double> q, const CutRule& rule) {
  CutTree(model, rule);
  model.redundant.assign(model.rows, 0);
  const Entries entries = ListEntries(model);
  const std::vector<std::vector<int>> groups = GroupCoordinates(model);
  const std::vector<RowGroup> row_groups = GroupRows(model);
  const int n = model.unknowns();
  model.pattern = math::SparseLdltPattern::MakeStorage(n, entries);
  model.pivot_limits.assign(n, 0);
  SetSlots(model);
  if (n == 0) return;  // everything is fixed to the world

  SampledMatrix samples;
  samples.coordinates = model.coordinates;
  samples.diagonal.resize(n);
  samples.largest_pivot.resize(n);
  std::vector<std::vector<Eigen::MatrixXd>> gradients;
  std::vector<double> scale;
  const std::vector<double> none(std::max(model.rows, model.velocities), 0.0);
  std::mt19937_64 random(20110129);
  std::normal_distribution<double> normal;
  Workspace<double> w(model);
  std::fill(w.active.begin(), w.active.end(), 1.0);
  for (const auto& [i, j] : entries) {
    if (i != j) samples.entries.push_back({i, j, {}});
  }
  for (int s = 0; s < kSamples; ++s) {
    std::vector<double> state(q.begin(), q.end());
    if (s > 0) {
      std::vector<double> direction(model.velocities);
      for (double& d : direction) d = 0.3 * normal(random);
      MoveOnConstraints(model, direction, state);
    }
    UpdatePositions(model, state.data(), w);
    UpdateVelocities(model, none.data(), w);
    UpdateClosures(model, w);
    std::fill(w.f.begin(), w.f.end(), Wrench<double>{});
    AssembleEquations(model, none.data(), w);
    if (s == 0) {
      for (const auto& group : groups) CheckMass(model, group, GetMassBlock(model, group, w));
      scale = CalcScale(model, entries, w);
    }
    for (int i = 0; i < n; ++i) samples.diagonal[i][s] = scale[i] * scale[i] * w.k[i];
    for (auto& [i, j, value] : samples.entries) {
      value[s] = scale[i] * scale[j] * w.k[model.pattern.GetSlot(i, j)];
    }
    const std::vector<double> largest = CalcLargestPivots(model, groups, entries, scale, w);
    for (int i = 0; i < n; ++i) samples.largest_pivot[i][s] = largest[i];
    gradients.push_back(CalcGroupGradients(model, row_groups, w));
    for (size_t g = 0; g < row_groups.size(); ++g) {
      if (row_groups[g].coordinates.empty()) continue;
      for (size_t k = 0; k < row_groups[g].coordinates.size(); ++k) {
        gradients[s][g].col(k) *= scale[row_groups[g].coordinates[k]];
      }
      for (size_t k = 0; k < row_groups[g].rows.size(); ++k) {
        gradients[s][g].row(k) *= scale[model.coordinates + row_groups[g].rows[k]];
      }
    }
  }
  FindRedundantRows(row_groups, gradients, model.switching, model.redundant);
  samples.last.assign(n, 0);
  for (int r = 0; r < model.rows; ++r) {
    samples.last[model.coordinates + r] =
        model.redundant[r] ? SampledMatrix::kOut : model.switching[r];
  }
  const EliminationOrder plan = ChooseEliminationOrder(samples);
  model.pattern = math::SparseLdltPattern(plan.order, ListEntries(model));
  for (int k = 0; k < n; ++k) {
    const int unknown = plan.order[k], row = unknown - model.coordinates;
    const bool of_row = row >= 0 && row < model.rows;
    model.pivot_limits[k] = plan.pivot_limits[k] / (scale[unknown] * scale[unknown]);
    // a row that is out has the pivot -1
    if (of_row && model.redundant[row]) model.pivot_limits[k] = -0.5;
    if (of_row && model.switching[row])
      model.pivot_limits[k] = std::max(model.pivot_limits[k], -0.5);
  }
  SetSlots(model);
}

}  // namespace kingpin::mechanism
