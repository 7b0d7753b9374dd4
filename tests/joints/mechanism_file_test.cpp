#include "joints/mechanism_file.h"

#include <array>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "joints/mechanism_run.h"

namespace kingpin::joints {
namespace {

using testing::HasSubstr;

const std::string kPendulum = R"(kind: mechanism
name: pendulum
gravity: [0, 0, -9.81]
bodies:
  rod: {mass: 3 kg, centre: [500 mm, 0 mm, 0 mm], inertia: [0, 0.25, 0.25]}
joints:
  hinge: {type: revolute, child: rod, axis: [0, 1, 0], angle: 80 deg}
simulation: {method: explicit8, duration: 1 s, sample_interval: 10 ms}
)";

TEST(MechanismFile, AFileIsWhatTheBuilderWouldMake) {
  const MechanismFile file = ReadMechanismText(kPendulum, "pendulum.yaml");
  const Mechanism mechanism = MakeMechanism(file);
  ASSERT_EQ(mechanism.system.model.velocities, 1);
  EXPECT_DOUBLE_EQ(mechanism.system.model.links[1].mass, 3);
  EXPECT_NEAR(mechanism.start[0], 80 * M_PI / 180, 1e-15);
  const MechanismRun run = RunMechanism(file);
  EXPECT_EQ(run.signals.time.size(), 101);
  EXPECT_EQ(run.signals.channels[0].name, "hinge");
  EXPECT_EQ(run.summary["degrees_of_freedom"], 1);
  EXPECT_LT(run.summary["energy"]["largest_error"].get<double>(), 1e-6);
  const MechanismModes modes = CalcMechanismModes(file);
  EXPECT_EQ(modes.json["modes"].size(), 1);
}

TEST(MechanismFile, ADrivenMechanismHasNoModes) {
  const MechanismModes modes = CalcMechanismModes(ReadMechanismText(
      kPendulum + "motions:\n  drive: {joint: hinge, start: 1.3962634015954636}\n", "p.yaml"));
  EXPECT_TRUE(modes.json["modes"].empty());
}

// A closed loop in a plane, with the crank's axes turned there and back by 90 degrees: 6e-17 of a
// gradient is left of the row across the plane.
TEST(MechanismFile, ARowWhoseGradientIsRoundingIsRedundant) {
  const MechanismRun run = RunMechanism(ReadMechanismText(R"(kind: mechanism
bodies:
  disc: {mass: 1, inertia: [0.01, 0.01, 0.01]}
  crank: {mass: 1, inertia: [0.01, 0.01, 0.01]}
  rod: {mass: 1, centre: [0.15, 0, 0], inertia: [1e-4, 0.01, 0.01]}
  slider: {mass: 2, inertia: [0.01, 0.01, 0.01]}
joints:
  main: {type: revolute, turned: [0, 0, 90 deg], child: disc, axis: [1, 0, 0], angle_rate: 10 rad/s}
  clamp: {type: fixed, parent: disc, turned: [0, 0, -90 deg], child: crank}
  pin: {type: revolute, parent: crank, at: [0.08, 0, 0], child: rod, axis: [0, 1, 0]}
  guide: {type: prismatic, child: slider, axis: [1, 0, 0], displacement: 0.38}
closures:
  wrist: {type: spherical, a: rod, a_at: [0.3, 0, 0], b: slider}
simulation: {method: explicit8, duration: 0.5 s}
)",
                                                          "loop.yaml"));
  EXPECT_EQ(run.summary["redundant_rows"], nlohmann::ordered_json::array({"wrist.y"}));
  EXPECT_EQ(run.summary["degrees_of_freedom"], 1);
  EXPECT_LT(run.summary["energy"]["largest_error"].get<double>(), 1e-6);
}

struct Mistake {
  const char *text, *with, *message;
};

