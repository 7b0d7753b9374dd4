#include "tests/apps/program.h"

// Mechanism files with every kind of mistake, through the verbs: each is named with file, line and
// key, nothing is written, and the exit status is 2.
namespace kingpin {
namespace {

using testing::HasSubstr;

const std::string kFourBar = R"(kind: mechanism
name: four-bar
bodies:
  crank:   {mass: 1 kg, centre: [0.15, 0, 0], inertia: [0, 0.01, 0.01]}
  coupler: {mass: 2 kg, centre: [0.5, 0, 0], inertia: [0, 0.2, 0.2]}
  rocker:  {mass: 1.5 kg, centre: [0.4, 0, 0], inertia: [0, 0.1, 0.1]}
joints:
  A: {type: revolute, child: crank, axis: [0, -1, 0], angle: 60 deg, angle_rate: 5 rad/s}
  B: {type: revolute, parent: crank, at: [0.3, 0, 0], child: coupler, axis: [0, -1, 0]}
  D: {type: revolute, at: [0.9, 0, 0], child: rocker, axis: [0, -1, 0]}
closures:
  C: {type: spherical, a: coupler, a_at: [1, 0, 0], b: rocker, b_at: [0.8, 0, 0]}
simulation: {method: rosenbrock, step: 1 ms, duration: 10 ms, sample_interval: 1 ms}
)";

TEST_F(Program, MechanismsNameFileLineAndKey) {
  Write("m.yaml", kFourBar);
  ASSERT_EQ(Run("check m.yaml").status, 0);
  ASSERT_EQ(Run("simulate m.yaml -o good --quiet").status, 0);
  const std::vector<std::array<std::string, 3>> cases = {
      // topology
      {"  D: {", "  E: {type: fixed, child: rocker}\n  D: {",
       "m.yaml:11: joints.D.child: found 'rocker', which joint 'E' carries already"},
      {"parent: crank,", "parent: coupler,",
       "m.yaml:9: joints.B: found a cycle of joints (coupler -> coupler)"},
      {"child: crank,", "parent: coupler, child: crank,",
       "m.yaml:8: joints.A: found a cycle of joints (crank -> coupler -> crank)"},
      {"  A: {type: revolute,", "  A: {type: revolute, at: [0, 0],",
       "m.yaml:8: joints.A.at: found 2 numbers, expected 3"},
      {"  D: {type: revolute, at: [0.9, 0, 0], child: rocker, axis: [0, -1, 0]}\n", "",
       "m.yaml:6: bodies.rocker: found a body that no joint carries"},
      {"child: rocker, ", "", "m.yaml:10: joints.D.child: found nothing"},
      // names
      {"b: rocker", "b: rockr",
       "m.yaml:12: closures.C.b: found 'rockr', expected the name of a "
       "body; did you mean 'rocker'?"},
      {"parent: crank", "parent: cranck", "m.yaml:9: joints.B.parent: found 'cranck'"},
      {"type: revolute, parent", "type: revolut, parent",
       "m.yaml:9: joints.B.type: found 'revolut'"},
      {"  rocker: ", "  rocker: {mass: 1 kg, inertia: [1, 1, 1]}\n  rocker: ",
       "m.yaml:7: bodies.rocker: found the key a second time"},
      // masses
      {"mass: 2 kg", "mass: -2 kg", "m.yaml:5: bodies.coupler.mass: found '-2 kg'"},
      {"mass: 2 kg", "mass: .nan", "m.yaml:5: bodies.coupler.mass: found '.nan'"},
      {"mass: 2 kg", "mass: 1e999", "m.yaml:5: bodies.coupler.mass"},
      {"[0, 0.2, 0.2]", "[0, 0.2, 0.3]",
       "m.yaml:5: bodies.coupler.inertia: found principal moments 0, 0.2, 0.3 kg m^2"},
      {"[0, 0.2, 0.2]", "[0, -0.2, 0.2]", "m.yaml:5: bodies.coupler.inertia"},
      // directions and places
      {"rocker, axis: [0, -1, 0]", "rocker, axis: [0, 0, 0]",
       "m.yaml:10: joints.D.axis: found (0, 0, 0) of length 0"},
      {"rocker, axis: [0, -1, 0]", "rocker, axis: [0, -1, 0.1]", "m.yaml:10: joints.D.axis"},
      {"rocker, axis: [0, -1, 0]", "rocker, axis: [0, .nan, 0]", "m.yaml:10: joints.D.axis[1]"},
      {"at: [0.9, 0, 0]", "at: [.inf, 0, 0]", "m.yaml:10: joints.D.at[0]: found '.inf'"},
      {"angle: 60 deg", "angle: .nan", "m.yaml:8: joints.A.angle: found '.nan'"},
      {"kind: mechanism", "kind: mechanism\ngravity: [0, 0, .nan]",
       "m.yaml:2: gravity[2]: found '.nan'"},
      {"closures:",
       "couplings:\n  gear: {terms: [{joint: A}, {joint: B, factor: 2}, {joint: A, factor: 3}]}\n"
       "closures:",
       "couplings.gear.terms: found coordinate 0 of joint 'A' twice, expected each coordinate "
       "once"},
      {"closures:", "couplings:\n  gear: {terms: [{joint: A}, {joint: B, factor: 0}]}\nclosures:",
       "m.yaml:12: couplings.gear.terms[1].factor: found 0, expected a factor that couples"},
      {"closures:", "frictions:\n  pad: {joint: A}\nclosures:",
       "m.yaml:12: frictions.pad: found dry friction whose limits are all 0, expected static_force "
       "and kinetic_force, or"},
      {"closures:", "frictions:\n  pad: {joint: A, static_coefficient: 0.1}\nclosures:",
       "m.yaml:12: frictions.pad: found coefficients without a normal force, expected preload, "},
      {"closures:", "  S: {type: spherical, child: ball, axis: [0, 0, 1]}\nclosures:",
       "m.yaml:11: joints.S.axis: found a key that a joint of this type does not have, expected it "
       "with joints that have an axis only"},
      {"child: crank, axis: [0, -1, 0],", "child: crank, axis: [0, -1, 0], pitch: 1 mm/rad,",
       "m.yaml:8: joints.A.pitch: found a key that a joint of this type does not have"},
      {"child: crank, axis: [0, -1, 0],", "child: crank, second_axis: [0, -1, 0],",
       "m.yaml:8: joints.A.second_axis: found a key that a joint"},
      {"sample_interval: 1 ms", "sample_interval: 9.9e-10",
       "m.yaml:13: simulation.sample_interval: found 9.9e-10 s, expected at least 1e-09 s: no more "
       "than 1e+07 samples of a run of 0.01 s"},
      {"name: four-bar", "name: four-b\xE4r",
       "m.yaml:2: found the byte 0xE4, which is no UTF-8, expected a text file in UTF-8"},
      // what cannot be assembled
      {"b_at: [0.8, 0, 0]", "b_at: [5, 0, 0]", "m.yaml:12: C."},
      {"closures:",
       "closures:\n"
       "  rod 1: {type: distance, a: crank, a_at: [0.3, 0, 0], b: rocker, length: 0.9}\n"
       "  rod 2: {type: distance, a: crank, a_at: [0.3, 0, 0], b: rocker, length: 0.7}",
       "rod 1: found a gap of 0.11"},
      {"closures:",
       "motions:\n  turn: {joint: A, start: 1.0471975511965976}\n  back: {joint: A, start: "
       "1.0471975511965976, rate: 2}\nclosures:",
       "back"},
  };
  for (const auto& [before, after, message] : cases) {
    std::string text = kFourBar;
    const size_t at = text.find(before);
    ASSERT_NE(at, std::string::npos) << before;
    Write("m.yaml", text.replace(at, before.size(), after));
    for (const char* verb : {"check m.yaml", "simulate m.yaml -o out", "modes m.yaml -o out"}) {
      const Outcome outcome = Run(verb);
      EXPECT_EQ(outcome.status, 2) << verb << ": " << after;
      EXPECT_THAT(outcome.errors, testing::StartsWith("kingpin: m.yaml:")) << verb << ": " << after;
      EXPECT_THAT(outcome.errors, HasSubstr(message)) << verb << ": " << after;
      EXPECT_FALSE(fs::exists(folder_ / "out")) << verb << ": " << after;
    }
  }
}

// Wherever the file ends, it is read whole or refused with its line; it never crashes or hangs.
TEST_F(Program, TruncatedMechanismsAreRefused) {
  int refused = 0;
  const size_t complete = kFourBar.find("simulation:");
  for (size_t length = 0; length < kFourBar.size(); length += 37) {
    Write("m.yaml", kFourBar.substr(0, length));
    const Outcome outcome = Run("check m.yaml");
    ASSERT_TRUE(outcome.status == 0 || outcome.status == 2) << length;
    if (outcome.status == 2) {
      ++refused;
      EXPECT_THAT(outcome.errors, testing::StartsWith("kingpin: m.yaml")) << length;
    } else {
      EXPECT_GT(length, kFourBar.find("closures:") - 1) << length;
    }
  }
  EXPECT_GE(refused, static_cast<int>(complete / 37) - 3);
}

}  // namespace
}  // namespace kingpin
