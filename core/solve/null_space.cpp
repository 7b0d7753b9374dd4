#include "core/solve/null_space.h"

#include "core/mechanism/project.h"

namespace kingpin::solve {

Eigen::MatrixXd CalcNullSpace(const mechanism::Model& model, std::span<const double> q, Rows rows) {
  const int nv = model.velocities;
  Eigen::MatrixXd D = mechanism::CalcEquationMatrix(model, q).topRightCorner(nv, model.rows);
  for (int r = 0; r < model.rows; ++r) {
    if (model.switching[r] || (rows == Rows::kHolonomic && !model.holonomic[r])) D.col(r).setZero();
  }
  if (model.rows == 0) return Eigen::MatrixXd::Identity(nv, nv);
  for (int r = 0; r < model.rows; ++r) {
    if (const double norm = D.col(r).norm(); norm > 0) D.col(r) /= norm;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(D);
  qr.setThreshold(1e-9);
  const Eigen::MatrixXd tail = Eigen::MatrixXd::Identity(nv, nv).rightCols(nv - qr.rank());
  return qr.householderQ() * tail;
}

}  // namespace kingpin::solve
