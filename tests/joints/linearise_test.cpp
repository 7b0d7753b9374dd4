#include "core/solve/linearise.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/mechanism/evaluator.h"
#include "core/solve/equilibrium.h"
#include "joints/mechanism_builder.h"
#include "joints/mechanism_file.h"
#include "tests/joints/example_mechanisms.h"

namespace kingpin::joints {
namespace {

TEST(Linearise, ARodPendulumSwingsAtItsFrequency) {
  MechanismDescription d;
  d.gravity = {0, 0, -9.81};
  d.bodies = {MakeRod("rod", 3, {0.5, 0, 0}, 3.0 / 12)};
  d.joints = {MakeJoint("hinge", JointType::kRevolute, "world", {0, 0, 0}, "rod", {0, 1, 0})};
  Mechanism pendulum = MakeMechanism(d);
  pendulum.start[0] = 0.3;
  solve::FindEquilibrium(pendulum.system, {}, pendulum.start);
  EXPECT_NEAR(pendulum.start[0], std::numbers::pi / 2, 1e-9);  // hangs: x points down
  const auto modes = solve::CalcModes(solve::Linearise(pendulum.system, 0, pendulum.start));
  ASSERT_EQ(modes.size(), 1);
  EXPECT_NEAR(modes[0].frequency, std::sqrt(9.81 * 3 / 2) / (2 * std::numbers::pi), 1e-9);
}

// Crank and rod in line: no row hangs on the crank there, and the order of elimination chosen for
// other positions meets a pivot of zero. Stiffness k of the crank's spring and F r (1 + r/l) of the
// slider's force; inertia of the crank, and of the rod about its end in the slider, (r/l)² of it.
TEST(Linearise, ASliderCrankInItsDeadCentreSwingsAtItsFrequency) {
  const double r = 0.08, l = 0.3, k = 3, F = 50;
  const Mechanism mechanism = MakeMechanism(ReadMechanismText(R"(kind: mechanism
gravity: [0, 0, 0]
bodies:
  crank:  {mass: 1, centre: [0.04, 0, 0], inertia: [1e-3, 1e-3, 1e-3]}
  rod:    {mass: 0.5, centre: [0.15, 0, 0], inertia: [1e-4, 4e-3, 4e-3]}
  slider: {mass: 2, inertia: [1e-3, 1e-3, 1e-3]}
joints:
  crk: {type: revolute, child: crank, axis: [0, 1, 0], angle: 0}
  pin: {type: revolute, parent: crank, at: [0.08, 0, 0], child: rod, axis: [0, 1, 0], angle: 0}
  guide: {type: prismatic, child: slider, axis: [1, 0, 0], displacement: 0.38}
closures: {wrist: {type: spherical, a: rod, a_at: [0.3, 0, 0], b: slider}}
springs: {s: {joint: crk, stiffness: 3}}
motors: {m: {joint: guide, force: 50}}
)",
                                                              "slider_crank.yaml"));
  const auto modes = solve::CalcModes(solve::Linearise(mechanism.system, 0, mechanism.start));
  ASSERT_EQ(modes.size(), 1);
  const double inertia = 1e-3 + 1 * 0.04 * 0.04 + (4e-3 + 0.5 * 0.15 * 0.15) * (r / l) * (r / l);
  EXPECT_NEAR(modes[0].frequency,
              std::sqrt((k + F * r * (1 + r / l)) / inertia) / (2 * std::numbers::pi), 1e-9);
}

// A shaft, clamped at one end, of n springs in the middles of n parts: ω_1 against the continuum's
// π c/(2 L), whose relative error of order 1/n² lies below 1e-4 from 100 elements on, and against
// the rigid finite elements' own sin(π/4n)/(π/4n).
TEST(Modes, ALongUndampedShaftKeepsItsDigitsAndDoesNotGrow) {
  for (int n : {40, 200}) {
    bodies::BeamSegment segment;
    segment.length = 0.4;
    segment.section = bodies::RoundSection{0.015};
    segment.material = {206e9, 79.3e9, 7830, 0, 0};
    MechanismBuilder m("shaft");
    m.Gravity({0, 0, 0});
    BeamDescription beam;
    beam.name = "shaft";
    beam.at = {"world", {}};
    beam.elements = bodies::MakeBeamElements({segment}, n);
    beam.flexibility = BeamDescription::Flexibility::kTorsion;
    m.AddBeam(beam);
    const Mechanism shaft = m.Make();
    const auto modes = solve::CalcModes(solve::Linearise(shaft.system, 0, shaft.start));
    ASSERT_EQ(modes.size(), n);
    const double x = std::numbers::pi / (4 * n);
    const double expected = std::sqrt(79.3e9 / 7830) / (4 * 0.4) * std::sin(x) / x;
    // the eigenvalue solver's rounding of the largest ω², against the least
    const double ratio = modes.back().frequency / modes.front().frequency;
    EXPECT_NEAR(modes[0].frequency / expected, 1, 2.2e-16 * n * ratio * ratio);
    for (const solve::Mode& mode : modes) {
      EXPECT_LE(std::abs(mode.eigenvalue.real()), 1e-12 * std::abs(modes.back().eigenvalue));
    }
  }
}

TEST(Equilibrium, TheFourBarHangsWhereItsPotentialIsLeast) {
  Mechanism four_bar = MakeMechanism(MakeFourBar(0));
  std::vector<double> y = four_bar.start;
  solve::FindEquilibrium(four_bar.system, {}, y);
  mechanism::Evaluator evaluator(four_bar.system);
  const double least = evaluator.CalcEnergy(0, y).potential;
  EXPECT_LE(evaluator.CalcResiduals(0, y).position, 1e-11);
  // any crank angle nearby, the loop closed again, lies higher
  for (double offset : {-1e-3, 1e-3, -0.1, 0.1}) {
    std::vector<double> moved = y;
    moved[four_bar.GetJoint("A").q] += offset;
    evaluator.Project(0, moved, 1e-12, 1);
    EXPECT_GT(evaluator.CalcEnergy(0, moved).potential, least) << offset;
  }
}

TEST(Equilibrium, WithoutAnythingThatHoldsItSaysWhatFalls) {
  MechanismDescription d;
  d.bodies = {MakeRod("stone", 3, {0.5, 0, 0}, 3.0 / 12)};
  d.joints = {MakeJoint("fall", JointType::kPrismatic, "world", {0, 0, 0}, "stone", {0, 0, 1})};
  Mechanism stone = MakeMechanism(d);
  try {
    solve::FindEquilibrium(stone.system, {}, stone.start);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("link 'stone' still accelerates by 9.8"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace kingpin::joints
