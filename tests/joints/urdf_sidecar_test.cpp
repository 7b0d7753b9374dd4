// Mechanism files that begin with a URDF file.
#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/io/error.h"
#include "core/mechanism/evaluator.h"
#include "core/mechanism/project.h"
#include "joints/mechanism_file.h"
#include "joints/mechanism_run.h"

namespace kingpin::joints {
namespace {

using testing::HasSubstr;

const std::string kUrdf = R"(<robot name="crane">
  <link name="mast"><inertial><mass value="5"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.02"/></inertial></link>
  <link name="boom"><inertial><origin xyz="0.4 0 0.05"/><mass value="2"/><inertia ixx="0.02" ixy="0.002" ixz="-0.001" iyy="0.2" iyz="0.003" izz="0.21"/></inertial></link>
  <link name="jib"><inertial><origin xyz="0.2 0 0"/><mass value="1"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial></link>
  <joint name="lift" type="revolute">
    <parent link="mast"/><child link="boom"/><origin xyz="0 0 1" rpy="0 0 0.3"/><axis xyz="0 -1 0"/>
    <limit lower="-1" upper="1" effort="100" velocity="1"/><dynamics damping="0.7"/>
  </joint>
  <joint name="reach" type="prismatic">
    <parent link="boom"/><child link="jib"/><origin xyz="0.5 0 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" effort="100" velocity="1"/><dynamics friction="3"/>
  </joint>
</robot>
)";

// Forces and constraints on both, by the same names.
const std::string kFurther = R"(springs:
  cable: {a: mast, a_at: [0, 0, 2], b: jib, b_at: [0.3, 0, 0], stiffness: 900, free: 0.8, damping: 4}
  return: {joint: reach, stiffness: 300, free: 0.1}
motors:
  hoist: {joint: lift, target: 0.4, proportional: 50, derivative: 2}
closures:
  guide: {type: point_on_plane, a: jib, a_at: [0.6, 0, 0], b_at: [1, 0.4, 1.5], b_turned: [0.1, 0.5, 0]}
)";

// The same mechanism without URDF.
const std::string kByHand = R"(kind: mechanism
bodies:
  boom: {mass: 2, centre: [0.4, 0, 0.05], inertia: [0.02, 0.2, 0.21], products: [0.002, -0.001, 0.003]}
  jib: {mass: 1, centre: [0.2, 0, 0], inertia: [0.001, 0.02, 0.02]}
  mast: {mass: 5, inertia: [0.1, 0.1, 0.02]}
joints:
  fixed_base: {type: BASE, child: mast}
  lift: {type: revolute, parent: mast, at: [0, 0, 1], turned: [0, 0, 0.3], child: boom, axis: [0, -1, 0], child_turned: [0, 0, 0], angle: 0.3, angle_rate: 0.5}
  reach: {type: prismatic, parent: boom, at: [0.5, 0, 0], child: jib, axis: [1, 0, 0], displacement: 0.2}
frictions:
  reach.friction: {joint: reach, static_force: 3, kinetic_force: 3}
)";
const std::string kDamper = "  lift.damping: {joint: lift, damping: 0.7}\n";

