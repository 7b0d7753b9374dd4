#pragma once

#include <algorithm>

#include <gtest/gtest.h>

#include "core/math/quaternion.h"
#include "core/mechanism/evaluator.h"
#include "core/mechanism/jacobian.h"
#include "core/mechanism/kinematics.h"
#include "core/mechanism/project.h"
#include "joints/mechanism_builder.h"
#include "tests/core/mechanism/random_mechanism.h"

namespace kingpin::joints {

inline bodies::RigidInertia MakeUnevenBody(double mass) {
  return bodies::Move(bodies::MakeBox(mass, {0.3, 0.5, 0.8}),
                      {math::MakeRotation(math::MakeQuaternion(Vector3<double>{0.3, -0.4, 0.2})),
                       {0.1, 0.05, -0.08}});
}

/// Bodies a and b that fly, and c that slides and turns on b (joint "slide"). No gravity.
inline MechanismBuilder MakeFlyingBodies() {
  MechanismBuilder m("flying bodies");
  m.Gravity({0, 0, 0});
  m.AddBody("a", MakeUnevenBody(3)).AddBody("b", MakeUnevenBody(2)).AddBody("c", MakeUnevenBody(1));
  m.AddFree("fly_a", At("world"), At("a")).Position({0.1, 0.2, -0.1, 1, 0, 0, 0});
  m.AddFree("fly_b", At("world"), At("b")).Position({0.4, 0.5, 0.9, 1, 0, 0, 0});
  m.AddCylindrical("slide", At("b", {0.2, 0.1, 0}), At("c"), {0, 0, 1});
  return m;
}

/// y = (q, v) of the engine's coordinates with random poses (rotations of about `turn` radians) and
/// velocities.
inline std::vector<double> MakeRandomState(const Mechanism& mechanism, unsigned seed, double turn,
                                           double speed = 1) {
  mechanism::RandomMechanism random(seed);
  std::vector<double> y = mechanism.start, step(mechanism.system.model.velocities);
  for (size_t i = 0; i < step.size(); ++i) step[i] = (i % 6 < 3 ? 0.3 : turn) * random.Normal();
  const mechanism::Model& model = mechanism.system.model;
  mechanism::MovePositions(model, step, {y.data(), static_cast<size_t>(model.positions)});
  for (int i = 0; i < model.velocities; ++i) y[model.positions + i] = speed * random.Normal();
  return y;
}

/// All forces of a mechanism at one state.
class ForceProbe {
 public:
  explicit ForceProbe(const Mechanism& mechanism)
      : system_(mechanism.system), w_(mechanism.system.model) {}

