#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "joints/mechanism_file.h"
#include "joints/mechanism_run.h"

// Several dry friction elements on one freedom, on freedoms that constraints move, and normal
// forces that depend on the friction itself.

namespace kingpin::joints {
namespace {

const char* const kMethods[] = {"rosenbrock", "rk4", "explicit8", "bdf"};

std::string MakeSliderCrank(const std::string& rest) {
  return R"(kind: mechanism
bodies:
  crank:  {mass: 1, centre: [0.04, 0, 0], inertia: [0.1, 0.1, 0.1]}
  rod:    {mass: 0.5, centre: [0.15, 0, 0], inertia: [1e-4, 4e-3, 4e-3]}
  slider: {mass: 2, inertia: [1e-3, 1e-3, 1e-3]}
joints:
  crk: {type: revolute, child: crank, axis: [0, 1, 0], angle: 1}
  pin: {type: revolute, parent: crank, at: [0.08, 0, 0], child: rod, axis: [0, 1, 0]}
  guide: {type: prismatic, child: slider, axis: [1, 0, 0], displacement: 0.33}
closures:
  wrist: {type: spherical, a: rod, a_at: [0.3, 0, 0], b: slider}
)" + rest;
}

MechanismRun RunText(const std::string& text, const std::string& method) {
  MechanismFile file = ReadMechanismText(text + ", method: " + method + "}\n", "friction.yaml");
  return RunMechanism(file);
}

const std::vector<double>& GetChannel(const MechanismRun& run, const std::string& name) {
  for (const io::Signals::Channel& channel : run.signals.channels) {
    if (channel.name == name) return channel.values;
  }
  throw std::out_of_range(name);
}

double CalcEnergyError(const MechanismRun& run) {
  return run.summary["energy"]["largest_error"].get<double>();
}

// v = 5 - t: m = 1, F_k = 1.
TEST(FrictionGroups, AStartVelocityIsKept) {
  for (const char* method : kMethods) {
    const MechanismRun run = RunText(R"(kind: mechanism
gravity: [0, 0, 0]
bodies: {block: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
joints: {slide: {type: prismatic, child: block, axis: [1, 0, 0], displacement_rate: 5}}
frictions: {f: {joint: slide, static_force: 2, kinetic_force: 1}}
simulation: {duration: 1, sample_interval: 0.1)",
                                     method);
    EXPECT_NEAR(GetChannel(run, "slide.rate").front(), 5, 1e-12) << method;
    EXPECT_NEAR(GetChannel(run, "slide.rate").back(), 4, 1e-8) << method;
    EXPECT_NEAR(GetChannel(run, "f.reaction").back(), -1, 1e-12) << method;
  }
}

// Two brakes on one joint hold the sum of their static limits, 11 N, whichever carries what.
TEST(FrictionGroups, BrakesOnOneJointHoldTogether) {
  const std::string brakes = R"(kind: mechanism
gravity: [0, 0, 0]
bodies: {b: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
joints: {j: {type: prismatic, child: b, axis: [1, 0, 0]}}
frictions:
  f1: {joint: j, static_force: 10, kinetic_force: 8}
  f2: {joint: j, static_force: 1, kinetic_force: 0.1}
forces: {push: {body: b, force: [PUSH, 0, 0], history: [[0, 0], [1, 1], [2, 1]]}}
simulation: {duration: 2, sample_interval: 10 ms)";
  const auto run_with = [&](const std::string& push, const char* method) {
    std::string text = brakes;
    return RunText(text.replace(text.find("PUSH"), 4, push), method);
  };
  for (const char* method : kMethods) {
    const MechanismRun held = run_with("10.9", method);
    EXPECT_NEAR(GetChannel(held, "j").back(), 0, 1e-9) << method;
    const auto &f1 = GetChannel(held, "f1.reaction"), &f2 = GetChannel(held, "f2.reaction");
    for (size_t k = 0; k < f1.size(); ++k) {
      EXPECT_LE(std::abs(f1[k]), 10 + 1e-9);
      EXPECT_LE(std::abs(f2[k]), 1 + 1e-9);
      EXPECT_NEAR(f1[k] + f2[k], -10.9 * std::min(1.0, held.signals.time[k]), 1e-7);
    }
    // 11.1 N break away at t = 11/11.1 s; then 8.1 N slide against them
    const MechanismRun slides = run_with("11.1", method);
    EXPECT_NEAR(slides.friction_changes.back().time, 11 / 11.1, 1e-6) << method;
    EXPECT_NEAR(GetChannel(slides, "j.acceleration").back(), 3, 1e-9) << method;
  }
}

// Virtual work: a torque T on the crank of a four-bar in rest moves it when T - Q_g reaches the sum
// of the limits times the ratios of the joint rates to the crank's.
TEST(FrictionGroups, ALinkageBreaksAwayAtTheLimitOfVirtualWork) {
  const std::string linkage = R"(kind: mechanism
gravity: [0, 0, 0]
bodies:
  crank:   {mass: 1, centre: [0.15, 0, 0], inertia: [0.01, 0.01, 0.01]}
  coupler: {mass: 2, centre: [0.5, 0, 0], inertia: [0.2, 0.2, 0.2]}
  rocker:  {mass: 1.5, centre: [0.4, 0, 0], inertia: [0.1, 0.1, 0.1]}
joints:
  A: {type: revolute, child: crank, axis: [0, -1, 0], angle: 60 deg}
  B: {type: revolute, parent: crank, at: [0.3, 0, 0], child: coupler, axis: [0, -1, 0]}
  D: {type: revolute, at: [0.9, 0, 0], child: rocker, axis: [0, -1, 0]}
closures:
  C: {type: spherical, a: coupler, a_at: [1, 0, 0], b: rocker, b_at: [0.8, 0, 0]}
frictions:
  fA: {joint: A, static_force: 12, kinetic_force: 10}
  fB: {joint: B, static_force: 1, kinetic_force: 1}
  fD: {joint: D, static_force: 2, kinetic_force: 1}
forces:
  T: {body: crank, torque: [0, -30, 0], history: [[0, 0], [1, 1], [1.5, 1], [2, 0]]}
)";
  MechanismFile free = ReadMechanismText(linkage + "simulation: {duration: 1}\n", "linkage.yaml");
  free.description.frictions.clear();
  free.description.joints[0].velocity = {1};
  const Mechanism moving = MakeMechanism(free);  // rates of B and D for one of A
  const size_t v = moving.system.model.positions;
  const double rate_A = moving.start[v], limit = 12 * std::abs(rate_A) +
                                                 1 * std::abs(moving.start[v + 1]) +
                                                 2 * std::abs(moving.start[v + 2]);
  for (const char* method : kMethods) {
    const MechanismRun run =
        RunText(linkage + "simulation: {duration: 0.8, sample_interval: 10 ms, step: 1 ms", method);
    double first = 0;
    for (const auto& change : run.friction_changes) {
      if (change.time > 0 && first == 0) first = change.time;
    }
    EXPECT_NEAR(first, limit / std::abs(rate_A) / 30, 1e-6) << method;
    EXPECT_GT(std::abs(GetChannel(run, "A.rate").back()), 0.01) << method;
  }
}

// The slider stops at the dead centres, whatever its friction: the crank carries it on.
TEST(FrictionGroups, ACrankTurnsThroughItsDeadCentres) {
  for (const char* method : kMethods) {
    const MechanismRun run =
        RunText(MakeSliderCrank(R"(frictions: {f: {joint: guide, static_force: 5, kinetic_force: 5}}
motors: {m: {joint: crk, force: 5}}
simulation: {duration: 1, sample_interval: 10 ms, step: 0.5 ms)"),
                method);
    EXPECT_GT(GetChannel(run, "crk").back(), 2 * M_PI) << method;
    EXPECT_GE(run.summary["friction_switches"].get<int>(), 2) << method;
    EXPECT_LT(CalcEnergyError(run), 1e-3) << method;
  }
}

// A motion that starts with neither rate nor acceleration, along or across the friction.
TEST(FrictionGroups, AMotionCarriesItsFrictionOutOfRest) {
  const std::string cycloid = "rate: 1, amplitude: -1, frequency: 0.15915494309189535}}\n";
  for (const char* method : kMethods) {
    const MechanismRun direct = RunText(R"(kind: mechanism
gravity: [0, 0, 0]
bodies: {b: {mass: 1, inertia: [0.1, 0.1, 0.1]}}
joints: {j: {type: prismatic, child: b, axis: [1, 0, 0]}}
frictions: {f: {joint: j, static_force: 2, kinetic_force: 1}}
motions: {m: {joint: j, )" + cycloid + "simulation: {duration: 1, sample_interval: 10 ms",
                                        method);
    EXPECT_NEAR(GetChannel(direct, "j").back(), 1 - std::sin(1.0), 1e-9) << method;
    EXPECT_NEAR(GetChannel(direct, "f.reaction").back(), -1, 1e-12) << method;
    // the motion's force drives the mass and the friction
    EXPECT_NEAR(GetChannel(direct, "m.reaction").back(), std::sin(1.0) + 1, 1e-8) << method;
    const MechanismRun crank = RunText(
        MakeSliderCrank("frictions: {f: {joint: guide, static_force: 5, kinetic_force: 4}}\n"
                        "motions: {m: {joint: crk, start: 1, " +
                        cycloid + "simulation: {duration: 3, sample_interval: 10 ms"),
        method);
    EXPECT_NEAR(GetChannel(crank, "crk").back(), 1 + 3 - std::sin(3.0), 1e-9) << method;
    EXPECT_NEAR(std::abs(GetChannel(crank, "f.reaction").back()), 4, 1e-12) << method;
  }
}

// Swings, sticks and slides in guide, crank bearing and pin at once, to rest.
TEST(FrictionGroups, ThreeFrictionsOnOneFreedomComeToRest) {
  for (const char* method : kMethods) {
    const MechanismRun run = RunText(MakeSliderCrank(R"(frictions:
  f: {joint: guide, from_joint: true, static_coefficient: 0.2, kinetic_coefficient: 0.15}
  g: {joint: crk, static_force: 0.5, kinetic_force: 0.5}
  h: {joint: pin, static_force: 0.1, kinetic_force: 0.1}
springs: {s: {joint: crk, stiffness: 3, free: 2, damping: 0.01}}
simulation: {duration: 3, sample_interval: 10 ms, step: 0.5 ms)"),
                                     method);
    EXPECT_NEAR(GetChannel(run, "crk.rate").back(), 0, 1e-12) << method;
    EXPECT_LT(run.summary["friction_switches"].get<int>(), 100) << method;
    EXPECT_LT(CalcEnergyError(run), 1e-3) << method;
    // at rest, all within their limits
    EXPECT_LE(std::abs(GetChannel(run, "g.reaction").back()), 0.5 + 1e-9) << method;
    EXPECT_LE(std::abs(GetChannel(run, "h.reaction").back()), 0.1 + 1e-9) << method;
  }
}

// A linkage that its brakes hold, with a pendulum that swings on it.
TEST(FrictionGroups, BrakesHoldALinkageThatCarriesAPendulum) {
  for (const char* method : kMethods) {
    const MechanismRun run = RunText(R"(kind: mechanism
bodies:
  crank:   {mass: 1, centre: [0.15, 0, 0], inertia: [0.01, 0.01, 0.01]}
  coupler: {mass: 2, centre: [0.5, 0, 0], inertia: [0.2, 0.2, 0.2]}
  rocker:  {mass: 1.5, centre: [0.4, 0, 0], inertia: [0.1, 0.1, 0.1]}
  p: {mass: 0.2, centre: [0.1, 0, 0], inertia: [0.001, 0.001, 0.001]}
joints:
  A: {type: revolute, child: crank, axis: [0, -1, 0], angle: 60 deg}
  B: {type: revolute, parent: crank, at: [0.3, 0, 0], child: coupler, axis: [0, -1, 0]}
  D: {type: revolute, at: [0.9, 0, 0], child: rocker, axis: [0, -1, 0]}
  P: {type: revolute, parent: coupler, at: [0.5, 0, 0], child: p, axis: [0, -1, 0], angle: 0.3}
closures:
  C: {type: spherical, a: coupler, a_at: [1, 0, 0], b: rocker, b_at: [0.8, 0, 0]}
frictions:
  fA: {joint: A, static_force: 40, kinetic_force: 40}
  fD: {joint: D, static_force: 40, kinetic_force: 40}
simulation: {duration: 2, sample_interval: 10 ms, step: 1 ms)",
                                     method);
    EXPECT_NEAR(GetChannel(run, "A").back(), M_PI / 3, 1e-8) << method;
    EXPECT_LT(CalcEnergyError(run), 1e-3) << method;
    double least = 0, largest = 0;
    for (double rate : GetChannel(run, "P.rate")) {
      least = std::min(least, rate);
      largest = std::max(largest, rate);
    }
    EXPECT_LT(least, -1) << method;
    EXPECT_GT(largest, 1) << method;
  }
}

// A block pushed inwards by P = 20 kN lifts a ram through a strut at the angle α, whose force S
// presses on the rail: N = W + S sin α, S cos α = P - μ N - m a. One solution, to which the
// iteration of N for itself does not come where μ tan α > 1.
TEST(FrictionGroups, NormalForcesThatDependOnTheFrictionAgreeWithIt) {
  const double g = 9.80665, P = 20000;
  for (double mu : {0.1, 0.4, 0.7}) {
    for (double alpha : {0.5, 1.05}) {
      const double x = std::cos(alpha), z = std::sin(alpha);
      const MechanismRun run = RunText(fmt::format(R"(kind: mechanism
bodies:
  block: {{mass: 1, inertia: [0.1, 0.1, 0.1]}}
  ram: {{mass: 100, inertia: [0.1, 0.1, 0.1]}}
joints:
  rail: {{type: prismatic, child: block, axis: [1, 0, 0], displacement: {:.17g}}}
  guide: {{type: prismatic, child: ram, axis: [0, 0, 1], displacement: {:.17g}}}
closures: {{strut: {{type: distance, a: block, b: ram}}}}
frictions: {{fr: {{joint: rail, from_joint: true, static_coefficient: {}, kinetic_coefficient: {}}}}}
forces: {{push: {{body: block, force: [-20000, 0, 0]}}}}
simulation: {{duration: 1 ms, sample_interval: 1 ms)",
                                                   x, z, mu, mu),
                                       "rk4");
      // x ẍ + z z̈ = 0 at rest: z̈ = -ẍ cot α; 100 (z̈ + g) = S sin α; ẍ = -P + S cos α + μ N
      const double c = x / z;
      // ẍ = -P + S x + μ (g + S z),  S = 100 (g - ẍ c)/z
      const double k = x + mu * z;
      const double a = (-P + mu * g + 100 * g / z * k) / (1 + 100 * c / z * k);
      ASSERT_LT(a, 0);
      EXPECT_NEAR(GetChannel(run, "rail.acceleration").front(), a, 1e-9 * std::abs(a))
          << mu << ' ' << alpha;
      const double S = 100 * (g - a * c) / z;
      EXPECT_NEAR(GetChannel(run, "fr.reaction").front(), mu * (g + S * z), 1e-9 * P);
    }
  }
}

// Two contacts of 10 N each press with 20 N, and torques do not press.
TEST(FrictionGroups, ContactsAddUpAndTorquesDoNotPress) {
  const MechanismRun run = RunText(R"(kind: mechanism
bodies: {b: {mass: 2, centre: [0, 0.4, 0], inertia: [0.1, 0.1, 0.1]}}
joints: {j: {type: free, child: b, velocity: [1, 0, 0, 0, 0, 0]}}
closures:
  rail: {type: prismatic, a: b, a_turned: [0, 90 deg, 0], b: world, b_turned: [0, 90 deg, 0]}
frictions:
  f: {joint: j, coordinate: 0, from_closures: [rail], static_coefficient: 0.1, kinetic_coefficient: 0.1}
simulation: {duration: 0.1, sample_interval: 10 ms)",
                                   "rk4");
  EXPECT_NEAR(GetChannel(run, "f.reaction").front(), -0.1 * 2 * 9.80665, 1e-9);
}

// A brake on a wheel without much inertia, sliding, must not make the equations look singular.
TEST(FrictionGroups, ATinyInertiaIsNotASingularPosition) {
  for (const char* inertia : {"1e-3", "1e-7"}) {
    const MechanismFile file = ReadMechanismText(std::string(R"(kind: mechanism
bodies: {w: {mass: 1, inertia: [INERTIA, 1, 1]}}
joints: {j: {type: revolute, child: w, axis: [1, 0, 0], angle_rate: 5}}
frictions: {f: {joint: j, static_force: 1e-9, kinetic_force: 1e-9}}
simulation: {duration: 1}
)")
                                                     .replace(48, 7, inertia),
                                                 "wheel.yaml");
    const Mechanism mechanism = MakeMechanism(file);
    mechanism::Evaluator evaluator(mechanism.system);
    std::vector<double> rate(mechanism.system.size());
    evaluator.UpdateModes(0, mechanism.start, 1e-9);
    evaluator.CalcRates(0, mechanism.start, rate);
    EXPECT_EQ(evaluator.modes()[0], 1);
    EXPECT_FALSE(evaluator.workspace().singular) << inertia;
  }
}

}  // namespace
}  // namespace kingpin::joints
