#include "joints/mechanism_trim.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "joints/mechanism_run.h"

namespace kingpin::joints {
namespace {

using testing::HasSubstr;

// Two bars of 0.5 m, 2 kg and 1 kg, on hinges about -y, so that positive angles lift.
const std::string kArm = R"(kind: mechanism
gravity: [0, 0, -9.81]
bodies:
  upper: {mass: 2, centre: [0.25, 0, 0], inertia: [0, 0.04, 0.04]}
  lower: {mass: 1, centre: [0.25, 0, 0], inertia: [0, 0.02, 0.02]}
joints:
  shoulder: {type: revolute, child: upper, axis: [0, -1, 0], angle: 0.2}
  elbow: {type: revolute, parent: upper, at: [0.5, 0, 0], child: lower, axis: [0, -1, 0]}
springs:
  hold: {joint: shoulder, stiffness: 100, free: 0.1}
  bend: {joint: elbow, stiffness: 40}
motors:
  drive: {joint: elbow}
equilibrium:
  vary:
    - {of: hold, quantity: preload}
    - {of: drive, quantity: force}
  targets:
    - {of: shoulder, value: 0.6}
    - {of: elbow, value: -0.3}
)";

std::string Replace(std::string text, const std::string& what, const std::string& with) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

TEST(Trim, TwoQuantitiesMeetTwoAngles) {
  MechanismFile file = ReadMechanismText(kArm, "arm.yaml");
  const std::vector<TrimmedQuantity> found = Trim(file);
  ASSERT_EQ(found.size(), 2);
  EXPECT_EQ(found[0].name, "hold.preload");
  EXPECT_EQ(found[1].name, "drive.force");
  // moments of the weights about the hinges
  const double about_elbow = 9.81 * 0.25 * std::cos(0.3);
  const double about_shoulder =
      9.81 * (2 * 0.25 * std::cos(0.6) + 0.5 * std::cos(0.6) + 0.25 * std::cos(0.3));
  // targets are met to 1e-8 (1 + size), stiffness 100 N m/rad
  EXPECT_NEAR(found[0].value, -(about_shoulder + 100 * (0.6 - 0.1)), 1e-5);
  EXPECT_NEAR(found[1].value, about_elbow + 40 * -0.3, 1e-5);
  const Mechanism mechanism = MakeMechanism(file);
  EXPECT_NEAR(mechanism.start[mechanism.GetJoint("shoulder").q], 0.6, 2e-8);
  const MechanismRun run = RunMechanism(ReadMechanismText(kArm, "arm.yaml"));
  EXPECT_NEAR(run.summary["equilibrium"]["drive.force"].get<double>(), found[1].value, 1e-9);
  EXPECT_NEAR(run.summary["end"]["elbow"].get<double>(), -0.3, 1e-6);
  EXPECT_EQ(CalcMechanismModes(ReadMechanismText(kArm, "arm.yaml")).json["equilibrium"].size(), 2);
}

TEST(Trim, AReactionIsATargetToo) {
  // the force on a distance rod, set by the free length of a spring on the same hinge
  MechanismFile file = ReadMechanismText(R"(kind: mechanism
gravity: [0, 0, -9.81]
bodies:
  bar: {mass: 2, centre: [0.5, 0, 0], inertia: [0, 0.1, 0.1]}
  block: {mass: 1, inertia: [0.1, 0.1, 0.1]}
joints:
  hinge: {type: revolute, child: bar, axis: [0, -1, 0], angle: 0.1}
  slide: {type: prismatic, child: block, axis: [0, 0, 1], at: [1, 0, 1]}
closures:
  rod: {type: distance, a: bar, a_at: [1, 0, 0], b: block}
springs:
  hold: {joint: hinge, stiffness: 200, free: 0}
  up: {joint: slide, stiffness: 3000, free: 0}
equilibrium:
  vary: [{of: up, quantity: free}]
  targets: [{of: rod.reaction, value: -25}]
)",
                                         "rod.yaml");
  Trim(file);
  const Mechanism mechanism = MakeMechanism(file);
  const MechanismModes modes = CalcMechanismModes(file);
  EXPECT_EQ(modes.json["modes"].size(), 1);
  const double angle = mechanism.start[mechanism.GetJoint("hinge").q];
  // the rod hangs nearly upright; its pull of 25 N lifts the bar against weight and spring
  EXPECT_NEAR(2 * 9.81 * 0.5 * std::cos(angle) + 200 * angle, 25, 0.6);
}

TEST(Trim, MissedTargetsAndMistakesAreNamed) {
  // a motor too weak to hold the elbow there
  try {
    RunMechanism(ReadMechanismText(
        Replace(kArm, "drive: {joint: elbow}", "drive: {joint: elbow, limit: 0.1}"), "arm.yaml"));
    ADD_FAILURE();
  } catch (const io::RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("equilibrium: the target -0.3 of 'elbow' is missed by"));
  }
  const std::tuple<const char*, const char*, const char*> mistakes[] = {
      {"of: hold, quantity: preload", "of: hlod, quantity: preload",
       "arm.yaml:16: equilibrium.vary[0].of: found 'hlod'"},
      {"of: hold, quantity: preload", "of: hold, quantity: force",
       "arm.yaml:16: equilibrium.vary[0].quantity: found 'force' of 'hold'"},
      {"of: hold, quantity: preload", "of: hold, quantity: stiffness",
       "arm.yaml:16: equilibrium.vary[0].quantity"},
      {"{of: shoulder, value: 0.6}", "{of: shuolder, value: 0.6}",
       "arm.yaml:19: equilibrium.targets[0].of: found 'shuolder'"},
      {"{of: shoulder, value: 0.6}", "{of: shoulder, value: 0.6 m}",
       "arm.yaml:19: equilibrium.targets[0].value"},
      {"    - {of: elbow, value: -0.3}\n", "",
       "equilibrium: found 2 quantities and 1 targets, expected as many quantities as targets"},
  };
  for (const auto& [what, with, message] : mistakes) {
    try {
      const MechanismFile file = ReadMechanismText(Replace(kArm, what, with), "arm.yaml");
      MechanismFile untrimmed = file;
      untrimmed.start_at_rest = false;
      CheckNames(file, MakeMechanism(untrimmed));
      ADD_FAILURE() << "accepted: " << with;
    } catch (const io::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message)) << with;
    }
  }
}

}  // namespace
}  // namespace kingpin::joints
