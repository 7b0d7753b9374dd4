#include "models/planar/simulate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "models/planar/paper_set.h"

namespace kingpin::planar {
namespace {

PaperSet ReadSet(const char* name) {
  return ReadPaperSet(std::string(KINGPIN_SOURCE_DIR) + "/examples/paper/set_" + name + ".json");
}

SimulationOptions MakeOptions(double step) {
  SimulationOptions options;
  options.method = Method::kRungeKutta4;
  options.step = step;
  return options;
}

double CalcLargest(const std::vector<double>& x) {
  double largest = 0;
  for (double value : x) largest = std::max(largest, std::abs(value));
  return largest;
}

double CalcLargestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST(Simulate, WithoutExcitationNothingMovesAtAll) {
  const History h = Simulate(ReadSet("B").parameters, Excitation(), MakeOptions(1e-4));
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(CalcLargest(h.q[i]), 0);
    EXPECT_EQ(CalcLargest(h.a[i]), 0);
  }
  EXPECT_EQ(CalcLargest(h.tie_rod_force), 0);
}

TEST(Simulate, EnergyBalanceCloses) {
  for (const char* name : {"A", "B", "C"}) {
    const PaperSet set = ReadSet(name);
    const History h = Simulate(set.parameters, Excitation(set.pulses), MakeOptions(1e-5));
    // The balance is integrated with the state: fourth order, 1e-12 at this step, plus rounding.
    EXPECT_LT(h.CalcEnergyResidual(), 1e-9) << name;
  }
}

TEST(Simulate, RungeKuttaIsOfFourthOrder) {
  // A smooth model (splines with straight nodes) and a smooth pulse, so that nothing hides the
  // order.
  PaperSet set = ReadSet("C");
  Curve<double>& n = set.parameters.longitudinal_force;
  for (int k = 0; k < n.count; ++k) n.f[static_cast<size_t>(k)] = 5e5 * n.x[static_cast<size_t>(k)];
  const Excitation excitation(set.pulses);
  const History fine = Simulate(set.parameters, excitation, MakeOptions(2.5e-6));
  double error[2];
  for (int i = 0; i < 2; ++i) {
    const History h = Simulate(set.parameters, excitation, MakeOptions(i == 0 ? 2.5e-5 : 1.25e-5));
    error[i] = CalcLargestDifference(h.rim_acceleration, fine.rim_acceleration);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 4, 0.4) << error[0] << ' ' << error[1];
}

TEST(Simulate, ADivergingRunSaysWhenAndInWhichCoordinate) {
  const PaperSet set = ReadSet("B");
  try {
    Simulate(set.parameters, Excitation(set.pulses), MakeOptions(5e-4));
    FAIL() << "the stiff set is unstable at this step";
  } catch (const io::RunError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(
                    testing::ContainsRegex("diverges at t = 0\\.[0-9]+ s in coordinate "),
                    testing::HasSubstr("with steps of 0.0005 s: they are too long for this model, "
                                       "or the model itself is unstable")));
  }
}

TEST(Simulate, FastMethodClosesTheEnergyBalanceAndAgreesWithRungeKutta) {
  for (const char* name : {"A", "B", "C"}) {
    const PaperSet set = ReadSet(name);
    const Excitation excitation(set.pulses);
    const History fast = Simulate(set.parameters, excitation, {});
    const History fine = Simulate(set.parameters, excitation, MakeOptions(1e-5));
    EXPECT_LT(fast.CalcEnergyResidual(), 1e-5) << name;
    for (int i = 0; i < 5; ++i) {
      // Pointwise, in the largest value; the measures are held to 1e-6.
      EXPECT_LT(CalcLargestDifference(fast.q[i], fine.q[i]), 1e-5 * CalcLargest(fine.q[i]));
      EXPECT_LT(CalcLargestDifference(fast.v[i], fine.v[i]), 1e-5 * CalcLargest(fine.v[i]));
    }
  }
}

TEST(Simulate, FastMethodIsOfHighOrder) {
  // The smooth model of the Runge-Kutta test, without the pulse's kinks falling between grid
  // points.
  PaperSet set = ReadSet("C");
  Curve<double>& n = set.parameters.longitudinal_force;
  for (int k = 0; k < n.count; ++k) n.f[static_cast<size_t>(k)] = 5e5 * n.x[static_cast<size_t>(k)];
  set.parameters.assist_force.count = 0;
  Pulse pulse;
  pulse.kind = PulseKind::kHalfSine;
  pulse.amplitude = 2000;
  pulse.start = 0.1;
  pulse.duration = 0.05;
  const Excitation excitation({pulse});
  SimulationOptions finest;
  finest.step = 1e-3 / 32;
  finest.tolerance = 1;
  const History fine = Simulate(set.parameters, excitation, finest);
  double error[2];
  for (int i = 0; i < 2; ++i) {
    SimulationOptions options;
    options.step = i == 0 ? 1e-3 / 4 : 1e-3 / 8;
    options.tolerance = 1;
    const History h = Simulate(set.parameters, excitation, options);
    error[i] = CalcLargestDifference(h.rim_acceleration, fine.rim_acceleration);
  }
  // Seven, less what the start adds: it is of fourth order, with a constant that its quarter steps
  // make small. That the weights are those of order seven is tested in exponential_adams_test.cpp.
  EXPECT_GT(std::log2(error[0] / error[1]), 5) << error[0] << ' ' << error[1];
}

