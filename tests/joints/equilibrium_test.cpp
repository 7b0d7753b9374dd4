#include "core/solve/equilibrium.h"

#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/mechanism/evaluator.h"
#include "joints/mechanism_file.h"
#include "joints/mechanism_run.h"

namespace kingpin::joints {
namespace {

using testing::HasSubstr;

Mechanism Read(const std::string& text) {
  return MakeMechanism(ReadMechanismText(text, "rest.yaml"));
}

std::string FindMessage(const std::string& text) {
  try {
    Read(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "came to rest";
}

TEST(Equilibrium, WhatCannotMoveRestsAsItIs) {
  const std::string fixed = R"(kind: mechanism
bodies: {b: {mass: 1 kg, inertia: [1, 1, 1]}}
joints: {j: {type: fixed, child: b}}
simulation: {start_at_rest: true}
)";
  EXPECT_TRUE(Read(fixed).start.empty());
  const std::string driven = R"(kind: mechanism
bodies: {b: {mass: 1 kg, centre: [1, 0, 0], inertia: [1, 1, 1]}}
joints: {j: {type: revolute, child: b, axis: [0, 1, 0], angle: 0.3}}
springs: {s: {joint: j, stiffness: 20}}
motions: {m: {joint: j, start: 0.3}}
simulation: {start_at_rest: true}
)";
  EXPECT_NEAR(Read(driven).start.at(0), 0.3, 1e-14);
}

TEST(Equilibrium, AMechanismOfTurnedFramesFindsIts) {
  const Mechanism mechanism = Read(R"(kind: mechanism
bodies:
  crank:   {mass: 0.8 kg, centre: [60 mm, 0, 0], inertia: [1e-4, 1e-3, 1e-3]}
  coupler: {mass: 1.7 kg, centre: [0.2, 0, 0.03], inertia: [1e-3, 0.03, 0.03]}
  rocker:  {mass: 1.1 kg, centre: [0.15, 0, 0], inertia: [1e-3, 0.012, 0.012]}
joints:
  A: {type: revolute, child: crank, axis: [0, -1, 0], angle: 40 deg}
  B: {type: revolute, parent: crank, at: [0.12, 0, 0], child: coupler, axis: [0, -1, 0]}
  D: {type: revolute, at: [0.42, 0, 0.05], child: rocker, axis: [0, -1, 0], angle: 80 deg}
closures:
  C: {type: revolute, a: coupler, a_at: [0.4, 0, 0], a_turned: [90 deg, 0, 0],
      b: rocker, b_at: [0.3, 0, 0], b_turned: [90 deg, 0, 0]}
springs: {S: {joint: A, stiffness: 20, free: 0.5, damping: 0.3}}
simulation: {start_at_rest: true}
)");
  mechanism::Evaluator evaluator(mechanism.system);
  std::vector<double> rate(mechanism.start.size());
  evaluator.CalcRates(0, mechanism.start, rate);
  for (double r : rate) EXPECT_LE(std::abs(r), 1e-8);
}

// w = F L³/(3 E I) + κ F L/(G A), κ = 10/9 of round sections. With n springs, each in the middle of
// its part, Σ lever² has the closed form n/3 - 1/(12 n) lengths squared: the bending is 1 - 1/(4
// n²) times that of the continuum.
double CalcTipDeflection(int n, bool shears) {
  constexpr double kE = 210e9, kG = 81e9, kLength = 0.3, kDiameter = 0.01, kForce = 2;
  const double area = std::numbers::pi * kDiameter * kDiameter / 4;
  const double moment = area * kDiameter * kDiameter / 16;
  const double bending =
      kForce * std::pow(kLength, 3) / (3 * kE * moment) * (1 - 1 / (4.0 * n * n));
  return bending + (shears ? 10.0 / 9 * kForce * kLength / (kG * area) : 0);
}

TEST(Equilibrium, AStiffCantileverBendsAsItsSpringsSay) {
  for (const char* flexibility : {"torsion_and_bending", "all"}) {
    for (int elements : {5, 20, 25, 40}) {
      SCOPED_TRACE(fmt::format("{} elements, {}", elements, flexibility));
      const Mechanism mechanism = Read(fmt::format(R"(kind: mechanism
gravity: [0, 0, 0]
beams:
  b:
    elements: {}
    flexibility: {}
    material: {{E: 210 GPa, G: 81 GPa, density: 7850 kg/m^3}}
    segments: [{{length: 0.3 m, section: round, diameter: 10 mm}}]
bodies: {{tip: {{mass: 0.1, inertia: [1e-4, 1e-4, 1e-4]}}}}
joints: {{weld: {{type: fixed, parent: b.end, child: tip}}}}
forces: {{pull: {{body: tip, force: [0, 0, -2]}}}}
simulation: {{start_at_rest: true}}
)",
                                                   elements, flexibility));
      mechanism::Evaluator evaluator(mechanism.system);
      std::vector<double> rate(mechanism.start.size());
      evaluator.CalcRates(0, mechanism.start, rate);
      const mechanism::Frame tip = mechanism.GetBody("tip");
      const auto& w = evaluator.workspace();
      const double z = (w.R[tip.link] * tip.X_LF.p + w.p[tip.link] + w.reference).z;
      // large deflections take off a share of the order of the slope squared, (0.0026)²
      const bool shears = flexibility == std::string("all");
      EXPECT_NEAR(z / -CalcTipDeflection(elements, shears), 1, 1e-5);
    }
  }
}

TEST(Equilibrium, HeavyBeamsOfAnyKindComeToRest) {
  for (const char* flexibility : {"torsion_and_bending", "all"}) {
    for (int elements : {5, 20, 40}) {
      EXPECT_EQ(FindMessage(fmt::format(R"(kind: mechanism
beams:
  b:
    elements: {}
    flexibility: {}
    material: {{E: 70 GPa, G: 26 GPa, density: 2700}}
    segments: [{{length: 1 m, section: round, diameter: 30 mm, end_diameter: 20 mm}}]
bodies: {{t: {{mass: 0.5 kg, inertia: [1e-3, 1e-3, 1e-3]}}}}
joints: {{w: {{type: fixed, parent: b.end, child: t}}}}
forces: {{F: {{body: t, force: [0, 0, -20]}}}}
simulation: {{start_at_rest: true}}
)",
                                        elements, flexibility)),
                "came to rest");
    }
  }
}

