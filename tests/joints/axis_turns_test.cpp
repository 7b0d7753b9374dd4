#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "joints/mechanism_file.h"
#include "joints/mechanism_run.h"

namespace kingpin::joints {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

// A column of two parts, the lower one turned against the upper one's frame, each on a joint about
// the axis; the spring between the world and the lower part is on the axis.
std::string MakeColumn(const std::string& springs, const std::string& rest) {
  return fmt::format(R"(kind: mechanism
gravity: [0, 0, 0]
bodies:
  upper: {{mass: 1, inertia: [0.1, 0.1, 0.1]}}
  slide: {{mass: 1, inertia: [0.1, 0.1, 0.1]}}
  lower: {{mass: 1, inertia: [0.1, 0.1, 0.1]}}
joints:
  one: {{type: revolute, child: upper, angle: 150 deg}}
  along: {{type: prismatic, parent: upper, child: slide, axis: [0, 0, 1]}}
  two: {{type: revolute, parent: slide, child: lower, axis: [0, 0, -1], angle: -50 deg}}
springs:
  centre: {{{}}}
  hold: {{joint: two, stiffness: 100, free: -0.8726646259971648}}
  fix: {{joint: along, stiffness: 100}}
simulation: {{duration: 1 s, method: explicit8, {}}}
)",
                     springs, rest);
}

double FindRestOfColumn(const std::string& springs) {
  const Mechanism mechanism =
      MakeMechanism(ReadMechanismText(MakeColumn(springs, "start_at_rest: true"), "column.yaml"));
  return mechanism.start[mechanism.GetJoint("one").q] -
         mechanism.start[mechanism.GetJoint("two").q];
}

std::string FindFailure(const std::string& text) {
  try {
    return RunMechanism(ReadMechanismText(text, "turns.yaml")).failure;
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(AxisTurns, ASpringOfAColumnCountsThemByItsJoints) {
  // at 200 degrees it goes back by 200, not on to 360
  EXPECT_NEAR(FindRestOfColumn("a: world, b: lower, between: axis, stiffness: 10"), 0, 1e-9);
  // from the other side, and with a frame that is turned
  EXPECT_NEAR(FindRestOfColumn("a: lower, b: world, between: axis, stiffness: 10"), 0, 1e-9);
  EXPECT_NEAR(FindRestOfColumn("a: world, b: lower, b_turned: [0, 0, 30 deg], between: axis, "
                               "stiffness: 10"),
              -kPi / 6, 1e-9);
}

TEST(AxisTurns, AColumnSwingsThroughHalfATurnWithItsEnergy) {
  const MechanismRun run = RunMechanism(ReadMechanismText(
      MakeColumn("a: world, b: lower, between: axis, stiffness: 10", "start_at_rest: false"),
      "column.yaml"));
  EXPECT_LT(run.summary["energy"]["largest_error"].get<double>(), 1e-6);
}

TEST(AxisTurns, WhereNoJointCountsThemTheRunEndsWithNameAndTime) {
  const char* text = R"(kind: mechanism
gravity: [0, 0, 0]
bodies: {{wheel: {{mass: 1, inertia: [0.1, 0.1, 0.1]}}}}
joints: {{ball: {{type: spherical, child: wheel, velocity: [0, 0, 4]}}}}
{}
simulation: {{duration: 2 s, method: explicit8}}
)";
  const std::string spring =
      "springs: {centre: {a: world, b: wheel, between: axis, stiffness: 0.05}}";
  EXPECT_THAT(FindFailure(fmt::format(fmt::runtime(text), spring)),
              HasSubstr("'centre' passes half a turn at t = 0.8"));
  const std::string bushing =
      "bushings: {mount: {a: world, b: wheel, turning_stiffness: [0.05, 0.05, 0.05]}}";
  EXPECT_THAT(FindFailure(fmt::format(fmt::runtime(text), bushing)),
              HasSubstr("'mount' passes half a turn at t = 0.8"));
  // what does not follow the angle may turn
  const std::string damper = "springs: {drag: {a: world, b: wheel, between: axis, damping: 0.001}}";
  EXPECT_EQ(FindFailure(fmt::format(fmt::runtime(text), damper)), "");
}

}  // namespace
}  // namespace kingpin::joints
