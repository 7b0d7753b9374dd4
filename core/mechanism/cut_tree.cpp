#include "core/mechanism/cut_tree.h"

#include <Eigen/Dense>
#include <algorithm>

namespace kingpin::mechanism {

namespace {

// Both halves of the link must have inertia in every direction.
bool IsFitToCut(const Link& link) {
  if (!(link.mass > 0)) return false;
  const double* J = link.central_inertia;
  Eigen::Matrix3d tensor;
  tensor << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
  return moments[0] > 1e-3 * moments[2] && moments[2] > 0;
}

// Calls `visit(a, b, row, count)` for every closure between links.
template <class Visit>
void VisitClosures(const Model& model, const Visit& visit) {
  for (const PointClosure& c : model.points) visit(c.a, c.b, c.row, __builtin_popcount(c.axes));
  for (const PerpendicularClosure& c : model.perpendiculars) visit(c.a, c.b, c.row, 1);
  for (const DistanceClosure& c : model.distances) visit(c.a, c.b, c.row, 1);
  for (const RollingDisc& c : model.discs) visit(c.a, c.b, c.row, 3);
}

// Links that a loop passes through, without its two ends and their common ancestor.
std::vector<char> FindLinksInLoops(const Model& model) {
  std::vector<char> inside(model.links.size(), 0);
  VisitClosures(model, [&](int a, int b, int, int) {
    int ancestor = a, other = b;  // of two links in depth-first order the later one steps back
    while (ancestor != other) {
      if (ancestor < other) std::swap(ancestor, other);
      ancestor = model.links[ancestor].parent;
    }
    for (int l = a; l != ancestor; l = model.links[l].parent) inside[l] |= l != a;
    for (int l = b; l != ancestor; l = model.links[l].parent) inside[l] |= l != b;
  });
  return inside;
}

// The coordinates that the rows of closures act on. Two ends in one segment: those between them.
// Otherwise those of either end as far as its segment reaches, and those of the segment's cut.
void SetRowTerms(Model& model) {
  std::vector<std::vector<Model::RowTerm>> terms(model.rows);
  model.cut_terms.clear();
  VisitClosures(model, [&](int a, int b, int row, int count) {
    const auto meets = [&](int l, int m) {
      return model.segment[l] == model.segment[m] ||
             (model.starts_segment[l] != 0 && model.starts_segment[l] == model.segment[m]);
    };
    const bool together = meets(a, b) || meets(b, a);
    for (int r = row; r < row + count; ++r) {
      for (int s = model.support_begin[r]; together && s < model.support_begin[r + 1]; ++s) {
        terms[r].push_back({model.supports[s].dof, model.supports[s].sign, 0});
      }
      for (const auto& [link, sign] : {std::pair{a, 1}, std::pair{b, -1}}) {
        if (together || link == 0) continue;
        int dof = model.links[link].v + CountVelocities(model.links[link].kind) - 1;
        for (; dof >= 0; dof = model.segment_parent[dof]) terms[r].push_back({dof, sign, 0});
        const int segment = model.segment[link];
        if (segment != 0) model.cut_terms.push_back({r, segment, sign, {}});
      }
    }
  });
  model.row_terms.clear();
  model.row_term_begin.assign(1, 0);
  for (const auto& row : terms) {
    model.row_terms.insert(model.row_terms.end(), row.begin(), row.end());
    model.row_term_begin.push_back(static_cast<int>(model.row_terms.size()));
  }
}

// Everything that follows from Model::segments and Model::starts_segment.
void SetSegments(Model& model) {
  const int links = static_cast<int>(model.links.size());
  model.segment.assign(links, 0);
  model.carrier.assign(links, 0);
  model.segment_parent.assign(model.velocities, -1);
  for (int l = 1; l < links; ++l) {
    const int parent = model.links[l].parent, cut = model.starts_segment[parent];
    model.segment[l] = cut != 0 ? cut : model.segment[parent];
    model.carrier[l] = cut != 0 ? links + cut - 1 : parent;
    if (model.starts_segment[l] != 0) {
      model.segments[model.starts_segment[l]].parent = model.segment[l];
    }
    const int first = model.links[l].v;
    model.segment_parent[first] = cut != 0 ? -1 : model.dof_parent[first];
    for (int i = 1; i < CountVelocities(model.links[l].kind); ++i) {
      model.segment_parent[first + i] = first + i - 1;
    }
  }
  model.coordinates = model.velocities + 6 * model.CountCuts();
  SetRowTerms(model);
}

}  // namespace

void SetWholeTree(Model& model) {
  model.segments.assign(1, {});
  model.starts_segment.assign(model.links.size(), 0);
  SetSegments(model);
}

void CutTree(Model& model, const CutRule& rule) {
  SetWholeTree(model);
  const int links = static_cast<int>(model.links.size());
  // coordinates from here to the deepest leaf, without the link's own
  std::vector<int> below(links, 0);
  for (int l = links - 1; l > 0; --l) {
    const Link& link = model.links[l];
    below[link.parent] = std::max(below[link.parent], below[l] + CountVelocities(link.kind));
  }
  if (below[0] <= rule.depth) return;
  const std::vector<char> inside = FindLinksInLoops(model);
  std::vector<int> length(links, 0);  // coordinates of the segment up to the link
  for (int l = 1; l < links; ++l) {
    const Link& link = model.links[l];
    const int before = model.starts_segment[link.parent] != 0 ? 0 : length[link.parent];
    length[l] = before + CountVelocities(link.kind);
    const int needed = inside[l] ? 2 * rule.length : rule.length;
    if (length[l] < needed || below[l] < rule.length || !IsFitToCut(link)) continue;
    model.starts_segment[l] = static_cast<int>(model.segments.size());
    model.segments.push_back({l, 0});
  }
  SetSegments(model);
}

}  // namespace kingpin::mechanism