// A lateral support of 1.3e9 N/m: 700 Hz, damped far beyond what the fast method can follow.
TEST(Simulate, AnErrorEstimateThatStaysTooLargeIsAnError) {
  PaperSet set = ReadSet("A");
  set.parameters.lateral_stiffness = 1.3e9;
  Pulse pulse;
  pulse.amplitude = 3000;
  pulse.start = 0.1;
  pulse.duration = 0.02;
  EXPECT_THAT([&] { Simulate(set.parameters, Excitation({pulse}), {}); },
              testing::ThrowsMessage<io::RunError>(testing::AllOf(
                  testing::ContainsRegex("estimated relative error [0-9.e+-]+ exceeds its bound "
                                         "0\\.00015 even with steps of 3\\.[0-9]+e-06 s"),
                  testing::HasSubstr("method: cvode"))));
}

TEST(Simulate, SaysHowItIntegrated) {
  const PaperSet set = ReadSet("A");
  const Excitation excitation(set.pulses);
  const IntegrationRecord fast = Simulate(set.parameters, excitation, {}).integration;
  EXPECT_EQ(fast.step, 2.5e-4);
  EXPECT_GT(fast.steps, 3000);
  EXPECT_GT(fast.error_estimate, 0);
  EXPECT_EQ(fast.error_bound, 1.5e-4);
  EXPECT_LE(fast.error_estimate, fast.error_bound);
  const IntegrationRecord rk4 = Simulate(set.parameters, excitation, MakeOptions(1e-4)).integration;
  EXPECT_EQ(rk4.step, 1e-4);
  EXPECT_GT(rk4.steps, 8000);
  EXPECT_TRUE(std::isnan(rk4.error_estimate));
}

TEST(Simulate, AStepThatDryFrictionCannotUseIsNamed) {
  PaperSet set = ReadSet("A");
  set.parameters.friction_law = FrictionLaw::kCoulomb;
  set.parameters.friction_constant = 50;
  SimulationOptions options;
  options.step = 2e-5;
  EXPECT_THAT([&] { Simulate(set.parameters, Excitation(set.pulses), options); },
              testing::ThrowsMessage<io::InputError>(
                  testing::HasSubstr("step: found 2e-05, expected at most 1e-05 s")));
}

TEST(Simulate, AForceAtRestIsNamed) {
  PaperSet set = ReadSet("A");
  Curve<double>& curve = set.parameters.longitudinal_force;
  const auto simulate = [&] { Simulate(set.parameters, Excitation(set.pulses), {}); };
  const auto says = testing::ThrowsMessage<io::InputError>(
      testing::AllOf(testing::HasSubstr("longitudinal_force: found"),
                     testing::HasSubstr("expected no force at rest")));
  curve.f[3] = 40;  // the node at zero
  EXPECT_THAT(simulate, says);
  curve.f[3] = 0;
  EXPECT_NO_THROW(simulate());
  // Without a node at zero the spline itself counts.
  curve.x[3] = 1e-4;
  EXPECT_THAT(simulate, says);
}

TEST(Simulate, RejectsGridsThatDoNotFit) {
  const PaperSet set = ReadSet("A");
  SimulationOptions options;
  options.sample_interval = 3e-4;
  EXPECT_THROW(Simulate(set.parameters, Excitation(set.pulses), options), io::InputError);
  options = {};
  options.step = -1;
  EXPECT_THROW(Simulate(set.parameters, Excitation(set.pulses), options), io::InputError);
  options = {};
  options.duration = NAN;
  EXPECT_THROW(Simulate(set.parameters, Excitation(set.pulses), options), io::InputError);
}

// A rack on a spring with constant Coulomb friction, everything else held: the rod lies along the
// rack, the carrier and the wheel are too heavy to move, and so are the column and the assistance
// left out.
Parameters<double> MakeRackOscillator() {
  Parameters<double> p = ReadSet("A").parameters;
  p.carrier_mass = 1e12;
  p.carrier_yaw_inertia = 1e12;
  p.wheel_inertia = 1e12;
  p.assist_force.count = 0;
  p.damping_time = 0;
  p.gear_ratio = 0;
  p.rack_position = p.outer_joint_x;
  p.rack_mass = 2;
  p.friction_law = FrictionLaw::kCoulomb;
  p.friction_constant = 3000;
  p.friction_coefficient = 0;
  return p;
}