TEST(MechanismFile, MistakesAreNamedWithFileLineAndKey) {
  const Mistake mistakes[] = {
      {"mass: 3 kg", "mass: -3 kg", "pendulum.yaml:5: bodies.rod.mass"},
      {"mass: 3 kg", "mass: 3 m", "pendulum.yaml:5: bodies.rod.mass"},
      {"mass: 3 kg", "mass: .nan", "pendulum.yaml:5"},
      {"mass: 3 kg", "maas: 3 kg", "did you mean 'mass'"},
      {"[0, 0.25, 0.25]", "[0, 0.25, 0.75]", "none larger than the sum of the other two"},
      {"[0, 0.25, 0.25]", "[0, 0.25, 0.75]", "pendulum.yaml:5: bodies.rod.inertia"},
      {"axis: [0, 1, 0]", "axis: [0, 1, 1]",
       "pendulum.yaml:7: joints.hinge.axis: found (0, 1, 1) of length 1.41421"},
      {"child: rod", "child: rood", "did you mean 'rod'"},
      {"type: revolute", "type: hinge", "pendulum.yaml:7: joints.hinge.type"},
      {"angle: 80 deg", "displacement: 1 m", "pendulum.yaml:7: joints.hinge.displacement"},
      {"joints:\n  hinge: {", "joints:\n  again: {type: free, child: rod}\n  hinge: {",
       "which joint '"},
      {"joints:\n  hinge: {type: revolute,", "joints:\n  hinge: {type: revolute, parent: rod,",
       "a cycle of joints"},
  };
  for (const Mistake& m : mistakes) {
    std::string text = kPendulum;
    const size_t at = text.find(m.text);
    ASSERT_NE(at, std::string::npos) << m.text;
    text.replace(at, std::string(m.text).size(), m.with);
    try {
      MakeMechanism(ReadMechanismText(text, "pendulum.yaml"));
      ADD_FAILURE() << "accepted: " << m.with;
    } catch (const io::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(m.message)) << m.with;
    }
  }
}

TEST(MechanismFile, ADistanceIsThatOfTheStartWhateverClosuresStandBeforeIt) {
  const Mechanism mechanism = MakeMechanism(ReadMechanismText(R"(kind: mechanism
bodies:
  a: {mass: 1 kg, inertia: [0.1, 0.1, 0.1]}
  b: {mass: 1 kg, inertia: [0.1, 0.1, 0.1]}
joints:
  A: {type: free, child: a}
  B: {type: free, child: b, at: [1, 0, 0]}
closures:
  C: {type: spherical, a: a, a_at: [1, 0, 0], b: b}
  D: {type: distance, a: a, b: world, b_at: [0, 3, 4]}
)",
                                                              "two.yaml"));
  ASSERT_EQ(mechanism.system.model.distances.size(), 1);
  EXPECT_DOUBLE_EQ(mechanism.system.model.distances[0].length, 5);
}

// Two gears, and a rack on the second: torque between angles, force where a displacement takes
// part.
TEST(MechanismFile, ReactionsOfCouplingsHaveTheirUnits) {
  const MechanismRun run = RunMechanism(ReadMechanismText(R"(kind: mechanism
bodies:
  pinion: {mass: 1 kg, inertia: [0.01, 0.01, 0.01]}
  wheel: {mass: 1 kg, inertia: [0.02, 0.02, 0.02]}
  rack: {mass: 2 kg, inertia: [0.02, 0.02, 0.02]}
joints:
  A: {type: revolute, child: pinion, axis: [0, 0, 1]}
  B: {type: revolute, child: wheel, axis: [0, 0, 1]}
  C: {type: prismatic, child: rack, axis: [1, 0, 0]}
couplings:
  gear: {terms: [{joint: A, factor: 2}, {joint: B, factor: 1}]}
  mesh: {terms: [{joint: B, factor: 0.05}, {joint: C, factor: -1}]}
motors:
  motor: {joint: A, force: 3}
simulation: {duration: 10 ms, sample_interval: 1 ms}
)",
                                                          "gears.yaml"));
  // 3 N m on A, which B follows at -2, C at -0.1: inertia 0.01 + 4 0.02 + 0.01 2 = 0.11 kg m^2
  const double a = 3 / 0.11;
  const auto expect = [&](const std::string& name, const std::string& unit, double value) {
    for (const auto& channel : run.signals.channels) {
      if (channel.name != name) continue;
      EXPECT_EQ(channel.unit, unit) << name;
      EXPECT_NEAR(channel.values.front(), value, 1e-9) << name;
      return;
    }
    ADD_FAILURE() << name;
  };
  expect("A.acceleration", "rad/s^2", a);
  expect("C.acceleration", "m/s^2", -0.1 * a);
  expect("gear.reaction", "N m", (0.01 * a - 3) / 2);
  expect("mesh.reaction", "N", 2 * 0.1 * a);
}

