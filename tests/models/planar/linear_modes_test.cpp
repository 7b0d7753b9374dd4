#include "models/planar/linear_modes.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/planar/planar_model.h"
#include "tests/models/planar/paper_sets.h"
#include "tests/models/planar/planar_car.h"

namespace kingpin::planar {
namespace {

Parameters<double> Undamped(Parameters<double> p) {
  p.damping_time = 0.0;
  p.longitudinal_damping = 0.0;
  for (auto& f : p.assist_force.f) f = 0.0;
  return p;
}

// 3.0 mm of tie rod as in the list: c_R alone decides, whatever the length.
Parameters<double> WithRodStiffness(Parameters<double> p, double stiffness) {
  p.rod_rigidity = 1e20;
  p.rod_compliance = 1.0 / stiffness;
  return p;
}

std::vector<double> Frequencies(const Modes& modes) {
  std::vector<double> f;
  for (const auto& mode : modes.modes) f.push_back(mode.frequency);
  return f;
}

TEST(LinearModes, CarHasTheListedEigenfrequencies) {
  // Vehicle data 3.4, printed to three digits: half of the last digit is allowed.
  EXPECT_THAT(
      Frequencies(CalcModes(MakeLinearModel(WithRodStiffness(Undamped(PlanarCar()), 5e6)))),
      testing::ElementsAre(0.0, testing::DoubleNear(18.8, 0.05), testing::DoubleNear(19.3, 0.05),
                           testing::DoubleNear(47.6, 0.05), testing::DoubleNear(284.0, 0.5)));
  EXPECT_THAT(
      Frequencies(CalcModes(MakeLinearModel(WithRodStiffness(Undamped(PlanarCar()), 1.08e8)))),
      testing::ElementsAre(0.0, testing::DoubleNear(18.9, 0.05), testing::DoubleNear(20.1, 0.05),
                           testing::DoubleNear(48.7, 0.05), testing::DoubleNear(1228.0, 0.5)));
}

TEST(LinearModes, ShapesAreMassOrthogonalWithoutDamping) {
  for (const auto& p : {sets::SetA().parameters, PlanarCar()}) {
    const LinearModel model = MakeLinearModel(Undamped(p));
    const Modes modes = CalcModes(model);
    ASSERT_EQ(modes.modes.size(), 5u);
    for (std::size_t a = 0; a < 5; ++a) {
      double share = 0.0;
      for (std::size_t b = 0; b < 5; ++b) {
        std::complex<double> product = 0.0;
        for (std::size_t k = 0; k < 5; ++k) {
          product += std::conj(modes.modes[a].shape[k]) * model.mass[k] * modes.modes[b].shape[k];
        }
        // The drift mode sits in a Jordan block: its vector is good to sqrt(ε) only.
        const double tolerance = a == 0 || b == 0 ? 1e-6 : 1e-9;
        EXPECT_NEAR(std::abs(product), a == b ? 1.0 : 0.0, tolerance) << a << " " << b;
        share += modes.modes[a].shares[b];
      }
      EXPECT_NEAR(share, 1.0, 1e-14);
    }
  }
}

TEST(LinearModes, EigenpairsSatisfyTheDefinition) {
  const LinearModel model = MakeLinearModel(sets::SetB().parameters);
  const Modes modes = CalcModes(model);
  for (const auto& mode : modes.modes) {
    if (mode.kind == ModeKind::kDrift) continue;
    const Eigen::Map<const Eigen::VectorXcd> shape(mode.shape.data(), model.a.rows());
    EXPECT_LT((model.a * shape - mode.eigenvalue * shape).norm(),
              1e-10 * model.a.norm() * shape.norm());
  }
}

TEST(LinearModes, FreeSteeringHasOneDriftModeWithoutAligningTorque) {
  for (const auto& set : sets::AllSets()) {
    const Modes modes = CalcModes(MakeLinearModel(set.parameters));
    int drifts = 0;
    for (const auto& mode : modes.modes) drifts += mode.kind == ModeKind::kDrift;
    EXPECT_EQ(drifts, 1) << set.name;
    EXPECT_EQ(modes.modes.front().kind, ModeKind::kDrift);
    EXPECT_THAT(modes.modes.front().summary, testing::HasSubstr("free turning of the steering"));
    EXPECT_TRUE(modes.stable) << set.name;

    auto centred = set.parameters;
    centred.aligning_stiffness = 700.0;
    EXPECT_NE(CalcModes(MakeLinearModel(centred)).modes.front().kind, ModeKind::kDrift);
    auto held = set.parameters;
    EXPECT_NE(CalcModes(HoldSteeringWheel(MakeLinearModel(held))).modes.front().kind,
              ModeKind::kDrift);
  }
}

TEST(LinearModes, RackDampingTurnsTheDoubleZeroIntoADriftAndARealPole) {
  // First order in the damping: λ = −b z_y²/(zᵀ M z), z the strainless shape.
  auto p = Undamped(sets::SetA().parameters);
  p.rack_damping = 1.0;
  const LinearModel model = MakeLinearModel(p);
  const Modes modes = CalcModes(model);
  ASSERT_EQ(modes.modes[0].kind, ModeKind::kDrift);
  ASSERT_EQ(modes.modes[1].kind, ModeKind::kOverdamped);
  const double rack = std::abs(modes.modes[0].shape[3]);  // zᵀ M z = 1
  EXPECT_NEAR(modes.modes[1].eigenvalue.real(), -rack * rack, 1e-3 * rack * rack);
}

TEST(LinearModes, AssistanceMakesTheSteeringHeavierFromTheRack) {
  // Coasting against rack damping, the rod drags the wheel through the assistance, which takes its
  // part of every torque: b/(rest + I_sw i_U (i_U + f')).
  auto p = sets::SetA().parameters;
  p.rack_damping = 600.0;  // enough to be told from the rounding of a double zero
  const double slope = MakeModel(p).constants.assist_force.segment[0].b;
  const auto boosted = CalcModes(MakeLinearModel(p)).modes[1].eigenvalue.real();
  for (auto& f : p.assist_force.f) f = 0.0;
  const auto plain = CalcModes(MakeLinearModel(p)).modes[1].eigenvalue.real();
  EXPECT_NEAR(1.0 / -boosted - 1.0 / -plain,
              p.wheel_inertia * p.gear_ratio * slope / p.rack_damping, 1e-3 / -boosted);
}

TEST(LinearModes, StiffnessProportionalDampingGivesItsClosedRatio) {
  // P = η K alone: ζ = η ω/2, and beyond 1 two real poles with product ω².
  auto p = Undamped(WithRodStiffness(PlanarCar(), 1.08e8));
  const Modes undamped = CalcModes(MakeLinearModel(p));
  p.damping_time = 1e-3;
  p.longitudinal_damping = 1e-3 * 4.9e5;
  const Modes damped = CalcModes(MakeLinearModel(p));
  for (std::size_t i = 1; i < 4; ++i) {
    const double omega = 2 * std::numbers::pi * undamped.modes[i].frequency;
    EXPECT_NEAR(damped.modes[i].damping_ratio, 0.5e-3 * omega, 1e-8);
    EXPECT_NEAR(damped.modes[i].frequency, undamped.modes[i].frequency, 1e-7);
  }
  const double omega = 2 * std::numbers::pi * undamped.modes[4].frequency;
  ASSERT_EQ(damped.modes.size(), 6u);
  EXPECT_EQ(damped.modes[4].kind, ModeKind::kOverdamped);
  EXPECT_EQ(damped.modes[5].kind, ModeKind::kOverdamped);
  EXPECT_NEAR(damped.modes[4].eigenvalue.real() * damped.modes[5].eigenvalue.real(), omega * omega,
              1e-8 * omega * omega);
  // The pole that sets the paper's step of 1e-5 s: about η ω², Runge-Kutta limit 2.785/|λ|.
  EXPECT_NEAR(damped.fastest_rate / (1e-3 * omega * omega), 1.0, 0.02);
  EXPECT_NEAR(damped.rk4_step_limit * damped.fastest_rate, 2.785293563405282, 1e-6);
}

TEST(LinearModes, Rk4LimitOfAnUndampedModeIsTwoRootTwo) {
  const auto modes = CalcModes(MakeLinearModel(Undamped(PlanarCar())));
  EXPECT_NEAR(modes.rk4_step_limit * modes.fastest_rate, 2.8284271247461903, 1e-5);
}

TEST(LinearModes, AssistanceLagIsNamed) {
  auto p = sets::SetC().parameters;
  p.assist_lag = AssistLag::kFirstOrder;
  p.assist_time = 2e-5;  // far faster than anything else: its own pole
  const Modes modes = CalcModes(MakeLinearModel(p));
  int lags = 0;
  for (const auto& mode : modes.modes) lags += mode.kind == ModeKind::kLag;
  EXPECT_EQ(lags, 1);
}

}  // namespace
}  // namespace kingpin::planar
