#include "core/mechanism/accelerations.h"

#include <Eigen/Dense>
#include <algorithm>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "core/mechanism/entries.h"

namespace kingpin::mechanism {

namespace {

// The equations read back from the factor's storage before the factorisation, as dense matrices.
Eigen::MatrixXd ExpandMatrix(const Model& model, const Workspace<double>& w) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(model.unknowns(), model.unknowns());
  for (const auto& [i, j] : ListEntries(model)) {
    K(i, j) = K(j, i) = w.k[model.pattern.GetSlot(i, j)];
  }
  return K;
}

// At a singular position rows depend on each other. Accelerations are unique as long as the mass
// matrix is regular; among the reactions that give them, the smallest are taken. Rows that are out
// stay out: they only cost time.
void SolveSingular(const Model& model, const Eigen::MatrixXd& K, const Eigen::VectorXd& right,
                   std::span<const double> active, std::span<double> acceleration,
                   std::span<double> reaction) {
  const int nv = model.coordinates, all = model.unknowns() - nv;  // rows of cuts come last
  std::vector<int> rows;
  for (int r = 0; r < all; ++r) {
    if (r >= model.rows || active[r] != 0) rows.push_back(r);
  }
  const int count = static_cast<int>(rows.size());
  Eigen::MatrixXd B(nv, count);
  Eigen::VectorXd c(count);
  for (int k = 0; k < count; ++k) {
    B.col(k) = K.col(nv + rows[k]).head(nv);
    c[k] = right[nv + rows[k]];
  }
  // with M = L Lᵀ and B = L⁻¹D:  y = Lᵀ q̈ meets Bᵀ y = c nearest to L⁻¹F
  const Eigen::LLT<Eigen::MatrixXd> mass(K.topLeftCorner(nv, nv));
  mass.matrixL().solveInPlace(B);
  const Eigen::VectorXd free = mass.matrixL().solve(right.head(nv));
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(B.transpose());
  const Eigen::VectorXd correction = decomposition.solve(c - B.transpose() * free);
  const Eigen::VectorXd y = free + correction;
  const Eigen::VectorXd miss = B.transpose() * y - c;
  if (!(miss.norm() <= 1e-6 * (c.norm() + (B.transpose() * free).norm()) + 1e-300)) {
    int worst = 0;
    miss.cwiseAbs().maxCoeff(&worst);
    if (rows[worst] < model.rows) {
      throw std::runtime_error(fmt::format(
          "the constraints contradict each other in this position: row '{}' cannot be met",
          model.row_names[rows[worst]]));
    }
    throw std::runtime_error("the constraints contradict each other in this position");
  }
  const Eigen::VectorXd a = mass.matrixU().solve(y);
  std::copy(a.data(), a.data() + model.velocities, acceleration.begin());
  // M q̈ - D R = F:  B R = y - L⁻¹F
  const Eigen::VectorXd R = decomposition.transpose().solve(correction);
  std::fill(reaction.begin(), reaction.end(), 0.0);
  for (int k = 0; k < count; ++k) {
    if (rows[k] < model.rows) reaction[rows[k]] = R[k];
  }
}

}  // namespace

void FactoriseAndSolve(const Model& model, Workspace<double>& w, std::span<double> acceleration,
                       std::span<double> reaction) {
  w.kept_k = w.k;
  w.singular = false;
  model.pattern.Factorise(w.k.data());
  if (!PivotsAreSafe(model, w)) {
    Eigen::VectorXd right(model.unknowns());
    for (int i = 0; i < model.unknowns(); ++i) {
      right[i] = w.kept_k[model.pattern.GetRightSideSlot(i)];
    }
    w.k = w.kept_k;
    w.singular = true;
    const Eigen::MatrixXd K = ExpandMatrix(model, w);
    if (!K.allFinite() || !right.allFinite()) {
      throw std::runtime_error(
          "the equations of motion hold a number that is not finite: positions, velocities or "
          "forces have run away; smaller steps or less stiff forces may help");
    }
    SolveSingular(model, K, right, w.active, acceleration, reaction);
    return;
  }
  model.pattern.BackSubstitute(w.k.data(), w.x.data());
  for (int i = 0; i < model.velocities; ++i) acceleration[i] = w.x[model.pattern.position(i)];
  for (int r = 0; r < model.rows; ++r) {
    reaction[r] = -w.x[model.pattern.position(model.coordinates + r)];
  }
}

void SolveAccelerations(const Model& model, std::span<const double> drive_acceleration,
                        Workspace<double>& w, std::span<double> acceleration,
                        std::span<double> reaction) {
  AssembleEquations(model, drive_acceleration.data(), w);
  FactoriseAndSolve(model, w, acceleration, reaction);
}

}  // namespace kingpin::mechanism
