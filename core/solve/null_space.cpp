#include "core/solve/null_space.h"

#include <algorithm>
#include <vector>

#include "core/mechanism/dynamics.h"
#include "core/mechanism/project.h"

namespace kingpin::solve {

namespace {

using mechanism::Model;

// Beside the sizes of what it is the sum of, a gradient is rounding below the first; a row that
// follows from others to the second holds nothing.
constexpr double kRounding = 1e-12;
constexpr double kDependent = 1e-9;

std::vector<int> ListHoldingRows(const Model& model, Rows rows) {
  // Where rates are constrained, too, a row may be redundant beside one of these: among the
  // holonomic rows alone it is not.
  const bool all_holonomic = std::all_of(model.holonomic.begin(), model.holonomic.end(),
                                         [](char holonomic) { return holonomic != 0; });
  std::vector<int> list;
  for (int r = 0; r < model.rows; ++r) {
    if (model.switching[r] || (rows == Rows::kHolonomic && !model.holonomic[r])) continue;
    if (model.redundant[r] && (rows == Rows::kAll || all_holonomic)) continue;
    list.push_back(r);
  }
  return list;
}

// D of the rows, one column each. An axis turned there and back by 90 degrees leaves 6e-17 of a
// gradient that is none, and is taken as zero.
Eigen::MatrixXd CalcGradients(const Model& model, std::span<const double> q,
                              const std::vector<int>& rows) {
  mechanism::Workspace<double> w(model);
  const std::vector<double> rest(model.velocities, 0.0);
  UpdatePositions(model, q.data(), w);
  UpdateVelocities(model, rest.data(), w);
  UpdateClosures(model, w);
  std::vector<int> column(model.rows, -1);
  for (size_t k = 0; k < rows.size(); ++k) column[rows[k]] = static_cast<int>(k);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(model.velocities, static_cast<int>(rows.size()));
  for (int r : rows) {
    for (int s = model.support_begin[r]; s < model.support_begin[r + 1]; ++s) {
      const Model::Support& support = model.supports[s];
      const mechanism::Motion<double>& axis = w.axes[support.dof];
      const double gradient = Dot(axis, w.W[r]);
      const double size =
          CalcNorm(axis.w) * CalcNorm(w.W[r].t) + CalcNorm(axis.v) * CalcNorm(w.W[r].f);
      if (std::abs(gradient) > kRounding * size)
        D(support.dof, column[r]) = support.sign * gradient;
    }
  }
  for (const mechanism::LinearRow& row : model.linear) {
    if (column[row.row] < 0) continue;
    for (const auto& term : row.terms) D(term.v, column[row.row]) += term.factor;
  }
  return D;
}

Eigen::LLT<Eigen::MatrixXd> FactoriseMass(const Model& model, std::span<const double> q) {
  const int nv = model.velocities;
  return Eigen::LLT<Eigen::MatrixXd>(mechanism::CalcEquationMatrix(model, q).topLeftCorner(nv, nv));
}

}  // namespace

// With M = L Lᵀ and y = Lᵀ δq the metric is the plain one, and the rows ask for (L⁻¹ D)ᵀ y = 0.
NullSpace CalcNullSpace(const Model& model, std::span<const double> q, Rows rows) {
  const int nv = model.velocities;
  NullSpace space;
  if (nv == 0) return space;
  const std::vector<int> holding = ListHoldingRows(model, rows);
  const Eigen::LLT<Eigen::MatrixXd> mass = FactoriseMass(model, q);
  Eigen::MatrixXd Z = Eigen::MatrixXd::Identity(nv, nv);
  if (!holding.empty()) {
    Eigen::MatrixXd D = CalcGradients(model, q, holding);
    mass.matrixL().solveInPlace(D);
    for (int k = 0; k < D.cols(); ++k) {
      if (const double norm = D.col(k).norm(); norm > 0) D.col(k) /= norm;
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(D);
    qr.setThreshold(kDependent);
    const int freedoms = nv - static_cast<int>(qr.rank());
    Z = freedoms > 0 ? Eigen::MatrixXd(qr.householderQ() * Z.rightCols(freedoms))
                     : Eigen::MatrixXd(nv, 0);
  }
  if (Z.cols() == 0) {
    space.basis.resize(nv, 0);
    space.inverse.resize(0, nv);
    return space;
  }
  space.basis = mass.matrixU().solve(Z);
  space.inverse = Z.transpose() * Eigen::MatrixXd(mass.matrixU());
  return space;
}

// Of (L⁻¹ D)ᵀ y = rates the y of least norm.
Eigen::MatrixXd CalcLeastMotion(const Model& model, std::span<const double> q,
                                const Eigen::MatrixXd& rates) {
  const int nv = model.velocities, columns = static_cast<int>(rates.cols());
  const std::vector<int> holding = ListHoldingRows(model, Rows::kAll);
  if (nv == 0 || columns == 0 || holding.empty()) return Eigen::MatrixXd::Zero(nv, columns);
  const Eigen::LLT<Eigen::MatrixXd> mass = FactoriseMass(model, q);
  Eigen::MatrixXd D = CalcGradients(model, q, holding);
  mass.matrixL().solveInPlace(D);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kDependent);
  decomposition.compute(D.transpose());
  const Eigen::MatrixXd wanted = rates(holding, Eigen::all);
  const Eigen::MatrixXd y = decomposition.solve(wanted);
  return mass.matrixU().solve(y);
}

}  // namespace kingpin::solve
