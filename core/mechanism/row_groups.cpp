#include "core/mechanism/row_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kingpin::mechanism {

namespace {

// Of the square of a row's gradient: what is left of a dependent row is rounding.
constexpr double kDependent = 1e-9;

}  // namespace

std::vector<RowGroup> GroupRows(const Model& model) {
  const int nv = model.velocities;
  // sets of coordinates and rows that are joined, each with one of its members as its name
  std::vector<int> above(nv + model.rows);
  for (size_t k = 0; k < above.size(); ++k) above[k] = static_cast<int>(k);
  const auto find = [&](int k) {
    while (above[k] != k) k = above[k] = above[above[k]];
    return k;
  };
  for (int r = 0; r < model.rows; ++r) {
    for (int s = model.support_begin[r]; s < model.support_begin[r + 1]; ++s) {
      above[find(model.supports[s].dof)] = find(nv + r);
    }
  }
  for (const LinearRow& row : model.linear) {
    for (const LinearRow::Term& term : row.terms) above[find(term.v)] = find(nv + row.row);
  }
  std::vector<RowGroup> groups;
  std::vector<int> number(above.size(), -1);
  for (int r = 0; r < model.rows; ++r) {
    int& group = number[find(nv + r)];
    if (group < 0) {
      group = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[group].rows.push_back(r);
  }
  for (int i = 0; i < nv; ++i) {
    if (const int group = number[find(i)]; group >= 0) groups[group].coordinates.push_back(i);
  }
  return groups;
}

std::vector<Eigen::MatrixXd> CalcGroupGradients(const Model& model,
                                                const std::vector<RowGroup>& groups,
                                                const Workspace<double>& w) {
  std::vector<Eigen::MatrixXd> J;
  std::vector<int> group_of(model.rows, 0), place_of_row(model.rows, 0),
      place_of_coordinate(model.velocities, 0);
  for (size_t g = 0; g < groups.size(); ++g) {
    const auto& [rows, coordinates] = groups[g];
    J.push_back(
        Eigen::MatrixXd::Zero(static_cast<int>(rows.size()), static_cast<int>(coordinates.size())));
    for (size_t k = 0; k < rows.size(); ++k) {
      group_of[rows[k]] = static_cast<int>(g);
      place_of_row[rows[k]] = static_cast<int>(k);
    }
    for (size_t k = 0; k < coordinates.size(); ++k) {
      place_of_coordinate[coordinates[k]] = static_cast<int>(k);
    }
  }
  VisitGradients(model, w, [&](int i, int r, double value) {
    J[group_of[r]](place_of_row[r], place_of_coordinate[i]) += value;
  });
  return J;
}

void FindRedundantRows(const std::vector<RowGroup>& groups,
                       const std::vector<std::vector<Eigen::MatrixXd>>& samples,
                       const std::vector<char>& switching, std::vector<char>& redundant) {
  for (size_t g = 0; g < groups.size(); ++g) {
    const std::vector<int>& rows = groups[g].rows;
    const int count = static_cast<int>(rows.size());
    if (groups[g].coordinates.empty()) {  // between bodies that cannot move
      for (int r : rows) redundant[r] = 1;
      continue;
    }
    // Gram matrices of rows of unit length; what is left on the diagonal after an elimination is
    // the square of what the others cannot give.
    std::vector<Eigen::MatrixXd> left;
    for (const auto& sample : samples) {
      Eigen::MatrixXd J = sample[g];
      for (int r = 0; r < count; ++r) {
        const double square = J.row(r).squaredNorm();
        J.row(r) *= square > kNoGradient ? 1 / std::sqrt(square) : 0.0;
      }
      left.push_back(J * J.transpose());
    }
    std::vector<char> gone(count, 0);
    for (int step = 0; step < count; ++step) {
      int best = -1;
      double best_share = 0;
      for (int r = 0; r < count; ++r) {
        if (gone[r]) continue;
        double share = std::numeric_limits<double>::infinity();
        for (const Eigen::MatrixXd& G : left) share = std::min(share, G(r, r));
        const bool lasts = best >= 0 && !switching[rows[best]] && switching[rows[r]];
        const bool first = best >= 0 && switching[rows[best]] && !switching[rows[r]];
        if (best < 0 || first || (!lasts && share > 1.001 * best_share)) {
          best = r;
          best_share = share;
        }
      }
      gone[best] = 1;
      double most = 0;
      for (const Eigen::MatrixXd& G : left) most = std::max(most, G(best, best));
      if (most < kDependent) {
        redundant[rows[best]] = 1;
        continue;
      }
      if (switching[rows[best]]) continue;  // not there for others to depend on
      for (Eigen::MatrixXd& G : left) {
        if (!(G(best, best) > 1e-15)) continue;  // singular in this sample: others tell
        const Eigen::VectorXd column = G.col(best) / G(best, best);
        G -= column * G.row(best).eval();
      }
    }
  }
}

}  // namespace kingpin::mechanism