class UrdfSidecar : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("kingpin_sidecar_" + std::to_string(getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    Write("crane.urdf", kUrdf);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  Mechanism Make(const std::string& text) const {
    return MakeMechanism(ReadMechanismFile(Write("crane.yaml", text)));
  }

  std::filesystem::path folder_;
};

void ExpectSameAccelerations(const Mechanism& a, const Mechanism& b) {
  ASSERT_EQ(a.system.size(), b.system.size());
  ASSERT_EQ(a.system.model.row_names, b.system.model.row_names);
  mechanism::Evaluator left(a.system), right(b.system);
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> uniform(-0.3, 0.3);
  for (int k = 0; k < 20; ++k) {
    std::vector<double> y = a.start, rate_a(y.size()), rate_b(y.size());
    for (double& value : y) value += uniform(random);
    mechanism::NormaliseQuaternions(a.system.model,
                                    {y.data(), static_cast<size_t>(a.system.model.positions)});
    left.Project(0, y, 1e-12, 0);
    left.UpdateModes(0, y, 1e-9);
    right.UpdateModes(0, y, 1e-9);
    left.CalcRates(0, y, rate_a);
    right.CalcRates(0, y, rate_b);
    for (size_t i = 0; i < y.size(); ++i) {
      // the pose of the joint frame comes by quaternions of rpy here, of a rotation vector there
      EXPECT_NEAR(rate_a[i], rate_b[i], 1e-11 * (1 + std::abs(rate_a[i]))) << i;
    }
    for (size_t r = 0; r < left.reactions().size(); ++r) {
      EXPECT_NEAR(left.reactions()[r], right.reactions()[r], 1e-10 * 100) << r;
    }
  }
}

std::string Replace(std::string text, const std::string& what, const std::string& with) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

const std::string kHead = "kind: mechanism\nurdf: crane.urdf\n";
const std::string kStart =
    "start:\n  lift: {angle: 0.3, angle_rate: 0.5}\n  reach: {displacement: 0.2}\n";

TEST_F(UrdfSidecar, HasTheAccelerationsOfTheSameMechanismByHand) {
  const Mechanism sidecar = Make(kHead + kStart + kFurther);
  const Mechanism by_hand = Make(Replace(kByHand, "BASE", "fixed") +
                                 Replace(kFurther, "springs:\n", "springs:\n" + kDamper));
  EXPECT_NEAR(sidecar.start[0], by_hand.start[0], 1e-12);
  ExpectSameAccelerations(sidecar, by_hand);
}

TEST_F(UrdfSidecar, StandsOnAFreeBaseIfAsked) {
  const Mechanism sidecar = Make(kHead + "root: free\n" + kStart + kFurther);
  const Mechanism by_hand =
      Make(Replace(Replace(kByHand, "fixed_base", "floating_base"), "BASE", "free") +
           Replace(kFurther, "springs:\n", "springs:\n" + kDamper));
  EXPECT_EQ(sidecar.GetJoint("floating_base").velocities, 6);
  ExpectSameAccelerations(sidecar, by_hand);
}

TEST_F(UrdfSidecar, DampingAndFrictionOfTheUrdfActUnlessSwitchedOff) {
  const MechanismFile with = ReadMechanismFile(Write("a.yaml", kHead));
  EXPECT_EQ(with.forces.size(), 1);
  EXPECT_EQ(with.description.frictions.size(), 1);
  const MechanismFile without =
      ReadMechanismFile(Write("b.yaml", kHead + "urdf_dynamics: false\n"));
  EXPECT_TRUE(without.forces.empty());
  EXPECT_TRUE(without.description.frictions.empty());
}

TEST_F(UrdfSidecar, TheUrdfFileIsAnInputOfTheRun) {
  io::InputRecord record;
  ReadMechanismFile(Write("crane.yaml", kHead), {}, &record);
  ASSERT_EQ(record.files.size(), 2);
  EXPECT_EQ(record.files[1].filename(), "crane.urdf");
}

TEST_F(UrdfSidecar, MistakesAreNamedWithFileLineAndKey) {
  Write("torn.urdf", kUrdf.substr(0, 900));
  const std::string text = kHead + kStart + kFurther;
  const std::tuple<const char*, const char*, const char*> mistakes[] = {
      {"crane.urdf", "cranee.urdf", "crane.yaml:2: urdf: found "},
      {"crane.urdf", "torn.urdf", "torn.urdf:"},
      {"crane.urdf\n", "crane.urdf\nroot: floating\n", "crane.yaml:3: root: found 'floating'"},
      {"crane.urdf\n", "crane.urdf\nurdf_dynamics: 3\n", "crane.yaml:3: urdf_dynamics"},
      {"  lift: {angle: 0.3,", "  left: {angle: 0.3,",
       "crane.yaml:4: start.left: found 'left', expected the name of a joint; did you mean 'lift'"},
      {"  lift: {angle: 0.3,", "  lift: {displacement: 0.3,",
       "crane.yaml:4: start.lift.displacement"},
      {"  lift: {angle: 0.3,", "  lift: {angle: 0.3 m,", "crane.yaml:4: start.lift.angle"},
      {"  lift: {angle: 0.3,", "  lift: {position: [1, 2],",
       "crane.yaml:4: start.lift.position: found 2 values, expected 1"},
      {"b: jib", "b: jibb", "crane.yaml:7: springs.cable.b: found 'jibb'"},
      {"hoist: {joint: lift", "hoist: {joint: lfit", "crane.yaml:10: motors.hoist.joint"},
  };
  for (const auto& [what, with, message] : mistakes) {
    try {
      Make(Replace(text, what, with));
      ADD_FAILURE() << "accepted: " << with;
    } catch (const io::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message)) << with;
    }
  }
}

TEST_F(UrdfSidecar, AMechanismNeedsSomething) {
  try {
    Make("kind: mechanism\nname: nothing\n");
    ADD_FAILURE();
  } catch (const io::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected bodies, beams or urdf"));
  }
}

}  // namespace
}  // namespace kingpin::joints