  /// Generalised force per velocity coordinate.
  std::vector<double> CalcGeneralised(double time, const std::vector<double>& y) {
    const mechanism::Model& model = system_.model;
    const auto context = Update(time, y);
    std::fill(w_.f.begin(), w_.f.end(), math::Wrench<double>{});
    std::fill(w_.generalised.begin(), w_.generalised.end(), 0.0);
    for (const auto& group : system_.forces) group->AddForces(context);
    std::vector<double> Q = w_.generalised;
    for (size_t l = 1; l < model.links.size(); ++l) {
      for (int k = static_cast<int>(l); k > 0; k = model.links[k].parent) {
        const mechanism::Link& link = model.links[k];
        for (int i = link.v; i < link.v + CountVelocities(link.kind); ++i) {
          Q[i] += Dot(w_.axes[i], w_.f[l]);
        }
      }
    }
    return Q;
  }
  /// Sum of the wrenches on all links, the world included, after CalcGeneralised.
  math::Wrench<double> SumWrenches() const {
    math::Wrench<double> sum;
    for (const auto& f : w_.f) sum = sum + f;
    return sum;
  }
  mechanism::EnergyRates CalcEnergy(double time, const std::vector<double>& y) {
    const auto context = Update(time, y);
    mechanism::EnergyRates sum;
    for (const auto& group : system_.forces) {
      const mechanism::EnergyRates rates = group->CalcEnergy(context);
      sum.potential += rates.potential;
      sum.dissipated += rates.dissipated;
      sum.supplied += rates.supplied;
    }
    return sum;
  }
  /// dU/ds at s = 0 along joint velocities `direction`, differences of fourth order.
  double CalcPotentialSlope(double time, const std::vector<double>& y,
                            const std::vector<double>& direction) {
    constexpr double h = 1e-4;
    const auto at = [&](double s) {
      std::vector<double> moved = y, step = direction;
      for (double& x : step) x *= s;
      mechanism::MovePositions(system_.model, step,
                               {moved.data(), static_cast<size_t>(system_.model.positions)});
      return CalcEnergy(time, moved).potential;
    };
    return (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
  }

 private:
  mechanism::ForceContext<double> Update(double time, const std::vector<double>& y) {
    const mechanism::Model& model = system_.model;
    mechanism::UpdatePositions(model, y.data(), w_);
    mechanism::UpdateVelocities(model, y.data() + model.positions, w_);
    return {model, time, y.data(), y.data() + model.positions, nullptr, nullptr, w_};
  }

  const mechanism::System& system_;
  mechanism::Workspace<double> w_;
};

inline double CalcLargest(const std::vector<double>& values) {
  double largest = 0;
  for (double x : values) largest = std::max(largest, std::abs(x));
  return largest;
}

/// At rest the generalised forces are minus the gradient of the potential. For conservative
/// elements. Tolerance: differences of step h = 1e-4 leave h⁴ and 1e-16/h.
inline void CheckGradient(const Mechanism& mechanism, std::vector<double> y) {
  const mechanism::Model& model = mechanism.system.model;
  std::fill(y.begin() + model.positions, y.end(), 0.0);
  ForceProbe probe(mechanism);
  const std::vector<double> Q = probe.CalcGeneralised(0, y);
  const double scale = CalcLargest(Q) + std::abs(probe.CalcEnergy(0, y).potential);
  ASSERT_GT(scale, 0);
  for (int i = 0; i < model.velocities; ++i) {
    std::vector<double> direction(model.velocities);
    direction[i] = 1;
    EXPECT_NEAR(Q[i], -probe.CalcPotentialSlope(0, y, direction), 1e-9 * scale)
        << "direction " << i;
  }
}

/// The power of all forces is accounted for: Q·v = -dU/dt - dissipated + supplied.
inline void CheckPower(const Mechanism& mechanism, const std::vector<double>& y,
                       double time = 0.3) {
  const mechanism::Model& model = mechanism.system.model;
  const std::vector<double> v(y.begin() + model.positions,
                              y.begin() + model.positions + model.velocities);
  ForceProbe probe(mechanism);
  const std::vector<double> Q = probe.CalcGeneralised(time, y);
  double power = 0, size = 0;
  for (int i = 0; i < model.velocities; ++i) power += Q[i] * v[i], size += std::abs(Q[i] * v[i]);
  const mechanism::EnergyRates rates = probe.CalcEnergy(time, y);
  const double slope = probe.CalcPotentialSlope(time, y, v);
  EXPECT_GE(rates.dissipated, 0);
  EXPECT_NEAR(power, -slope - rates.dissipated + rates.supplied,
              1e-9 * (size + std::abs(rates.potential)));
}

/// Forces between bodies add up to no wrench at all: momentum and angular momentum stay.
inline void CheckReaction(const Mechanism& mechanism, const std::vector<double>& y) {
  ForceProbe probe(mechanism);
  const double scale = CalcLargest(probe.CalcGeneralised(0.3, y));
  const math::Wrench<double> sum = probe.SumWrenches();
  for (double x : {sum.f.x, sum.f.y, sum.f.z, sum.t.x, sum.t.y, sum.t.z}) {
    EXPECT_NEAR(x, 0, 1e-13 * scale);
  }
}

/// Forward derivatives of the accelerations against central differences of fourth order.
inline void CheckJacobian(const Mechanism& mechanism, const std::vector<double>& y,
                          double tolerance = 1e-8) {
  const mechanism::System& system = mechanism.system;
  const mechanism::Model& model = system.model;
  const int nv = model.velocities;
  mechanism::Evaluator evaluator(system);
  mechanism::JacobianEvaluator derivatives(system);
  Eigen::MatrixXd jacobian(nv, 2 * nv);
  derivatives.Calc(0.3, y, evaluator.workspace().active, jacobian);
  std::vector<double> rate(system.size());
  for (int column = 0; column < 2 * nv; ++column) {
    const auto at = [&](double s) {
      std::vector<double> moved = y, step(nv);
      if (column < nv) {
        step[column] = s;
        mechanism::MovePositions(model, step, {moved.data(), static_cast<size_t>(model.positions)});
      } else {
        moved[model.positions + column - nv] += s;
      }
      evaluator.CalcRates(0.3, moved, rate);
      return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(rate.data() + model.positions, nv));
    };
    constexpr double h = 1e-4;
    const Eigen::VectorXd slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    const double scale = jacobian.cwiseAbs().maxCoeff() + at(0).cwiseAbs().maxCoeff();
    EXPECT_LT((jacobian.col(column) - slope).cwiseAbs().maxCoeff(), tolerance * scale)
        << "direction " << column;
  }
}

}  // namespace kingpin::joints
