#include "core/mechanism/project.h"

#include "core/mechanism/dynamics.h"
#include "core/mechanism/row_groups.h"

namespace kingpin::mechanism {

namespace {

using math::Quaternion;

Eigen::MatrixXd CalcGradients(const Model& model, const Workspace<double>& w) {
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(model.velocities, model.rows);
  VisitGradients(model, w, [&](int i, int r, double value) { D(i, r) += value; });
  return D;
}

// The x of least norm with Dᵀ x = right: redundant rows do no harm.
Eigen::VectorXd SolveGradients(const Model& model, const std::vector<RowGroup>& groups,
                               const Workspace<double>& w, const Eigen::VectorXd& right) {
  const std::vector<Eigen::MatrixXd> J = CalcGroupGradients(model, groups, w);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(model.velocities);
  for (size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].coordinates.empty()) continue;
    const Eigen::VectorXd b = right(groups[g].rows);
    // A dependent row is only as dependent as the position is exact: taken for an independent one
    // it would throw the mechanism off its constraints.
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
    decomposition.setThreshold(1e-8);
    decomposition.compute(J[g]);
    const Eigen::VectorXd part = decomposition.solve(b);
    x(groups[g].coordinates) = part;
  }
  return x;
}

void UpdateAtRest(const Model& model, std::span<const double> q, Workspace<double>& w) {
  const std::vector<double> rest(model.velocities, 0.0);
  UpdatePositions(model, q.data(), w);
  UpdateVelocities(model, rest.data(), w);
  UpdateClosures(model, w);
}

Eigen::VectorXd CollectResidual(const Model& model, std::span<const double> q,
                                std::span<const double> drive, const Workspace<double>& w) {
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(model.rows);
  for (int r = 0; r < model.rows; ++r) residual[r] = w.residual[r];
  for (const LinearRow& row : model.linear) {
    if (row.rate_only) continue;
    double sum = drive.empty() ? 0.0 : -drive[row.row];
    for (const LinearRow::Term& term : row.terms) sum += term.factor * q[term.q];
    residual[row.row] = sum;
  }
  return residual;
}

}  // namespace

void MovePositions(const Model& model, std::span<const double> v, std::span<double> q) {
  for (size_t l = 1; l < model.links.size(); ++l) {
    const Link& link = model.links[l];
    double* x = &q[link.q];
    const double* u = &v[link.v];
    if (CountVelocities(link.kind) == 1) {
      x[0] += u[0];
      continue;
    }
    const bool free = link.kind == JointKind::kFree;
    double* e = free ? x + 3 : x;
    const double* turn = free ? u + 3 : u;
    const Quaternion<double> before{e[0], e[1], e[2], e[3]};
    const Quaternion<double> after =
        before * math::MakeQuaternion(Vector3<double>{turn[0], turn[1], turn[2]});
    if (free) {
      // the translation goes along the axes of the middle of the turn
      const Quaternion<double> middle = before * math::MakeQuaternion(Vector3<double>{
                                                     0.5 * turn[0], 0.5 * turn[1], 0.5 * turn[2]});
      const Vector3<double> step = MakeRotation(middle) * Vector3<double>{u[0], u[1], u[2]};
      x[0] += step.x, x[1] += step.y, x[2] += step.z;
    }
    const double norm =
        std::sqrt(after.w * after.w + after.x * after.x + after.y * after.y + after.z * after.z);
    e[0] = after.w / norm, e[1] = after.x / norm, e[2] = after.y / norm, e[3] = after.z / norm;
  }
}

void NormaliseQuaternions(const Model& model, std::span<double> q) {
  for (const Link& link : model.links) {
    if (CountPositions(link.kind) < 4) continue;
    double* e = &q[link.q + CountPositions(link.kind) - 4];
    const double scale = 1 / std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3]);
    for (int i = 0; i < 4; ++i) e[i] *= scale;
  }
}

Eigen::MatrixXd CalcEquationMatrix(const Model& model, std::span<const double> q) {
  Workspace<double> w(model);
  UpdateAtRest(model, q, w);
  UpdateInertias(model, w);
  const int nv = model.velocities;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(nv + model.rows, nv + model.rows);
  for (int l = static_cast<int>(model.links.size()) - 1; l > 0; --l) {
    const Link& link = model.links[l];
    for (int i = link.v + CountVelocities(link.kind) - 1; i >= link.v; --i) {
      const Wrench<double> momentum = w.I[l] * w.axes[i];
      for (int j = i; j >= 0; j = model.dof_parent[j]) K(i, j) = K(j, i) = Dot(w.axes[j], momentum);
    }
    w.I[link.parent] = w.I[link.parent] + w.I[l];
  }
  K.topRightCorner(nv, model.rows) = CalcGradients(model, w);
  K.bottomLeftCorner(model.rows, nv) = K.topRightCorner(nv, model.rows).transpose();
  return K;
}

Eigen::VectorXd CalcResidual(const Model& model, std::span<const double> q,
                             std::span<const double> drive) {
  Workspace<double> w(model);
  UpdateAtRest(model, q, w);
  return CollectResidual(model, q, drive, w);
}

void MoveOnConstraints(const Model& model, std::span<const double> direction, std::span<double> q) {
  constexpr int kSteps = 8, kCorrections = 4;
  Workspace<double> w(model);
  UpdateAtRest(model, q, w);
  const Eigen::VectorXd wanted = CollectResidual(model, q, {}, w);
  const Eigen::Map<const Eigen::VectorXd> whole(direction.data(), model.velocities);
  std::vector<double> step(model.velocities);
  Eigen::Map<Eigen::VectorXd> v(step.data(), model.velocities);
  const std::vector<RowGroup> groups = GroupRows(model);
  Eigen::VectorXd rate(model.rows);
  for (int s = 0; s < kSteps; ++s) {
    v = whole / kSteps;
    if (model.rows > 0) {
      rate.setZero();
      VisitGradients(model, w, [&](int i, int r, double value) { rate[r] += value * v[i]; });
      v -= SolveGradients(model, groups, w, rate);
    }
    MovePositions(model, step, q);
    for (int c = 0; c < kCorrections && model.rows > 0; ++c) {
      UpdateAtRest(model, q, w);
      v = -SolveGradients(model, groups, w, CollectResidual(model, q, {}, w) - wanted);
      MovePositions(model, step, q);
    }
    UpdateAtRest(model, q, w);
  }
}

}  // namespace kingpin::mechanism
