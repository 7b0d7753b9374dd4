#include "core/solve/linearise.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/math/quaternion.h"
#include "core/mechanism/evaluator.h"
#include "core/solve/equilibrium.h"
#include "tests/joints/example_mechanisms.h"

namespace kingpin::joints {
namespace {

BodyDescription MakeBody(const std::string& name, double mass, const Vector3<double>& centre,
                         const std::array<double, 6>& inertia) {
  BodyDescription body;
  body.name = name;
  body.mass = mass;
  body.centre = centre;
  body.central_inertia = inertia;
  return body;
}

// The benchmark bicycle of Meijaard, Papadopoulos, Ruina and Schwab (Proc. R. Soc. A 463, 2007),
// table 1, its axes (z down) turned to ours (z up): products of inertia change sign. Every body
// frame lies at the rear contact.
MechanismDescription MakeBicycle(double speed) {
  const double w = 1.02, c = 0.08, rR = 0.3, rF = 0.35, tilt = std::numbers::pi / 10;
  MechanismDescription d;
  d.name = "bicycle";
  d.gravity = {0, 0, -9.81};
  d.bodies = {MakeBody("frame", 85, {0.3, 0, 0.9}, {9.2, 11, 2.8, 0, -2.4, 0}),
              MakeBody("rear wheel", 2, {0, 0, rR}, {0.0603, 0.12, 0.0603, 0, 0, 0}),
              MakeBody("fork", 4, {0.9, 0, 0.7}, {0.05892, 0.06, 0.00708, 0, 0.00756, 0}),
              MakeBody("front wheel", 3, {w, 0, rF}, {0.1405, 0.28, 0.1405, 0, 0, 0})};
  const auto joint = [](const std::string& name, JointType type, const std::string& parent,
                        const Vector3<double>& at, const std::string& child,
                        const Vector3<double>& axis) {
    JointDescription j = MakeJoint(name, type, parent, at, child, axis);
    j.child.X_BF.p = at;
    return j;
  };
  d.joints = {
      joint("base", JointType::kFree, "world", {0, 0, 0}, "frame", {0, 0, 1}),
      joint("rear axle", JointType::kRevolute, "frame", {0, 0, rR}, "rear wheel", {0, 1, 0}),
      joint("head", JointType::kRevolute, "frame", {w + c, 0, 0}, "fork",
            {-std::sin(tilt), 0, std::cos(tilt)}),
      joint("front axle", JointType::kRevolute, "fork", {w, 0, rF}, "front wheel", {0, 1, 0})};
  d.joints[0].velocity = {speed, 0, 0, 0, 0, 0};
  d.joints[1].velocity = {speed / rR};
  d.joints[3].velocity = {speed / rF};
  const Rotation<double> axis_along_y = math::MakeRotationWithZ(Vector3<double>{0, 1, 0});
  for (const auto& [name, wheel, x, r] :
       {std::tuple{"rear", "rear wheel", 0.0, rR}, std::tuple{"front", "front wheel", w, rF}}) {
    ClosureDescription disc;
    disc.name = name;
    disc.type = ClosureType::kRollingDisc;
    disc.a = {wheel, {axis_along_y, {x, 0, r}}};
    disc.b = {kWorld, {}};
    disc.radius = r;
    d.closures.push_back(disc);
  }
  return d;
}

TEST(Linearise, TheBicycleHasThePublishedEigenvalues) {
  const Mechanism bicycle = MakeMechanism(MakeBicycle(5));
  const solve::Linearisation linear = solve::Linearise(bicycle.system, 0, bicycle.start);
  EXPECT_EQ(linear.positions, 7);
  EXPECT_EQ(linear.velocities, 3);
  const Eigen::VectorXcd eigenvalues = linear.A.eigenvalues();
  // table 2 of the paper, 5 m/s: castering, capsize, weave
  const std::complex<double> published[] = {-14.07838969279822,
                                            -0.32286642900409,
                                            {-0.77534188219585, 4.46486771378823},
                                            {-0.77534188219585, -4.46486771378823}};
  for (const std::complex<double>& wanted : published) {
    double nearest = 1e9;
    for (const auto& found : eigenvalues) nearest = std::min(nearest, std::abs(found - wanted));
    EXPECT_LT(nearest, 1e-9) << wanted;
  }
}

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
