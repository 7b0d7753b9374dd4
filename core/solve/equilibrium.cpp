#include "core/solve/equilibrium.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "core/mechanism/evaluator.h"
#include "core/mechanism/jacobian.h"
#include "core/mechanism/project.h"
#include "core/solve/null_space.h"

namespace kingpin::solve {

Equilibrium FindEquilibrium(const mechanism::System& system, const EquilibriumOptions& options,
                            std::span<double> y) {
  constexpr double kProjection = 1e-12;
  const mechanism::Model& model = system.model;
  const int nq = model.positions, nv = model.velocities, nz = system.states;
  mechanism::Evaluator evaluator(system);
  evaluator.ReleaseFriction();
  mechanism::JacobianEvaluator derivatives(system);
  Eigen::MatrixXd jacobian(derivatives.rows(), derivatives.columns());
  std::vector<double> rate(system.size()), trial(y.begin(), y.end()), step(nv);

  std::fill(y.begin() + nq, y.begin() + nq + nv, 0.0);
  evaluator.Project(0, y, kProjection, 0);
  std::fill(y.begin() + nq, y.begin() + nq + nv, 0.0);
  const auto measure = [&](std::span<const double> state) {
    evaluator.CalcRates(0, state, rate);
    return Eigen::Map<const Eigen::VectorXd>(rate.data() + nq, nv + nz);
  };
  Eigen::VectorXd residual = measure(y);
  double norm = residual.norm();
  double pseudo_step = 1e-3 / std::max(norm, 1e-3);  // moves of about a millimetre to begin with
  Equilibrium result;
  for (; result.iterations < options.iterations; ++result.iterations) {
    result.residual = residual.cwiseAbs().maxCoeff();
    if (result.residual <= options.tolerance) return result;
    derivatives.Calc(0, y, evaluator.workspace().active, jacobian);
    const Eigen::MatrixXd T = CalcNullSpace(model, {y.data(), static_cast<size_t>(nq)});
    const int free = static_cast<int>(T.cols()), n = free + nz;
    Eigen::MatrixXd A(n, n);
    A.topLeftCorner(free, free) = T.transpose() * jacobian.topLeftCorner(nv, nv) * T;
    A.bottomLeftCorner(nz, free) = jacobian.bottomLeftCorner(nz, nv) * T;
    A.topRightCorner(free, nz) = T.transpose() * jacobian.topRightCorner(nv, nz);
    A.bottomRightCorner(nz, nz) = jacobian.bottomRightCorner(nz, nz);
    Eigen::VectorXd right(n);
    right << T.transpose() * residual.head(nv), residual.tail(nz);
    bool moved = false;
    for (int attempt = 0; attempt < 40 && !moved; ++attempt) {
      Eigen::MatrixXd shifted = -A;
      shifted.diagonal().array() += 1 / pseudo_step;
      const Eigen::VectorXd change = shifted.completeOrthogonalDecomposition().solve(right);
      std::copy(y.begin(), y.end(), trial.begin());
      Eigen::Map<Eigen::VectorXd>(step.data(), nv) = T * change.head(free);
      mechanism::MovePositions(model, step, {trial.data(), static_cast<size_t>(nq)});
      for (int i = 0; i < nz; ++i) trial[nq + nv + i] += change[free + i];
      Eigen::VectorXd next;
      try {
        evaluator.Project(0, trial, kProjection, 1e300);
        next = measure(trial);
      } catch (const std::runtime_error&) {
        pseudo_step *= 0.1;  // went too far for the constraints
        continue;
      }
      // downhill moves may pass steeper places: growth is allowed as long as the steps are small
      const bool small =
          Eigen::Map<const Eigen::VectorXd>(step.data(), nv).cwiseAbs().maxCoeff() < 0.2;
      if (!next.allFinite() || !small || next.norm() > 10 * norm) {
        pseudo_step *= 0.1;
        continue;
      }
      const double ratio = norm / std::max(next.norm(), 1e-300);
      pseudo_step = std::min(pseudo_step * std::max(0.2, std::min(ratio * 1.5, 1e3)), 1e12);
      std::copy(trial.begin(), trial.end(), y.begin());
      residual = next;
      norm = residual.norm();
      moved = true;
    }
    if (!moved) break;
  }
  int worst = 0;
  result.residual = residual.cwiseAbs().maxCoeff(&worst);
  const std::string what =
      worst < nv
          ? fmt::format("link '{}' still accelerates by {:g}",
                        model.links[model.dof_link[worst]].name, result.residual)
          : fmt::format("state {} still changes at {:g} per second", worst - nv, result.residual);
  throw std::runtime_error(
      fmt::format("no equilibrium found after {} iterations: {}; is something held by "
                  "nothing, or by dry friction alone?",
                  result.iterations, what));
}

}  // namespace kingpin::solve
