#include "core/solve/rosenbrock.h"

#include "core/mechanism/kinematics.h"

namespace kingpin::solve {

namespace {

// ROS34PW2, table 4.2 of Rang and Angermann (2005).
constexpr double kGamma = 4.3586652150845900e-01;
constexpr double kAlpha[4][3] = {{0, 0, 0},
                                 {8.7173304301691801e-01, 0, 0},
                                 {8.4457060015369423e-01, -1.1299064236484185e-01, 0},
                                 {0, 0, 1}};
constexpr double kGammas[4][3] = {
    {0, 0, 0},
    {-8.7173304301691801e-01, 0, 0},
    {-9.0338057013044082e-01, 5.4180672388095326e-02, 0},
    {2.4212380706095346e-01, -1.2232505839045147e+00, 5.4526025533510214e-01}};
constexpr double kB[4] = {2.4212380706095346e-01, -1.2232505839045147e+00, 1.5452602553351021e+00,
                          4.3586652150845900e-01};
constexpr double kEmbedded[4] = {3.7810903145819369e-01, -9.6042292212423178e-02, 5.0e-01,
                                 2.1793326075422950e-01};

}  // namespace

Rosenbrock::Rosenbrock(const mechanism::System& system)
    : system_(system), derivatives_(system), stage_(system.size()), rate_(system.size()) {
  const int n = derivatives_.rows(), nv = system.model.velocities;
  jacobian_ = fresh_ = Eigen::MatrixXd::Zero(n, derivatives_.columns());
  matrix_.resize(n, n);
  factor_ = Eigen::PartialPivLU<Eigen::MatrixXd>(n);
  k_x_.resize(n, kStages);
  k_q_.resize(system.model.positions, kStages);
  u_.resize(nv, kStages);
  sum_x_.resize(n);
  sum_u_.resize(nv);
  right_.resize(n);
  start_rate_.resize(system.model.positions);
  direction_.resize(nv);
}

void Rosenbrock::UpdateJacobian(mechanism::Evaluator& evaluator, double time,
                                std::span<const double> y) {
  if (!derivatives_.Calc(time, y, evaluator.workspace().active, fresh_)) return;
  jacobian_.swap(fresh_);
  factored_step_ = 0;
}

double Rosenbrock::Step(mechanism::Evaluator& evaluator, double time, double step,
                        std::span<double> y) {
  const mechanism::Model& model = system_.model;
  const int nq = model.positions, nv = model.velocities, n = derivatives_.rows();
  const auto B = jacobian_.leftCols(nv);
  const auto J = jacobian_.rightCols(n);
  const double h = step, hg = step * kGamma;
  if (factored_step_ != step) {
    matrix_ = -hg * J;
    matrix_.leftCols(nv) -= hg * hg * B;
    matrix_.diagonal().array() += 1;
    factor_.compute(matrix_);
    factored_step_ = step;
  }
  for (int i = 0; i < kStages; ++i) {
    std::copy(y.begin(), y.end(), stage_.begin());
    double alpha = 0;
    for (int j = 0; j < i; ++j) {
      const double a = kAlpha[i][j];
      alpha += a;
      if (a == 0) continue;
      for (int r = 0; r < nq; ++r) stage_[r] += a * k_q_(r, j);
      for (int r = 0; r < n; ++r) stage_[nq + r] += a * k_x_(r, j);
    }
    evaluator.CalcRates(time + alpha * h, stage_, rate_);
    sum_x_.setZero();
    sum_u_.setZero();
    for (int j = 0; j < i; ++j) {
      sum_x_ += kGammas[i][j] * k_x_.col(j);
      sum_u_ += kGammas[i][j] * u_.col(j);
    }
    const Eigen::Map<const Eigen::VectorXd> v(stage_.data() + nq, nv), f(rate_.data() + nq, n);
    right_ = h * f;
    right_.noalias() += h * (J * sum_x_);
    sum_u_ += hg * (v + sum_x_.head(nv));
    right_.noalias() += h * (B * sum_u_);
    k_x_.col(i) = factor_.solve(right_);
    // The position increment: with the stage's own N for h v, with that of the step's start for the
    // rest.
    const Eigen::Map<Eigen::VectorXd> rest(direction_.data(), nv);
    Eigen::Map<Eigen::VectorXd>(direction_.data(), nv) =
        h * (sum_x_.head(nv) + kGamma * k_x_.col(i).head(nv));
    u_.col(i) = h * v + rest;
    CalcPositionRates(model, y.data(), direction_.data(), start_rate_.data());
    for (int r = 0; r < nq; ++r) k_q_(r, i) = h * rate_[r] + start_rate_[r];
  }
  double error = 0;
  for (int r = 0; r < n; ++r) {
    double difference = 0;
    for (int i = 0; i < kStages; ++i) {
      y[nq + r] += kB[i] * k_x_(r, i);
      difference += (kB[i] - kEmbedded[i]) * k_x_(r, i);
    }
    error = std::max(error, std::abs(difference));
  }
  for (int r = 0; r < nq; ++r) {
    for (int i = 0; i < kStages; ++i) y[r] += kB[i] * k_q_(r, i);
  }
  return error;
}

}  // namespace kingpin::solve