TEST(CoulombFriction, RackSticksExactlyBelowBreakaway) {
  Parameters<double> p = ReadSet("A").parameters;
  p.friction_law = FrictionLaw::kCoulomb;
  p.friction_constant = 1e5;
  const PaperSet set = ReadSet("A");
  const History h = Simulate(p, Excitation(set.pulses), MakeOptions(2e-5));
  EXPECT_EQ(CalcLargest(h.q[3]), 0);
  EXPECT_EQ(CalcLargest(h.v[3]), 0);
  EXPECT_EQ(CalcLargest(h.a[3]), 0);
  EXPECT_EQ(CalcLargest(h.rim_acceleration), 0);
  EXPECT_GT(CalcLargest(h.friction_force), 100);
}

TEST(CoulombFriction, NeverExceedsItsLimitAndNeverCreatesEnergy) {
  for (const char* name : {"A", "C"}) {
    const PaperSet set = ReadSet(name);
    Parameters<double> p = set.parameters;
    p.friction_law = FrictionLaw::kCoulomb;
    p.friction_coefficient = 0.08;
    p.friction_constant = 60;
    const History h = Simulate(p, Excitation(set.pulses), MakeOptions(1e-5));
    int sticking = 0;
    for (size_t i = 0; i < h.size(); ++i) {
      const double rod_x = std::sqrt(std::max(
          0.0, h.tie_rod_force[i] * h.tie_rod_force[i] - h.rack_force[i] * h.rack_force[i]));
      EXPECT_LE(std::abs(h.friction_force[i]), (60 + 0.08 * rod_x) * (1 + 1e-6) + 1e-3);
      EXPECT_LE(h.friction_force[i] * h.v[3][i], 0);
      sticking += h.v[3][i] == 0 ? 1 : 0;
    }
    EXPECT_GT(sticking, 150) << name;
    EXPECT_LT(sticking, 990) << name;
    EXPECT_LT(h.CalcEnergyResidual(), 1e-8) << name;
  }
}

// m ÿ = −k y − F_c sign ẏ, driven by an elongation of the rod's carrier is not needed: a push by
// free play is avoided by starting from a road force that moves nothing. The rack is started by
// moving its rest position: the rod is stretched by a heavy carrier moving at constant speed v, so
// the rack sticks until k v t = F_c and then follows a closed form.
TEST(CoulombFriction, StickSlipOnAMovingRodFollowsItsClosedForm) {
  Parameters<double> p = MakeRackOscillator();
  p.carrier_mass = 1e12;
  // An impulse of 2 ms at the very start gives the carrier a constant speed (its supports are
  // removed).
  p.lateral_stiffness = 0;
  for (double& f : p.longitudinal_force.f) f = 0;
  p.longitudinal_damping = 0;
  p.lateral_share = 1e12;  // the force acts along y only, for any practical purpose
  p.force_x = 0;
  p.force_y = 0;
  Pulse pulse;
  pulse.kind = PulseKind::kHalfSine;
  pulse.amplitude = -20.0;
  pulse.duration = 2e-3;
  const double k = p.rod_rigidity / 0.515;
  // v = impulse / mass; impulse = A d 2/π.
  SimulationOptions options = MakeOptions(1e-5);
  options.duration = 0.05;
  options.sample_interval = 1e-4;
  p.rack_half_length = p.half_track + p.outer_joint_y - 0.515;  // l_0 = 0.515 m
  const History h = Simulate(p, Excitation({pulse}), options);
  // After the pulse the carrier moves at constant speed (the rod's force changes it by 1e-6 of
  // itself).
  const double v = h.v[1].back();
  ASSERT_GT(v, 0);
  // Breakaway where k · y_s = F_c; then m ÿ = k (y_s − y) − F_c  =>  y = v τ − (v/ω) sin ωτ, ω² =
  // k/m.
  const double omega = std::sqrt(k / p.rack_mass);
  const double tb = h.time.back() + (3000 / k - h.q[1].back()) / v;
  const double period = 2 * std::numbers::pi / omega;
  int compared = 0;
  for (size_t i = 0; i < h.size(); ++i) {
    const double tau = h.time[i] - tb;
    if (h.time[i] < 2.1e-3) continue;
    if (tau < 0) {
      EXPECT_EQ(h.q[3][i], 0);
    } else if (tau < period) {
      // ẏ = v (1 − cos ωτ) touches zero after one period, where the rack sticks again.
      const double y = v * tau - v / omega * std::sin(omega * tau);
      EXPECT_NEAR(h.q[3][i], y, 1e-5 * v * period) << tau;
      ++compared;
    }
  }
  EXPECT_GT(compared, 5);
}

}  // namespace
}  // namespace kingpin::planar