// A bar of 1 kg clamped at its end, its centre 1 m along x or y: the clamp bears 10 N and 10 N m.
TEST(MechanismFile, TurnReactionsAreTorquesAboutTheirAxes) {
  for (const auto& [centre, torque] :
       {std::pair{"[1, 0, 0]", std::array{0.0, -10.0, 0.0}}, {"[0, 1, 0]", {10.0, 0.0, 0.0}}}) {
    for (const char* type : {"fixed", "revolute"}) {
      const bool fixed = std::string(type) == "fixed";
      const MechanismRun run = RunMechanism(ReadMechanismText(fmt::format(R"(kind: mechanism
gravity: [0, 0, -10]
bodies: {{bar: {{mass: 1, centre: {}, inertia: [0.1, 0.1, 0.1]}}}}
joints: {{f: {{type: free, child: bar}}}}
closures: {{clamp: {{type: {}, a: bar}}}}
simulation: {{duration: 1 ms, sample_interval: 1 ms}}
)",
                                                                          centre, type),
                                                              "bar.yaml"));
      const auto expect = [&run, &type, at = centre](const char* row, double value) {
        for (const io::Signals::Channel& channel : run.signals.channels) {
          if (channel.name != std::string("clamp.") + row + ".reaction") continue;
          EXPECT_NEAR(channel.values.front(), value, 1e-12) << row << ' ' << at << ' ' << type;
          return;
        }
        ADD_FAILURE() << row;
      };
      expect("z", 10);
      expect("turn_x", torque[0]);
      expect("turn_y", torque[1]);
      if (fixed) expect("turn_z", torque[2]);
    }
  }
}

std::string GetError(const std::string& text) {
  try {
    MakeMechanism(ReadMechanismText("kind: mechanism\n" + text, "m.yaml"));
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(MechanismFile, StartsThatCannotBeMeantAreErrors) {
  const std::string body = "bodies: {b: {mass: 1, inertia: [0.1, 0.1, 0.1]}}\n";
  for (const char* type : {"fixed", "prismatic"}) {
    const std::string error = GetError(
        body +
        "joints: {j: {type: free, child: b, position: [0, 0, 0, 0.4, 0.9165151389911680, 0, "
        "0]}}\nclosures: {weld: {type: " +
        type + ", a: b}}\n");
    EXPECT_THAT(error,
                HasSubstr("m.yaml:4: closures.weld: found frames a and b half a turn apart"));
  }
  EXPECT_EQ(GetError(body + "joints: {j: {type: free, child: b, position: [0, 0, 0, 0.96, 0.28, 0, "
                            "0]}}\nclosures: {weld: {type: fixed, a: b}}\n"),
            "none");
  for (const char* quaternion : {"0, 0, 0, 0", "2, 0, 0, 0"}) {
    EXPECT_THAT(
        GetError(body + "joints: {j: {type: spherical, child: b, position: [" + quaternion +
                 "]}}\n"),
        HasSubstr("m.yaml:3: joints.j.position: found a quaternion (w, x, y, z) of length"));
  }
  const std::string hinge =
      body + "joints: {j: {type: revolute, child: b, axis: [0, 1, 0], angle: 60 deg}}\n";
  EXPECT_THAT(GetError(hinge + "motions: {m: {joint: j, rate: 5}}\n"),
              HasSubstr("m.yaml:4: motions.m: found a motion that starts at 0, expected 1.0472"));
  EXPECT_EQ(GetError(hinge + "motions: {m: {joint: j, start: 1.0471975511965976, rate: 5}}\n"),
            "none");
}

TEST(MechanismFile, TheExamplesRunAndKeepTheirBooks) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(KINGPIN_SOURCE_DIR "/examples/mechanisms")) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    MechanismFile file = ReadMechanismFile(entry.path());
    file.simulation.duration = std::min(file.simulation.duration, 1.0);
    const MechanismRun run = RunMechanism(file);
    EXPECT_LE(run.summary["largest_residual"]["position"].get<double>(), 1e-9) << entry.path();
    const auto& energy = run.summary["energy"];
    EXPECT_LE(energy["largest_error"].get<double>(),
              1e-4 * std::max(energy["largest_kinetic"].get<double>(), 0.01))
        << entry.path();
  }
  EXPECT_GE(count, 3);
}

}  // namespace
}  // namespace kingpin::joints
