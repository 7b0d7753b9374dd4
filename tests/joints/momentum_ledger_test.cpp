#include <gtest/gtest.h>

#include "core/solve/simulate.h"
#include "tests/joints/sample_mechanisms.h"

namespace kingpin::joints {
namespace {

using math::Wrench;

solve::Ledger CalcLedger(
    const Mechanism& mechanism, solve::Method method, double step_or_tolerance, double duration,
    const solve::Observer& observe = [](double, auto, auto&) {}) {
  solve::SimulationOptions options;
  options.stepper.method = method;
  options.stepper.step = step_or_tolerance;
  options.stepper.relative_tolerance = step_or_tolerance;
  options.stepper.absolute_tolerance = 0.01 * step_or_tolerance;
  options.duration = duration;
  options.sample_interval = 0.004;  // the books are of order 4 in the steps, whatever the method
  std::vector<double> y = mechanism.start;
  return Simulate(mechanism.system, options, y, observe);
}

void ExpectNear(const Vector3<double>& a, const Vector3<double>& b, double tolerance) {
  EXPECT_LT(CalcNorm(a - b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " against " << b.x << ' ' << b.y << ' ' << b.z;
}

// p = m v0 + m g t; L about the world's origin grows with the moment of the weight.
TEST(MomentumLedger, FollowsAThrownBody) {
  const Vector3<double> start{3, -2, 1}, centre{0.1, 0.2, 0.3};
  const double mass = 2, duration = 1.5;
  MechanismDescription d;
  BodyDescription body;
  body.name = "body";
  body.mass = mass;
  body.centre = centre;
  body.central_inertia = {0.3, 0.5, 0.4, 0.02, 0, 0.01};
  d.bodies = {body};
  d.joints = {MakeJoint("fly", JointType::kFree, "world", start, "body")};
  d.joints[0].velocity = {1, 2, 3, -3, 2, 4};
  d.gravity = {0.5, -0.25, -9.81};
  const solve::Ledger ledger =
      CalcLedger(MakeMechanism(d), solve::Method::kExplicit8, 1e-12, duration);
  const Vector3<double> p = ledger.momentum_start.f, weight = mass * d.gravity;
  EXPECT_GT(CalcNorm(p), 1);
  ExpectNear(ledger.momentum_end.f, p + duration * weight, 1e-9);
  ExpectNear(ledger.impulse.f, duration * weight, 1e-12);
  const Vector3<double> moment =
      Cross(duration * (start + centre) + 0.5 * duration * duration / mass * p, weight);
  ExpectNear(ledger.momentum_end.t, ledger.momentum_start.t + moment, 1e-8);
  EXPECT_LT(ledger.largest_momentum_error, 1e-9);
  EXPECT_LT(ledger.largest_angular_momentum_error, 1e-8);
}

// Linear and angular momentum m (v, r x v) of a body that cannot turn, by hand.
TEST(MomentumLedger, HoldsTheMomentumOfASlidingBody) {
  MechanismDescription d;
  BodyDescription body;
  body.name = "body";
  body.mass = 3;
  body.central_inertia = {1, 1, 1, 0, 0, 0};
  d.bodies = {body};
  d.joints = {MakeJoint("slide", JointType::kPrismatic, "world", {0.5, 4, -2}, "body", {1, 0, 0})};
  d.joints[0].velocity = {2};
  const solve::Ledger ledger = CalcLedger(MakeMechanism(d), solve::Method::kRungeKutta4, 0.01, 1);
  ExpectNear(ledger.momentum_end.f, {6, 0, 0}, 1e-12);
  ExpectNear(ledger.momentum_end.t, Cross({2.5, 4, -2}, Vector3<double>{6, 0, 0}), 1e-12);
  // the guide carries the weight: nothing comes in
  ExpectNear(ledger.impulse.f, {}, 1e-12);
  ExpectNear(ledger.impulse.t, {}, 1e-12);
}

// What bodies do to each other by joints, springs and loops does not show.
TEST(MomentumLedger, InnerForcesDoNotCount) {
  MechanismDescription d = MakeFourBar(5);
  for (JointDescription& joint : d.joints) {
    if (joint.parent.body == "world") joint.parent.body = "ground";
  }
  d.bodies.push_back(MakeRod("ground", 4, {0.45, 0, 0}, 0.5, 0.01));
  d.joints.push_back(MakeJoint("fly", JointType::kFree, "world", {2, 1, 0}, "ground"));
  d.gravity = {};
  Mechanism mechanism = MakeMechanism(d);
  SpringDescription spring;
  spring.name = "spring";
  spring.place = BetweenPoints{At("ground", {0, 0, 0.5}), At("rocker", {0.4, 0, 0})};
  spring.stiffness.coefficient = 500;
  spring.damping.coefficient = 3;
  AddForces({spring}, mechanism);
  const solve::Ledger ledger = CalcLedger(mechanism, solve::Method::kExplicit8, 1e-11, 2);
  EXPECT_GT(CalcNorm(ledger.momentum_start.f), 0.5);
  EXPECT_GT(ledger.dissipated, 0.1);
  ExpectNear(ledger.impulse.f, {}, 1e-9);
  ExpectNear(ledger.impulse.t, {}, 1e-9);
  ExpectNear(ledger.momentum_end.f, ledger.momentum_start.f, 1e-7);
  ExpectNear(ledger.momentum_end.t, ledger.momentum_start.t, 1e-7);
}

// A body tied to the world by a cut joint and a spring: weight, reaction and spring force are all
// there is.
TEST(MomentumLedger, WhatActsFromOutsideIsWeightReactionsAndForces) {
  MechanismDescription d;
  BodyDescription body;
  body.name = "body";
  body.mass = 2;
  body.centre = {0.4, 0, 0};
  body.central_inertia = {0.1, 0.3, 0.3, 0, 0, 0};
  d.bodies = {body};
  d.joints = {MakeJoint("fly", JointType::kFree, "world", {}, "body")};
  ClosureDescription cut;
  cut.name = "cut";
  cut.type = ClosureType::kSpherical;
  cut.a = At("body");
  cut.b = At("world", {});
  d.closures = {cut};
  Mechanism mechanism = MakeMechanism(d);
  SpringDescription spring;
  spring.name = "spring";
  const Vector3<double> ground{0.5, 1, 1};
  spring.place = BetweenPoints{At("world", ground), At("body", {0.4, 0, 0})};
  spring.stiffness.coefficient = 40;
  spring.free = 0.2;
  AddForces({spring}, mechanism);
  int samples = 0;
  const auto observe = [&](double, std::span<const double>, mechanism::Evaluator& evaluator) {
    const Wrench<double> external = evaluator.CalcExternalWrench();
    const auto& w = evaluator.workspace();
    const auto& [link, X_LF] = mechanism.GetBody("body");
    const Vector3<double> centre =
        w.reference + w.p[link] + w.R[link] * (X_LF * Vector3<double>{0.4, 0, 0});
    const Vector3<double> d = ground - centre;
    const Vector3<double> pull = (40 * (CalcNorm(d) - 0.2) / CalcNorm(d)) * d;
    const auto R = evaluator.reactions();
    const Vector3<double> weight = 2.0 * mechanism.system.model.gravity;
    ExpectNear(external.f, weight + pull + Vector3<double>{R[0], R[1], R[2]}, 1e-9);
    ExpectNear(external.t, Cross(centre, weight + pull), 1e-9);
    ++samples;
  };
  const solve::Ledger ledger = CalcLedger(mechanism, solve::Method::kExplicit8, 1e-10, 1, observe);
  EXPECT_GT(samples, 10);
  EXPECT_LT(ledger.largest_momentum_error, 1e-6);
  EXPECT_LT(ledger.largest_angular_momentum_error, 1e-6);
}

TEST(MomentumLedger, ErrorFallsWithTheMethodsOrder) {
  const Mechanism loop = MakeMechanism(MakeFourBar(5));
  for (auto [method, order] :
       {std::pair{solve::Method::kRungeKutta4, 4}, {solve::Method::kRosenbrock, 3}}) {
    const solve::Ledger coarse = CalcLedger(loop, method, 2e-3, 1),
                        fine = CalcLedger(loop, method, 1e-3, 1);
    EXPECT_GT(std::log2(coarse.largest_momentum_error / fine.largest_momentum_error), order - 0.3);
    EXPECT_GT(
        std::log2(coarse.largest_angular_momentum_error / fine.largest_angular_momentum_error),
        order - 0.3);
    EXPECT_LT(fine.largest_momentum_error, 1e-4);
  }
}

}  // namespace
}  // namespace kingpin::joints
