#include <cmath>

#include "tests/apps/program.h"

namespace kingpin {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

// A pendulum of 2 kg at 0.5 m from its axis, on a post.
const char* const kPendulum = R"(<robot name="pendulum">
  <link name="post"><inertial><mass value="9"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.02"/></inertial></link>
  <link name="tip"/>
  <joint name="hinge" type="continuous"><parent link="post"/><child link="rod"/>
    <origin xyz="0 0 1"/><axis xyz="1 0 0"/></joint>
  <joint name="end" type="fixed"><parent link="rod"/><child link="tip"/>
    <origin xyz="0 0 -1"/></joint>
</robot>
)";

class Urdf : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    Write("pendulum.urdf", kPendulum);
  }

  Outcome Evaluate(const std::string& states, const std::string& more = "") const {
    Write("states.json", states);
    return Run("urdf pendulum.urdf --evaluate states.json -o out.json " + more);
  }

  void ExpectMistake(const std::string& states, const std::string& message,
                     const std::string& more = "") const {
    const Outcome outcome = Evaluate(states, more);
    EXPECT_EQ(outcome.status, 2) << states;
    EXPECT_THAT(outcome.errors, HasSubstr(message));
    EXPECT_FALSE(fs::exists(folder_ / "out.json"));
  }

  json Result() const { return json::parse(ReadAll(folder_ / "out.json")); }
};

std::string State(const std::string& positions, const std::string& v, const std::string& tau,
                  const std::string& a, const std::string& base = "") {
  return R"({"gravity": [0, 0, -9.81], "states": [{)" + base + R"("joint_positions": )" +
         positions + R"(, "v": )" + v + R"(, "tau": )" + tau + R"(, "a": )" + a + "}]}";
}

TEST_F(Urdf, EvaluatesAPendulum) {
  const Outcome outcome = Evaluate(State(R"({"hinge": 0.3})", "[2]", "[1.5]", "[-0.7]"));
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  const json out = Result();
  ASSERT_EQ(out.at("velocity_layout").size(), 1u);
  EXPECT_EQ(out["velocity_layout"][0], json::parse(R"({"joint":"hinge","first":0,"size":1})"));
  const json& state = out.at("states").at(0);
  const double M = 0.1 + 2 * 0.25, bias = 2 * 9.81 * 0.5 * std::sin(0.3);
  EXPECT_NEAR(state.at("M").at(0).at(0), M, 1e-15);
  EXPECT_NEAR(state.at("bias_nle").at(0), bias, 1e-14);
  EXPECT_NEAR(state.at("qdd_forward_dynamics").at(0), (1.5 - bias) / M, 1e-13);
  EXPECT_NEAR(state.at("tau_inverse_dynamics").at(0), M * -0.7 + bias, 1e-14);
  EXPECT_NEAR(state.at("kinetic_energy"), 0.5 * M * 4, 1e-15);
  const double height = 1 - 0.5 * std::cos(0.3);
  EXPECT_NEAR(state.at("potential_energy"), 2 * 9.81 * height, 1e-13);  // the post counts nothing
  EXPECT_NEAR(state.at("com").at(1), 0.5 * std::sin(0.3), 1e-15);
  EXPECT_NEAR(state.at("com").at(2), height, 1e-15);
  const json& tip = state.at("links").at("tip");
  const double s = std::sin(0.3), c = std::cos(0.3);
  EXPECT_NEAR(tip.at("p").at(1), s, 1e-15);
  EXPECT_NEAR(tip.at("p").at(2), 1 - c, 1e-15);
  // row by row, link to world: the world's z components of the link's axes in the last row
  EXPECT_NEAR(tip.at("R").at(2).at(1), s, 1e-15);
  EXPECT_NEAR(tip.at("R").at(1).at(2), -s, 1e-15);
  EXPECT_NEAR(tip.at("v").at(1), 2 * c, 1e-15);
  EXPECT_NEAR(tip.at("w").at(0), 2, 1e-15);
  EXPECT_NEAR(tip.at("acc").at(1), -0.7 * c - 4 * s, 1e-14);
  EXPECT_NEAR(tip.at("acc").at(2), -0.7 * s + 4 * c, 1e-14);
  EXPECT_NEAR(tip.at("alpha").at(0), -0.7, 1e-15);
  EXPECT_THAT(state.at("links").at("post").at("acc"), ElementsAre(0, 0, 0));
  // 17 digits: nothing is lost on the way through the file
  EXPECT_THAT(ReadAll(folder_ / "out.json"), HasSubstr("0.59999999999999998"));
}

