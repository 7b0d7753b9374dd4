#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/solve/simulate.h"
#include "tests/joints/example_mechanisms.h"

namespace kingpin::joints {
namespace {

using solve::Method;

// Force on a coordinate: -k x.
class CoordinateSpring : public mechanism::ForceGroup {
 public:
  CoordinateSpring(int q, int v, double stiffness) : q_(q), v_(v), stiffness_(stiffness) {}
  void AddForces(const mechanism::ForceContext<double>& c) const override { Add(c); }
  void AddForces(const mechanism::ForceContext<mechanism::Dual8>& c) const override { Add(c); }
  mechanism::EnergyRates CalcEnergy(const mechanism::ForceContext<double>& c) const override {
    return {0.5 * stiffness_ * c.q[q_] * c.q[q_], 0, 0};
  }

 private:
  template <class S>
  void Add(const mechanism::ForceContext<S>& c) const {
    c.w.generalised[v_] = c.w.generalised[v_] - S(stiffness_) * c.q[q_];
  }
  int q_, v_;
  double stiffness_;
};

MechanismDescription MakeBlock(double mass, double x0, double v0,
                               const FrictionDescription& friction) {
  MechanismDescription d;
  BodyDescription block;
  block.name = "block";
  block.mass = mass;
  block.central_inertia = {1, 1, 1, 0, 0, 0};
  d.bodies = {block};
  d.joints = {MakeJoint("slide", JointType::kPrismatic, "world", {0, 0, 0}, "block", {1, 0, 0})};
  d.joints[0].position = {x0};
  d.joints[0].velocity = {v0};
  d.frictions = {friction};
  return d;
}

FrictionDescription MakeFriction(double static_force, double kinetic_force) {
  FrictionDescription friction;
  friction.name = "rub";
  friction.joint = "slide";
  friction.static_force = static_force;
  friction.kinetic_force = kinetic_force;
  return friction;
}

solve::SimulationOptions MakeOptions(Method method, double duration, double step = 1e-3) {
  solve::SimulationOptions options;
  options.stepper.method = method;
  options.stepper.step = step;
  options.stepper.relative_tolerance = 1e-11;
  options.stepper.absolute_tolerance = 1e-13;
  options.duration = duration;
  options.sample_interval = 0;
  return options;
}

// m ẍ + k x = -F sign ẋ: half cycles about ±F/k, amplitude falling by 2 F/k each, until |k x| <=
// F_s at a turn.
TEST(DryFriction, TheCoulombOscillatorTurnsAndStopsWhereItShould) {
  const double m = 2, k = 50, F = 4,
               x0 = 1.0;  // F/k = 0.08: turns at 0.84, 0.68, ..., 0.04 < 0.08 sticks
  for (Method method :
       {Method::kExplicit8, Method::kBdf, Method::kRungeKutta4, Method::kRosenbrock}) {
    Mechanism mechanism = MakeMechanism(MakeBlock(m, x0, 0, MakeFriction(F, F)));
    mechanism.system.Add(std::make_unique<CoordinateSpring>(0, 0, k));
    const double half = std::numbers::pi * std::sqrt(m / k);
    std::vector<double> y = mechanism.start;
    double last_moving = 0, held = 0, drift = 0;
    bool stopped = false;
    const solve::Ledger ledger = Simulate(mechanism.system, MakeOptions(method, 100), y,
                                          [&](double t, auto state, auto& evaluator) {
                                            if (evaluator.modes()[0] != 0) last_moving = t;
                                            if (evaluator.modes()[0] == 0 && !stopped) {
                                              stopped = true;
                                              held = state[0];
                                            }
                                            if (stopped)
                                              drift = std::max(drift, std::abs(state[0] - held));
                                          });
    // 6 half cycles: 1 -> -0.84 -> 0.68 -> -0.52 -> 0.36 -> -0.2 -> 0.04
    const bool exact = method == Method::kExplicit8 || method == Method::kBdf;
    EXPECT_NEAR(held, 0.04, exact ? 1e-8 : 1e-6);
    EXPECT_LT(last_moving, 6 * half + 1e-6);
    EXPECT_GT(last_moving, 6 * half - 0.5);
    EXPECT_LE(drift, 1e-12);
    EXPECT_EQ(ledger.switches, 6);
    EXPECT_NEAR(ledger.dissipated, 0.5 * k * (x0 * x0 - 0.04 * 0.04), 1e-4);
    EXPECT_LT(ledger.largest_energy_error, 1e-4);
  }
}

// Block on a belt, F_s = 1 above F_k = 0.5: sticks, breaks away at k x = F_s, slides about x =
// F_k/k, sticks again.
TEST(DryFriction, StickSlipHasTheExactPeriod) {
  const double m = 1, k = 1, Fs = 1, Fd = 0.5, belt = 0.2;
  for (Method method : {Method::kExplicit8, Method::kBdf, Method::kRungeKutta4}) {
    FrictionDescription friction = MakeFriction(Fs, Fd);
    friction.counterpart = [=](double t) { return std::array<double, 3>{belt * t, belt, 0}; };
    Mechanism mechanism = MakeMechanism(MakeBlock(m, 0, belt, friction));
    mechanism.system.Add(std::make_unique<CoordinateSpring>(0, 0, k));
    std::vector<double> y = mechanism.start;
    std::vector<double> breaks;
    int mode = 0;
    double stick_error = 0;
    Simulate(mechanism.system, MakeOptions(method, 60), y,
             [&](double t, auto state, auto& evaluator) {
               if (mode == 0 && evaluator.modes()[0] != 0) breaks.push_back(t);
               mode = evaluator.modes()[0];
               if (mode == 0) stick_error = std::max(stick_error, std::abs(state[1] - belt));
             });
    ASSERT_GE(breaks.size(), 4);
    // first break at x = 1: t = 5
    const bool exact = method != Method::kRungeKutta4;
    EXPECT_NEAR(breaks[0], Fs / (k * belt), 1e-8);
    // Slip: x(t) = Fd + (Fs - Fd) cos t + belt sin t; the velocity returns to the belt's at t = 2π
    // - 2 atan((Fs-Fd)/belt); there x = 2 Fd - Fs, and sticking carries it back to Fs.
    const double slip = 2 * std::numbers::pi - 2 * std::atan((Fs - Fd) / belt);
    const double stick = 2 * (Fs - Fd) / belt;
    EXPECT_NEAR(breaks[2] - breaks[1], slip + stick, (exact ? 1e-6 : 1e-5) * (slip + stick));
    EXPECT_LE(stick_error, 1e-10);
  }
}

}  // namespace
}  // namespace kingpin::joints
