#include "core/mechanism/assemble.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/mechanism/project.h"

namespace kingpin::mechanism {

namespace {

Assembly Judge(const Eigen::VectorXd& residual, double tolerance) {
  Assembly assembly;
  for (int r = 0; r < residual.size(); ++r) {
    if (!(std::abs(residual[r]) <= tolerance)) assembly.open_rows.push_back(r);
  }
  std::sort(assembly.open_rows.begin(), assembly.open_rows.end(),
            [&](int a, int b) { return std::abs(residual[a]) > std::abs(residual[b]); });
  assembly.residual = residual.size() > 0 ? residual.cwiseAbs().maxCoeff() : 0;
  assembly.closed = assembly.open_rows.empty();
  return assembly;
}

// Gradients with the columns of held coordinates taken out.
Eigen::MatrixXd CalcFreeGradients(const Model& model, std::span<const double> q,
                                  std::span<const char> held) {
  Eigen::MatrixXd J = CalcEquationMatrix(model, q).bottomLeftCorner(model.rows, model.velocities);
  for (int r = 0; r < model.rows; ++r) {
    if (!model.holonomic[r]) J.row(r).setZero();
  }
  for (int i = 0; i < model.velocities; ++i) {
    if (held[i]) J.col(i).setZero();
  }
  return J;
}

Assembly MovePositionsUntilClosed(const Model& model, std::span<const double> drive,
                                  std::span<const char> held, double tolerance,
                                  std::span<double> q) {
  constexpr int kIterations = 200;
  Eigen::VectorXd residual = CalcResidual(model, q, drive);
  double damping = 1e-3;
  std::vector<double> step(model.velocities), trial(q.begin(), q.end());
  for (int k = 0; k < kIterations && !(residual.cwiseAbs().maxCoeff() <= tolerance); ++k) {
    const Eigen::MatrixXd J = CalcFreeGradients(model, q, held);
    const double scale = std::max(J.squaredNorm() / std::max<double>(1, J.rows()), 1e-300);
    bool better = false;
    for (int attempt = 0; attempt < 30 && !better; ++attempt) {
      // least change of the coordinates: Jᵀ (J Jᵀ + λ)⁻¹
      Eigen::MatrixXd A = J * J.transpose();
      A.diagonal().array() += damping * scale;
      Eigen::Map<Eigen::VectorXd>(step.data(), model.velocities) =
          -J.transpose() * A.ldlt().solve(residual);
      std::copy(q.begin(), q.end(), trial.begin());
      MovePositions(model, step, trial);
      const Eigen::VectorXd moved = CalcResidual(model, trial, drive);
      better = moved.norm() < residual.norm();
      if (better) {
        std::copy(trial.begin(), trial.end(), q.begin());
        residual = moved;
        damping = std::max(damping * 0.1, 1e-14);
      } else {
        damping *= 10;
      }
    }
    if (!better) break;
  }
  return Judge(residual, tolerance);
}

}  // namespace

Assembly AssemblePositions(const Model& model, std::span<const double> drive,
                           std::span<const char> held, double tolerance, std::span<double> q) {
  NormaliseQuaternions(model, q);
  if (model.rows == 0) return Judge({}, tolerance);
  std::vector<double> trial(q.begin(), q.end());
  Assembly assembly = MovePositionsUntilClosed(model, drive, held, tolerance, trial);
  if (!assembly.closed) {
    const std::vector<char> none(model.velocities, 0);
    std::copy(q.begin(), q.end(), trial.begin());
    assembly = MovePositionsUntilClosed(model, drive, none, tolerance, trial);
  }
  std::copy(trial.begin(), trial.end(), q.begin());
  return assembly;
}

Assembly AssembleVelocities(const Model& model, std::span<const double> rate,
                            std::span<const char> held, double tolerance, std::span<const double> q,
                            std::span<double> v) {
  if (model.rows == 0) return Judge({}, tolerance);
  Eigen::MatrixXd J = CalcEquationMatrix(model, q).bottomLeftCorner(model.rows, model.velocities);
  Eigen::VectorXd wanted = Eigen::Map<const Eigen::VectorXd>(rate.data(), model.rows);
  for (int r = 0; r < model.rows; ++r) {
    if (!model.switching[r]) continue;
    J.row(r).setZero();
    wanted[r] = 0;
  }
  Eigen::Map<Eigen::VectorXd> velocity(v.data(), model.velocities);
  Eigen::MatrixXd free = J;
  for (int i = 0; i < model.velocities; ++i) {
    if (held[i]) free.col(i).setZero();
  }
  for (const Eigen::MatrixXd* gradients : {&free, &J}) {
    velocity += gradients->completeOrthogonalDecomposition().solve(wanted - J * velocity);
    Assembly assembly = Judge(J * velocity - wanted, tolerance);
    if (assembly.closed) return assembly;
  }
  return Judge(J * velocity - wanted, tolerance);
}

}  // namespace kingpin::mechanism