TEST_F(Urdf, EvaluatesAFloatingBase) {
  // without gravity and at rest: the force needed along the base's x accelerates the whole mass
  const Outcome outcome =
      Evaluate(State(R"({"hinge": 0})", "[0,0,0,0,0,0,0]", "[0,0,0,0,0,0,0]", "[1,0,0,0,0,0,0]",
                     R"("base_position": [1,2,3], "base_quaternion_xyzw": [0,0,0.6,0.8], )"),
               "--floating-base");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const json out = Result();
  EXPECT_EQ(out.at("velocity_layout").at(0),
            json::parse(R"({"joint":"floating_base","first":0,"size":6})"));
  EXPECT_EQ(out.at("velocity_layout").at(1),
            json::parse(R"({"joint":"hinge","first":6,"size":1})"));
  const json& state = out.at("states").at(0);
  EXPECT_NEAR(state.at("tau_inverse_dynamics").at(0), 11, 1e-14);
  EXPECT_NEAR(state.at("tau_inverse_dynamics").at(2), 11 * 9.81, 1e-13);
  EXPECT_THAT(state.at("links").at("post").at("p"), ElementsAre(1, 2, 3));
  // the quaternion turns about z: cos = 0.28, sin = 0.96
  EXPECT_NEAR(state.at("links").at("post").at("acc").at(0), 0.28, 1e-15);
  EXPECT_NEAR(state.at("links").at("post").at("acc").at(1), 0.96, 1e-15);
  EXPECT_NEAR(state.at("links").at("post").at("R").at(0).at(1), -0.96, 1e-15);
  EXPECT_NEAR(state.at("potential_energy"), 9.81 * (9 * 3 + 2 * 3.5), 1e-12);
}

