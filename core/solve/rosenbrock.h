#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "core/mechanism/evaluator.h"
#include "core/mechanism/jacobian.h"

namespace kingpin::solve {

/// Linearly implicit fixed-step method for stiff mechanisms: ROS34PW2 of Rang and Angermann (New
/// Rosenbrock W-methods of order 3 for partial differential algebraic equations of index 1, BIT 45,
/// 2005), four stages, L-stable. It is a W-method: order 3 holds for any matrix in place of the
/// Jacobian, so that an old Jacobian costs stability and no order. Forces and motions that are
/// functions of time need no ∂f/∂t: time is one more state, whose column of the matrix is zero.
///
/// With x = (v, z), ẋ = f(q, x), q̇ = N(q) v, and the Jacobian B = ∂f/∂(position directions), J =
/// ∂f/∂x the position part of a stage is eliminated:
///
///   (I - hγ J - h²γ² [B 0]) k_i = h f(q_i, x_i) + h J Σ γ_ij k_j + h B (Σ γ_ij u_j + γ (h v_i + h
///   Σ γ_ij k_v,j)) u_i = h v_i + h Σ_{j<=i} γ_ij k_v,j        position increment, in directions at
///   the step's start
///
/// The accelerations in f are those of the constrained system, so that the method sees an ordinary
/// differential equation on the constraints; Evaluator::Project brings the state back onto them
/// after each step.
class Rosenbrock {
 public:
  explicit Rosenbrock(const mechanism::System& system);

  /// The Jacobian of the steps to come is taken here. Call it every step or every few steps. In a
  /// singular position there is none, and the last one is kept: any matrix keeps the order.
  void UpdateJacobian(mechanism::Evaluator& evaluator, double time, std::span<const double> y);

  /// y from time to time + step; constraints are not projected here.
  /// @returns an estimate of the step's error: the largest difference to the embedded method of
  /// order 2 in v and z
  double Step(mechanism::Evaluator& evaluator, double time, double step, std::span<double> y);

 private:
  static constexpr int kStages = 4;

  const mechanism::System& system_;
  mechanism::JacobianEvaluator derivatives_;
  Eigen::MatrixXd jacobian_, fresh_, matrix_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
  double factored_step_ = 0;
  std::vector<double> stage_, rate_;
  Eigen::MatrixXd k_x_;  // one column per stage
  Eigen::MatrixXd k_q_;  // plain position increments
  Eigen::MatrixXd u_;    // position increments in directions at the step's start
  Eigen::VectorXd sum_x_, sum_u_, right_;
  std::vector<double> start_rate_, direction_;
};

}  // namespace kingpin::solve
