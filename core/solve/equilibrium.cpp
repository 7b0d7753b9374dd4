#include "core/solve/equilibrium.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "core/mechanism/evaluator.h"
#include "core/mechanism/jacobian.h"
#include "core/mechanism/project.h"
#include "core/solve/null_space.h"

namespace kingpin::solve {

namespace {

using mechanism::Dual8;
using mechanism::ForceContext;
using mechanism::ForceGroup;
using mechanism::System;

constexpr double kProjection = 1e-12;
constexpr double kLargestMove = 0.2;  // of a coordinate in one step [m, rad]

// The forces of another system's group.
class SameForces final : public ForceGroup {
 public:
  explicit SameForces(const ForceGroup& group) : group_(group) {}
  int CountStates() const override { return group_.CountStates(); }
  void SetInitialStates(double* states) const override { group_.SetInitialStates(states); }
  void AddForces(const ForceContext<double>& context) const override { group_.AddForces(context); }
  void AddForces(const ForceContext<Dual8>& context) const override { group_.AddForces(context); }
  mechanism::EnergyRates CalcEnergy(const ForceContext<double>& context) const override {
    return group_.CalcEnergy(context);
  }
  std::string FindNotFinite(const ForceContext<double>& context) const override {
    return group_.FindNotFinite(context);
  }

 private:
  const ForceGroup& group_;
};

// The system with its drives standing where they are at t = 0.
System MakeStill(const System& system) {
  System still;
  still.name = system.name;
  still.model = system.model;
  still.friction = system.friction;
  for (const auto& group : system.forces) still.Add(std::make_unique<SameForces>(*group));
  for (const mechanism::Drive& drive : system.drives) {
    still.drives.emplace_back();
    if (!drive) continue;
    const double place = drive(0)[0];
    still.drives.back() = [place](double) { return std::array<double, 3>{place, 0, 0}; };
  }
  return still;
}

class Search {
 public:
  Search(const System& system, const EquilibriumOptions& options, std::span<double> y)
      : model_(system.model),
        options_(options),
        nv_(system.model.velocities),
        nz_(system.states),
        y_(y),
        evaluator_(system),
        derivatives_(system),
        jacobian_(derivatives_.rows(), derivatives_.columns()),
        rate_(system.size()),
        trial_(y.size()),
        step_(nv_) {
    evaluator_.ReleaseFriction();
  }

  Equilibrium Find() {
    const auto v = y_.subspan(model_.positions, nv_);
    std::fill(v.begin(), v.end(), 0.0);
    evaluator_.Project(0, y_, kProjection, 0);
    std::fill(v.begin(), v.end(), 0.0);
    if (nv_ + nz_ == 0) return {};
    residual_ = Measure(y_);
    // moves of about a millimetre to begin with
    pseudo_step_ = 1e-3 / std::max(residual_.norm(), 1e-3);
    Equilibrium result;
    for (; result.iterations < options_.iterations; ++result.iterations) {
      result.residual = residual_.cwiseAbs().maxCoeff();
      if (result.residual <= options_.tolerance) return result;
      if (!derivatives_.Calc(0, y_, evaluator_.workspace().active, jacobian_)) {
        throw std::runtime_error(
            fmt::format("no equilibrium found after {} iterations: the mechanism is in a singular "
                        "position, where forces have no derivatives; start beside it",
                        result.iterations));
      }
      SetEquations();
      if (right_.size() == 0) return result;  // nothing can move
      if (IsRounding()) {
        if (ImproveByNewton()) continue;
        result.residual = residual_.cwiseAbs().maxCoeff();
        return result;
      }
      if (!Advance()) break;
    }
    Fail(result.iterations);
  }

 private:
  Eigen::VectorXd Measure(std::span<const double> state) {
    evaluator_.CalcRates(0, state, rate_);
    return Eigen::Map<const Eigen::VectorXd>(rate_.data() + model_.positions, nv_ + nz_);
  }

  // A = ∂(η̇, ż)/∂(ξ, z) and (η̇, ż) in the directions that the constraints leave.
  void SetEquations() {
    const NullSpace space =
        CalcNullSpace(model_, {y_.data(), static_cast<size_t>(model_.positions)});
    basis_ = space.basis;
    const int free = free_ = space.freedoms(), n = free + nz_;
    matrix_.setZero(n, n);
    right_.setZero(n);
    if (free > 0) {
      matrix_.topLeftCorner(free, free) =
          space.inverse * jacobian_.topLeftCorner(nv_, nv_) * basis_;
      right_.head(free) = space.inverse * residual_.head(nv_);
    }
    if (nz_ > 0) {
      matrix_.bottomRightCorner(nz_, nz_) = jacobian_.bottomRightCorner(nz_, nz_);
      right_.tail(nz_) = residual_.tail(nz_);
    }
    if (free > 0 && nz_ > 0) {
      matrix_.bottomLeftCorner(nz_, free) = jacobian_.bottomLeftCorner(nz_, nv_) * basis_;
      matrix_.topRightCorner(free, nz_) = space.inverse * jacobian_.topRightCorner(nv_, nz_);
    }
  }