TEST_F(Urdf, ForwardAndInverseDynamicsOfTheShippedArmAgree) {
  const std::string folder = KINGPIN_SOURCE_DIR "/examples/urdf/";
  const Outcome outcome = Run("urdf " + folder + "arm.urdf --evaluate " + folder + "states.json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const json out = json::parse(outcome.output);
  const json given = json::parse(ReadAll(folder + "states.json"));
  ASSERT_EQ(out.at("states").size(), given.at("states").size());
  for (std::size_t k = 0; k < out.at("states").size(); ++k) {
    const json& state = out["states"][k];
    for (std::size_t i = 0; i < 6; ++i) {
      double force = state["bias_nle"][i], needed = force;
      for (std::size_t j = 0; j < 6; ++j) {
        force += state["M"][i][j].get<double>() * state["qdd_forward_dynamics"][j].get<double>();
        needed += state["M"][i][j].get<double>() * given["states"][k]["a"][j].get<double>();
      }
      EXPECT_NEAR(force, given["states"][k]["tau"][i], 1e-12);
      EXPECT_NEAR(needed, state["tau_inverse_dynamics"][i], 1e-12);
    }
  }
}

TEST_F(Urdf, SaysWhatItReads) {
  const Outcome outcome = Run("urdf pendulum.urdf");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(
      outcome.output,
      HasSubstr("robot 'pendulum': 3 links, 2 joints, 1 degrees of freedom, 2 kg that move; "
                "root 'post'"));
  EXPECT_THAT(outcome.output, HasSubstr("hinge: continuous, post -> rod"));
}

TEST_F(Urdf, MistakesInStatesNameFileAndKey) {
  const std::string h = R"({"hinge": 0})";
  ExpectMistake("{", "states.json:1: found no JSON");
  ExpectMistake("{\n\"gravity\": [0, 0, NaN]}", "states.json:2: found no JSON");
  ExpectMistake("[]",
                "states.json: found a list, expected an object with the keys gravity, states");
  ExpectMistake(R"({"gravity": [0,0,1]})", "states.json: states: found nothing, expected this key");
  ExpectMistake(R"({"gravity": [0,0], "states": []})",
                "states.json: gravity: found 2 entries, expected a list of 3 numbers");
  ExpectMistake(R"({"gravity": [0,0,1e999], "states": []})", "beyond the range");
  ExpectMistake(R"({"gravity": [0,0,"x"], "states": []})",
                "gravity[2]: found \"x\", expected a number");
  ExpectMistake(
      R"({"gravty": [0,0,1], "states": []})",
      "gravty: found an unknown key, expected a key of the file; did you mean 'gravity'?");
  ExpectMistake(R"({"gravity": [0,0,1], "gravity": [0,0,2], "states": []})",
                "gravity: found a key given twice in one object");
  ExpectMistake(R"({"gravity": [0,0,1], "states": []})",
                "states.json: states: found an empty list, expected at least one state");
  ExpectMistake("{\"gravity\": [0,0,1],\n \"st\xE4tes\": []}",
                "states.json:2: found the byte 0xE4, which is no UTF-8");
  ExpectMistake(R"({"gravity": [0,0,1], "states": 3})",
                "states: found 3, expected a list of states");
  ExpectMistake(State(h, "[1, 2]", "[0]", "[0]"),
                "states[0].v: found 2 entries, expected a list of 1 numbers (in the order of "
                "velocity_layout)");
  ExpectMistake(State(h, "[0]", "null", "[0]"), "states[0].tau: found null, expected a list of 1");
  ExpectMistake(State(h, "[0]", "[0]", "[[0]]"), "states[0].a[0]: found a list, expected a number");
  ExpectMistake(
      State(R"({"hing": 0})", "[0]", "[0]", "[0]"),
      "states[0].joint_positions.hing: found no joint of this name that moves, expected the "
      "name of a movable joint; did you mean 'hinge'?");
  ExpectMistake(State(R"({"hinge": 0, "end": 0})", "[0]", "[0]", "[0]"),
                "states[0].joint_positions.end: found no joint of this name that moves");
  ExpectMistake(
      State("{}", "[0]", "[0]", "[0]"),
      "states[0].joint_positions.hinge: found nothing, expected the position of this joint");
  ExpectMistake(
      State(h, "[0]", "[0]", "[0]", R"("base_position": [0,0,0], )"),
      "states[0].base_position: found the pose of a base that is fixed, expected none; run "
      "with --floating-base");
  const std::string n = "[0,0,0,0,0,0,0]";
  ExpectMistake(State(h, n, n, n), "states[0].base_position: found nothing", "--floating-base");
  ExpectMistake(
      State(h, n, n, n, R"("base_position": [0,0,0], "base_quaternion_xyzw": [0,0,0,2], )"),
      "states[0].base_quaternion_xyzw: found a quaternion of length 2, expected x, y, z, w "
      "of length 1",
      "--floating-base");
  EXPECT_EQ(Run("urdf pendulum.urdf --evaluate absent.json -o out.json").status, 2);
}

TEST_F(Urdf, MistakesInTheUrdfEndWithStatusTwoAndNothingWritten) {
  Write("states.json", State("{}", "[]", "[]", "[]"));
  Write("cut.urdf", std::string(kPendulum).substr(0, 400));
  const Outcome cut = Run("urdf cut.urdf --evaluate states.json -o out.json");
  EXPECT_EQ(cut.status, 2);
  EXPECT_THAT(cut.errors, HasSubstr("kingpin: cut.urdf:"));
  EXPECT_EQ(Run("urdf absent.urdf").status, 2);
  Write("ball.urdf",
        "<robot name='r'>\n<link name='a'/><link name='b'/>\n<joint name='j' "
        "type='ball'><parent link='a'/><child link='b'/></joint></robot>");
  const Outcome ball = Run("urdf ball.urdf --evaluate states.json -o out.json");
  EXPECT_EQ(ball.status, 2);
  EXPECT_THAT(ball.errors, HasSubstr("ball.urdf:3: joint[j].type: found 'ball'"));
  EXPECT_FALSE(fs::exists(folder_ / "out.json"));
}

TEST_F(Urdf, AStateThatOverflowsIsAFailedRun) {
  const Outcome outcome = Evaluate(State(R"({"hinge": 0})", "[1e200]", "[0]", "[0]"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("states[0]: the result is not finite"));
  EXPECT_FALSE(fs::exists(folder_ / "out.json"));
}

}  // namespace
}  // namespace kingpin