// A stiff beam carries a soft pendulum: what the beam's rounding hides must not be taken for rest.
TEST(Equilibrium, ASoftJointOnAStiffBeamComesToRestAsExactly) {
  const Mechanism mechanism = Read(R"(kind: mechanism
beams:
  b:
    turned: [0, 90 deg, 0]
    elements: 25
    material: {E: 210 GPa, G: 81 GPa, density: 7850 kg/m^3}
    segments: [{length: 0.3 m, section: round, diameter: 10 mm}]
bodies: {rod: {mass: 0.1, centre: [0.1, 0, 0], inertia: [1e-5, 1e-4, 1e-4]}}
joints: {hinge: {type: revolute, parent: b.end, child: rod, axis: [0, 1, 0], angle: 0.5}}
springs: {s: {joint: hinge, stiffness: 0.2, free: 0.4}}
simulation: {start_at_rest: true}
)");
  // the beam hangs down, nearly straight: k (θ - θ_0) + m g l sin θ = 0, less what the beam bends
  double angle = 0.3;
  for (int i = 0; i < 50; ++i) {
    angle -= (0.2 * (angle - 0.4) + 0.1 * 9.80665 * 0.1 * std::sin(angle)) /
             (0.2 + 0.1 * 9.80665 * 0.1 * std::cos(angle));
  }
  EXPECT_NEAR(mechanism.start[mechanism.GetJoint("hinge").q], angle, 1e-3);
  mechanism::Evaluator evaluator(mechanism.system);
  std::vector<double> rate(mechanism.start.size());
  evaluator.CalcRates(0, mechanism.start, rate);
  const int v = mechanism.GetJoint("hinge").v;
  EXPECT_LE(std::abs(rate[mechanism.system.model.positions + v]), 1e-5);
}

TEST(Equilibrium, DrivesThatMoveAtTheStartStandStillForIt) {
  const Mechanism mechanism = Read(R"(kind: mechanism
bodies:
  b: {mass: 1, inertia: [0.1, 0.1, 0.1]}
  c: {mass: 2, inertia: [0.1, 0.1, 0.1]}
joints:
  j: {type: prismatic, child: b, axis: [0, 0, 1]}
  k: {type: prismatic, parent: b, child: c, axis: [0, 0, 1]}
springs: {s: {joint: k, stiffness: 1000}}
motions: {m: {joint: j, start: 0.1, rate: 0.3, amplitude: 0.01, frequency: 5, phase: 90 deg}}
simulation: {start_at_rest: true}
)");
  EXPECT_NEAR(mechanism.start[mechanism.GetJoint("j").q], 0.11, 1e-12);
  EXPECT_NEAR(mechanism.start[mechanism.GetJoint("k").q], -2 * 9.80665 / 1000, 1e-12);
  // the drive's rate, and c, which nothing makes move, stays where it is
  const int nq = mechanism.system.model.positions;
  EXPECT_NEAR(mechanism.start[nq + mechanism.GetJoint("j").v], 0.3, 1e-12);
  EXPECT_NEAR(mechanism.start[nq + mechanism.GetJoint("k").v], -0.3, 1e-12);
}

TEST(Equilibrium, WhatIsHeldByNothingIsToldFromASearchThatFails) {
  EXPECT_THAT(FindMessage(R"(kind: mechanism
bodies: {stone: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
joints: {fall: {type: prismatic, child: stone, axis: [0, 0, 1]}}
simulation: {start_at_rest: true}
)"),
              HasSubstr("held by nothing"));
  MechanismFile file = ReadMechanismText(R"(kind: mechanism
bodies: {rod: {mass: 1, centre: [0.5, 0, 0], inertia: [0, 0.1, 0.1]}}
joints: {hinge: {type: revolute, child: rod, axis: [0, 1, 0], angle: 0.2}}
)",
                                         "rod.yaml");
  Mechanism rod = MakeMechanism(file);
  solve::EquilibriumOptions options;
  options.iterations = 2;
  try {
    solve::FindEquilibrium(rod.system, options, rod.start);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("start nearer to the position of rest"));
  }
}

TEST(Simulate, WithoutCoordinatesEveryMethodStandsStill) {
  for (const char* method : {"rosenbrock", "rk4", "explicit8", "bdf"}) {
    const MechanismRun run = RunMechanism(ReadMechanismText(fmt::format(R"(kind: mechanism
bodies: {{b: {{mass: 1 kg, inertia: [1, 1, 1]}}}}
joints: {{j: {{type: fixed, child: b}}}}
simulation: {{method: {}, duration: 0.01}}
)",
                                                                        method),
                                                            "fixed.yaml"));
    EXPECT_EQ(run.summary["degrees_of_freedom"], 0) << method;
  }
}

}  // namespace
}  // namespace kingpin::joints
