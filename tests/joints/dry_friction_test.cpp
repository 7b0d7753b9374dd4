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

// Sliding or sticking, what the row exerts is m ẍ + k x, and sliding it is F against the motion.
TEST(DryFriction, TheReactionIsTheFrictionForce) {
  const double m = 2, k = 50, F = 4;
  Mechanism mechanism = MakeMechanism(MakeBlock(m, 1, 0, MakeFriction(F, F)));
  mechanism.system.Add(std::make_unique<CoordinateSpring>(0, 0, k));
  std::vector<double> y = mechanism.start;
  int sliding = 0, sticking = 0;
  Simulate(mechanism.system, MakeOptions(Method::kExplicit8, 5), y,
           [&](double, auto state, auto& evaluator) {
             const double force = evaluator.reactions()[0];
             EXPECT_NEAR(force, m * evaluator.accelerations()[0] + k * state[0], 1e-9);
             const int mode = evaluator.modes()[0];
             if (mode != 0) {
               EXPECT_NEAR(force, -mode * F, 1e-12);
             }
             (mode == 0 ? sticking : sliding) += 1;
           });
  EXPECT_GT(sliding, 10);
  EXPECT_GT(sticking, 10);
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

// State at `duration` and the largest imbalance of energy at a fixed step.
struct Result {
  double x, v, imbalance;
};
Result RunBlock(const FrictionDescription& friction, double x0, double v0, Method method,
                double duration, double step) {
  Mechanism mechanism = MakeMechanism(MakeBlock(1, x0, v0, friction));
  mechanism.system.Add(std::make_unique<CoordinateSpring>(0, 0, 1));
  std::vector<double> y = mechanism.start;
  const solve::Ledger ledger = Simulate(mechanism.system, MakeOptions(method, duration, step), y,
                                        [](double, auto, auto&) {});
  return {y[0], y[1], ledger.largest_energy_error};
}

double CalcOrder(double coarse, double fine) { return std::log2(std::abs(coarse / fine)); }

// Events are located inside the step and the step is taken anew up to them, so that every piece
// between two events is smooth, and the methods keep the order that they have without friction.
TEST(DryFriction, FixedStepMethodsKeepTheirOrderOnTheCoulombOscillator) {
  const double F = 0.1, T = 10.7;  // in the fourth half cycle: about -F from -0.4, or 1 - 6 F
  const double phase = T - 3 * std::numbers::pi;
  const double exact_x = -F - (0.4 - F) * std::cos(phase), exact_v = (0.4 - F) * std::sin(phase);
  for (Method method : {Method::kRungeKutta4, Method::kRosenbrock}) {
    const int order = method == Method::kRungeKutta4 ? 4 : 3;
    const auto calc_error = [&](double step) {
      const Result result = RunBlock(MakeFriction(F, F), 1, 0, method, T, step);
      return std::hypot(result.x - exact_x, result.v - exact_v);
    };
    const double coarse = calc_error(0.04), fine = calc_error(0.02), finest = calc_error(0.01);
    EXPECT_NEAR(CalcOrder(coarse, fine), order, 0.4) << coarse << ' ' << fine;
    EXPECT_NEAR(CalcOrder(fine, finest), order, 0.4) << fine << ' ' << finest;
  }
}

// Sticks to the belt until t = 5, slips until the belt has it again at x = 2 Fd - Fs, sticks.
TEST(DryFriction, FixedStepMethodsKeepTheirOrderInStickSlip) {
  const double Fs = 1, Fd = 0.5, belt = 0.2;
  FrictionDescription friction = MakeFriction(Fs, Fd);
  friction.counterpart = [=](double t) { return std::array<double, 3>{belt * t, belt, 0}; };
  const double slip = 2 * std::numbers::pi - 2 * std::atan((Fs - Fd) / belt);
  // at some time in the second slip
  const double start = 5 + slip + 2 * (Fs - Fd) / belt, T = start + 2.3, phase = T - start;
  const double exact_x = Fd + (Fs - Fd) * std::cos(phase) + belt * std::sin(phase);
  const double exact_v = -(Fs - Fd) * std::sin(phase) + belt * std::cos(phase);
  for (Method method : {Method::kRungeKutta4, Method::kRosenbrock}) {
    const int order = method == Method::kRungeKutta4 ? 4 : 3;
    const auto run = [&](double step) {
      Result result = RunBlock(friction, 0, belt, method, T, step);
      result.x -= exact_x, result.v -= exact_v;
      return result;
    };
    const Result coarse = run(0.04), fine = run(0.02), finest = run(0.01);
    EXPECT_NEAR(CalcOrder(std::hypot(coarse.x, coarse.v), std::hypot(fine.x, fine.v)), order, 0.5);
    EXPECT_NEAR(CalcOrder(std::hypot(fine.x, fine.v), std::hypot(finest.x, finest.v)), order, 0.5);
    // the books balance to the same order, although the powers jump when the block breaks away
    EXPECT_GT(CalcOrder(coarse.imbalance, finest.imbalance), 2 * (order - 0.5))
        << coarse.imbalance << ' ' << finest.imbalance;
  }
}

// The normal force of a sliding coordinate is what is perpendicular to it, also in a joint that has
// other coordinates: a sleeve on a shaft under an axial push slows down by μ g of its weight alone.
TEST(DryFriction, TheNormalForceIsPerpendicularToTheCoordinate) {
  for (JointType type : {JointType::kPrismatic, JointType::kCylindrical}) {
    FrictionDescription friction = MakeFriction(0, 0);
    friction.static_coefficient = friction.kinetic_coefficient = 0.3;
    friction.from_joint = true;
    MechanismDescription d = MakeBlock(2, 0, 1, friction);
    d.gravity = {0, 0, -10};
    d.joints[0].type = type;
    d.joints[0].position = {};
    d.joints[0].velocity =
        type == JointType::kPrismatic ? std::vector<double>{1} : std::vector<double>{1, 0};
    const Mechanism mechanism = MakeMechanism(d);
    mechanism::Evaluator evaluator(mechanism.system);
    std::vector<double> rate(mechanism.system.size());
    evaluator.UpdateModes(0, mechanism.start, 1e-9);
    evaluator.CalcRates(0, mechanism.start, rate);
    EXPECT_NEAR(evaluator.accelerations()[0], -3, 1e-12) << static_cast<int>(type);
  }
}

// With the adaptive method the times of events are those of the closed form.
TEST(DryFriction, AdaptiveEventTimesAreExact) {
  const double F = 0.1;
  for (Method method : {Method::kExplicit8, Method::kBdf}) {
    Mechanism mechanism = MakeMechanism(MakeBlock(1, 1, 0, MakeFriction(F, F)));
    mechanism.system.Add(std::make_unique<CoordinateSpring>(0, 0, 1));
    std::vector<double> y = mechanism.start, turns;
    int mode = 0;
    Simulate(mechanism.system, MakeOptions(method, 20), y, [&](double t, auto, auto& evaluator) {
      if (mode != 0 && evaluator.modes()[0] != mode) turns.push_back(t);
      mode = evaluator.modes()[0];
    });
    // 1, -0.8, 0.6, -0.4, 0.2, 0: 1 - 0.2 n
    ASSERT_GE(turns.size(), 4);
    for (int n = 0; n < 4; ++n) {
      EXPECT_NEAR(turns[n], (n + 1) * std::numbers::pi, 1e-8) << static_cast<int>(method);
    }
  }
}

}  // namespace
}  // namespace kingpin::joints