  // (shift - A) Δ = (η̇, ż); of least norm where that leaves Δ open.
  Eigen::VectorXd SolveStep(double shift) const {
    Eigen::MatrixXd shifted = -matrix_;
    shifted.diagonal().array() += shift;
    return shifted.completeOrthogonalDecomposition().solve(right_);
  }

  // The accelerations at y moved by Δ, in trial_; empty if the constraints cannot follow.
  Eigen::VectorXd Try(const Eigen::VectorXd& change) {
    std::copy(y_.begin(), y_.end(), trial_.begin());
    if (free_ > 0) {
      Eigen::Map<Eigen::VectorXd>(step_.data(), nv_) = basis_ * change.head(free_);
      mechanism::MovePositions(model_, step_,
                               {trial_.data(), static_cast<size_t>(model_.positions)});
    }
    for (int i = 0; i < nz_; ++i) trial_[model_.positions + nv_ + i] += change[free_ + i];
    for (double s : step_) {
      if (!(std::abs(s) < kLargestMove)) return {};
    }
    try {
      evaluator_.Project(0, trial_, kProjection, 1e300);
      Eigen::VectorXd next = Measure(trial_);
      if (next.allFinite()) return next;
    } catch (const std::runtime_error&) {  // went too far for the constraints
    }
    return {};
  }

  void Accept(const Eigen::VectorXd& residual) {
    std::copy(trial_.begin(), trial_.end(), y_.begin());
    residual_ = residual;
  }

  // Whether each acceleration left is what the rounding of the positions makes of it.
  bool IsRounding() const {
    constexpr double kUnit = std::numeric_limits<double>::epsilon();
    for (int i = 0; i < nv_ + nz_; ++i) {
      double size = 0;
      for (int j = 0; j < nv_; ++j) size += std::abs(jacobian_(i, j));
      for (int j = 0; j < nz_; ++j) {
        size += std::abs(jacobian_(i, 2 * nv_ + j) * y_[model_.positions + nv_ + j]);
      }
      if (std::abs(residual_[i]) > options_.tolerance + kUnit * size) return false;
    }
    return true;
  }

  // Newton's own step. @returns whether it gained enough to go on
  bool ImproveByNewton() {
    const Eigen::VectorXd next = Try(SolveStep(0));
    if (next.size() == 0 || !(next.norm() < residual_.norm())) return false;
    const bool gains = next.norm() < 0.5 * residual_.norm();
    Accept(next);
    return gains;
  }

  bool Advance() {
    constexpr int kAttempts = 40;
    const double norm = residual_.norm();
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const Eigen::VectorXd next = Try(SolveStep(1 / pseudo_step_));
      // downhill moves may pass steeper places: growth is allowed as long as the steps are small
      if (next.size() == 0 || next.norm() > 10 * norm) {
        pseudo_step_ *= 0.1;
        continue;
      }
      const double ratio = norm / std::max(next.norm(), 1e-300);
      pseudo_step_ = std::min(pseudo_step_ * std::max(0.2, std::min(ratio * 1.5, 1e3)), 1e12);
      Accept(next);
      return true;
    }
    return false;
  }

  [[noreturn]] void Fail(int iterations) const {
    int worst = 0;
    const double most = residual_.cwiseAbs().maxCoeff(&worst);
    const std::string what =
        worst < nv_ ? fmt::format("link '{}' still accelerates by {:g}",
                                  model_.links[model_.dof_link[worst]].name, most)
                    : fmt::format("state {} still changes at {:g} per second", worst - nv_, most);
    // what no motion changes is held by nothing
    const bool held = (right_ + matrix_ * SolveStep(0)).norm() < 1e-3 * right_.norm();
    throw std::runtime_error(fmt::format(
        "no equilibrium found after {} iterations: {}; {}", iterations, what,
        held ? "there are forces that hold it, but the search does not come to rest between them: "
               "start nearer to the position of rest"
             : "is something held by nothing, or by dry friction alone?"));
  }

  const mechanism::Model& model_;
  const EquilibriumOptions& options_;
  const int nv_, nz_;
  std::span<double> y_;
  mechanism::Evaluator evaluator_;
  mechanism::JacobianEvaluator derivatives_;
  Eigen::MatrixXd jacobian_, basis_, matrix_;
  Eigen::VectorXd residual_, right_;
  std::vector<double> rate_, trial_, step_;
  int free_ = 0;
  double pseudo_step_ = 0;
};

}  // namespace

Equilibrium FindEquilibrium(const System& system, const EquilibriumOptions& options,
                            std::span<double> y) {
  const System still = MakeStill(system);
  const Equilibrium equilibrium = Search(still, options, y).Find();
  mechanism::Evaluator evaluator(system);
  evaluator.ReleaseFriction();
  evaluator.Project(0, y, kProjection, 0);  // velocities that follow the drives
  return equilibrium;
}

}  // namespace kingpin::solve
