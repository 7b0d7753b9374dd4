#pragma once

#include <Eigen/Dense>
#include <vector>

#include "core/mechanism/workspace.h"

namespace kingpin::mechanism {

/// What a row of gradient one at least has of it, squared: less is rounding of a gradient that
/// vanishes.
constexpr double kNoGradient = 1e-20;

/// Rows that share no coordinate with rows of other groups, and their coordinates, both ascending.
struct RowGroup {
  std::vector<int> rows, coordinates;
};
std::vector<RowGroup> GroupRows(const Model& model);

/// The rows of Dᵀ of each group: (row, coordinate) in the group's order. Needs UpdatePositions and
/// UpdateClosures.
std::vector<Eigen::MatrixXd> CalcGroupGradients(const Model& model,
                                                const std::vector<RowGroup>& groups,
                                                const Workspace<double>& w);

/// Calls `add(coordinate, row, value)` for the gradients of the rows.
template <class Add>
void VisitGradients(const Model& model, const Workspace<double>& w, const Add& add) {
  for (int r = 0; r < model.rows; ++r) {
    for (int s = model.support_begin[r]; s < model.support_begin[r + 1]; ++s) {
      const Model::Support& support = model.supports[s];
      add(support.dof, r, support.sign * Dot(w.axes[support.dof], w.W[r]));
    }
  }
  for (const LinearRow& row : model.linear) {
    for (const LinearRow::Term& term : row.terms) add(term.v, row.row, term.factor);
  }
}

/// Marks rows that depend on others of their group in every sample: one state in which a row stands
/// for itself is enough to keep it. Of a dependent set, the rows that stand out most are kept, and
/// rows that come and go (`switching`) only if no other can stand in.
///
/// @param samples per sample, the gradients of the groups, in units that bring the coordinates'
/// inertias near one and the rows' gradients to unit length
/// @param redundant out: per row of the model
void FindRedundantRows(const std::vector<RowGroup>& groups,
                       const std::vector<std::vector<Eigen::MatrixXd>>& samples,
                       const std::vector<char>& switching, std::vector<char>& redundant);

}  // namespace kingpin::mechanism
