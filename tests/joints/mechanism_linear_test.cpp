#include "joints/mechanism_linear.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "core/mechanism/evaluator.h"
#include "core/solve/simulate.h"
#include "joints/mechanism_run.h"

namespace kingpin::joints {
namespace {

using testing::HasSubstr;

// A four-bar whose crank has a spring and a motor, with a load on the coupler; at rest.
const std::string kFourBar = R"(kind: mechanism
bodies:
  crank:   {mass: 1 kg, centre: [0.15, 0, 0], inertia: [0.001, 0.01, 0.01]}
  coupler: {mass: 2 kg, centre: [0.5, 0, 0], inertia: [0.001, 0.2, 0.2]}
  rocker:  {mass: 1.5 kg, centre: [0.4, 0, 0], inertia: [0.001, 0.1, 0.1]}
joints:
  A: {type: revolute, child: crank, axis: [0, -1, 0], angle: 60 deg}
  B: {type: revolute, parent: crank, at: [0.3, 0, 0], child: coupler, axis: [0, -1, 0]}
  D: {type: revolute, at: [0.9, 0, 0], child: rocker, axis: [0, -1, 0]}
closures:
  C: {type: spherical, a: coupler, a_at: [1, 0, 0], b: rocker, b_at: [0.8, 0, 0]}
springs:
  hold: {joint: A, stiffness: 400, free: 1, damping: 3}
motors:
  drive: {joint: A, force: 2, limit: 50}
forces:
  load: {body: coupler, at: [0.6, 0, 0], force: [10, 0, -20], torque: [0, 1, 0], history: [[0, 1], [1, 1]]}
responses:
  compliance: {from: drive, to: A, band: [0.01, 50], points: 30}
  hinge: {from: load, to: C.x.reaction}
simulation: {start_at_rest: true, method: explicit8}
)";

std::string Replace(std::string text, const std::string& what, const std::string& with) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

struct Values {
  Eigen::VectorXd acceleration, reaction;
};

Values Evaluate(const Mechanism& mechanism, const std::vector<double>& y) {
  mechanism::Evaluator evaluator(mechanism.system);
  std::vector<double> rate(y.size());
  evaluator.CalcRates(0, y, rate);
  const auto a = evaluator.accelerations(), r = evaluator.reactions();
  return {Eigen::Map<const Eigen::VectorXd>(a.data(), static_cast<int>(a.size())),
          Eigen::Map<const Eigen::VectorXd>(r.data(), static_cast<int>(r.size()))};
}

int Find(const std::vector<StateSpace::Name>& names, const std::string& name) {
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i].name == name) return static_cast<int>(i);
  }
  ADD_FAILURE() << name;
  return 0;
}

struct Case {
  MechanismFile file = ReadMechanismText(kFourBar, "bar.yaml");
  Mechanism mechanism = MakeMechanism(file);
  StateSpace space = CalcStateSpace(file, mechanism);
};

TEST(StateSpace, AUnitOfAMotorOrForceDoesWhatDirectChangesDo) {
  const Case c;
  ASSERT_EQ(c.space.inputs.size(), 2);
  EXPECT_EQ(c.space.inputs[0].name, "load");
  EXPECT_EQ(c.space.inputs[1].unit, "N m");
  const std::pair<const char*, const char*> changes[] = {{"force: 2,", "force: 3,"},
                                                         {"[[0, 1], [1, 1]]", "[[0, 2], [1, 2]]"}};
  const int inputs[] = {1, 0};
  for (int k = 0; k < 2; ++k) {
    const std::string text = Replace(kFourBar, changes[k].first, changes[k].second);
    const Mechanism changed = MakeMechanism(
        ReadMechanismText(Replace(text, "start_at_rest: true", "duration: 1"), "bar.yaml"));
    const Values before = Evaluate(c.mechanism, c.mechanism.start),
                 after = Evaluate(changed, c.mechanism.start);
    const int nv = c.mechanism.system.model.velocities;
    const Eigen::VectorXd D = c.space.D.col(inputs[k]);
    // both linear in the force: rounding of accelerations near 100
    EXPECT_LE((after.acceleration - before.acceleration - D.segment(nv + nv, nv)).norm(), 1e-10);
    EXPECT_LE((after.reaction - before.reaction - D.tail(before.reaction.size())).norm(), 1e-9);
    EXPECT_LE((c.space.linear.velocity_basis * c.space.B.col(inputs[k]).segment(1, 1) -
               D.segment(nv + nv, nv))
                  .norm(),
              1e-10);
  }
}

TEST(StateSpace, AccelerationsAndReactionsFollowPositionAndVelocity) {
  const Case c;
  const mechanism::Model& model = c.mechanism.system.model;
  const int nv = model.velocities;
  mechanism::Evaluator projector(c.mechanism.system);
  constexpr double kStep = 1e-5;
  for (int direction = 0; direction < 2; ++direction) {
    Values side[2];
    for (int s = 0; s < 2; ++s) {
      std::vector<double> y = c.mechanism.start;
      for (int i = 0; i < nv; ++i) {
        // coordinates are angles here, as many positions as velocities
        const double step = (s == 0 ? -kStep : kStep);
        if (direction == 0) y[i] += step * c.space.linear.position_basis(i, 0);
        if (direction == 1) y[nv + i] += step * c.space.linear.velocity_basis(i, 0);
      }
      projector.Project(0, y, 1e-13, 1e-13);
      side[s] = Evaluate(c.mechanism, y);
    }
    const Eigen::VectorXd acceleration =
        (side[1].acceleration - side[0].acceleration) / (2 * kStep);
    const Eigen::VectorXd reaction = (side[1].reaction - side[0].reaction) / (2 * kStep);
    // central differences: error of order step² times third derivatives, rounding over step
    EXPECT_LE((acceleration - c.space.C.middleRows(nv + nv, nv).col(direction)).norm(),
              1e-6 * (1 + acceleration.norm()));
    EXPECT_LE((reaction - c.space.C.bottomRows(model.rows).col(direction)).norm(),
              1e-6 * (1 + reaction.norm()));
  }
}

// x(t) = A⁻¹ (e^{A t} - 1) B u against the simulation with and without a small constant torque.
TEST(StateSpace, ASmallTorqueMovesTheSimulationAsBSays) {
  const Case c;
  constexpr double kTorque = 1e-3;
  const double duration = 0.4;
  const auto simulate = [&](const std::string& text) {
    MechanismFile file = ReadMechanismText(text, "bar.yaml");
    file.simulation.duration = duration;
    file.start_at_rest = false;
    const Mechanism mechanism = MakeMechanism(file);
    std::vector<double> y = c.mechanism.start;
    solve::Simulate(mechanism.system, file.simulation, y,
                    [](double, std::span<const double>, mechanism::Evaluator&) {});
    return y;
  };
  const std::vector<double> with = simulate(Replace(kFourBar, "force: 2,", "force: 2.001,"));
  const std::vector<double> without = simulate(Replace(kFourBar, "force: 2,", "force: 1.999,"));
  const int n = static_cast<int>(c.space.linear.A.rows());
  const Eigen::VectorXd B = c.space.B.col(1);
  // by small steps of the exact series
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  const int steps = 4000;
  const double h = duration / steps;
  for (int s = 0; s < steps; ++s) {
    const Eigen::VectorXd f = c.space.linear.A * x + B;
    const Eigen::VectorXd Af = c.space.linear.A * f, AAf = c.space.linear.A * Af;
    x += h * f + h * h / 2 * Af + h * h * h / 6 * AAf;
  }
  const Eigen::VectorXd y = c.space.C * x * kTorque;
  for (int i = 0; i < 3; ++i) {
    const double moved = 0.5 * (with[i] - without[i]);
    EXPECT_NEAR(moved, y[i], 1e-5 * std::abs(y[0]));
  }
  EXPECT_GT(std::abs(y[0]), 1e-7);
}

TEST(StateSpace, TheResponseOfAnOscillatorIsTheClosedForm) {
  const MechanismFile file = ReadMechanismText(R"(kind: mechanism
gravity: [0, 0, 0]
bodies:
  block: {mass: 2 kg, inertia: [0.01, 0.01, 0.01]}
joints:
  slide: {type: prismatic, child: block, axis: [1, 0, 0]}
springs:
  spring: {joint: slide, stiffness: 300, damping: 4}
motors:
  push: {joint: slide}
responses:
  compliance: {from: push, to: slide, band: [0.1, 30], points: 50}
  mobility: {from: push, to: slide.rate}
  inertance: {from: push, to: slide.acceleration}
)",
                                               "block.yaml");
  const Mechanism mechanism = MakeMechanism(file);
  const std::vector<ResponseCurve> curves = CalcResponses(file, CalcStateSpace(file, mechanism));
  ASSERT_EQ(curves.size(), 3);
  EXPECT_EQ(curves[0].unit, "m/(N)");
  EXPECT_EQ(curves[0].frequency.size(), 50);
  EXPECT_NEAR(curves[0].frequency.front(), 0.1, 1e-15);
  EXPECT_NEAR(curves[0].frequency.back(), 30, 1e-12);
  for (int k = 0; k < 3; ++k) {
    for (size_t i = 0; i < curves[k].frequency.size(); ++i) {
      const std::complex<double> s(0, 2 * std::numbers::pi * curves[k].frequency[i]);
      const std::complex<double> expected = std::pow(s, k) / (300.0 + 4.0 * s + 2.0 * s * s);
      EXPECT_LE(std::abs(curves[k].values[i] - expected), 1e-12 * (std::abs(expected) + 0.01));
    }
  }
}

// What a motor on a driven crank does reaches the drive alone, at every frequency.
TEST(StateSpace, ADrivenMechanismRespondsAtOnce) {
  const MechanismFile file = ReadMechanismText(
      Replace(
          Replace(kFourBar, "{from: load, to: C.x.reaction}", "{from: drive, to: turn.reaction}"),
          "simulation: {start_at_rest: true,",
          "motions:\n  turn: {joint: A, start: 1.0471975511965976}\nsimulation: {"),
      "bar.yaml");
  const StateSpace space = CalcStateSpace(file, MakeMechanism(file));
  EXPECT_EQ(space.linear.A.rows(), 0);
  const ResponseCurve curve = CalcResponses(file, space).at(1);
  EXPECT_EQ(curve.values.size(), 200);
  for (const std::complex<double>& value : curve.values) {
    EXPECT_LE(std::abs(value + 1.0), 1e-12);
  }
}

TEST(StateSpace, ModesExportNamesAndMatrices) {
  const MechanismModes modes = CalcMechanismModes(ReadMechanismText(kFourBar, "bar.yaml"));
  const auto& json = modes.json;
  EXPECT_EQ(json["inputs"].size(), json["B"][0].size());
  EXPECT_EQ(json["outputs"].size(), json["C"].size());
  EXPECT_EQ(json["D"].size(), json["C"].size());
  EXPECT_EQ(json["outputs"][0]["name"], "A");
  EXPECT_EQ(json["frequency_responses"].size(), 2);
  EXPECT_EQ(json["frequency_responses"][1]["output"], "C.x.reaction");
  EXPECT_THAT(modes.text, HasSubstr("compliance: drive to A"));
  // static: the spring and gravity's geometric stiffness hold against the motor
  const Case c;
  const double gain = json["frequency_responses"][0]["magnitude"][0].get<double>();
  const Eigen::VectorXd still = -c.space.linear.A.fullPivLu().solve(c.space.B.col(1));
  EXPECT_NEAR(gain, std::abs((c.space.C * still)(Find(c.space.outputs, "A"))), 1e-4 * gain);
}

TEST(StateSpace, MistakesAreNamedWithFileLineAndKey) {
  const std::tuple<const char*, const char*, const char*> mistakes[] = {
      {"from: drive, to: A,", "from: drvie, to: A,",
       "bar.yaml:19: responses.compliance.from: found 'drvie', expected the name of a motor or of "
       "a force on a body; did you mean 'drive'"},
      {"from: drive, to: A,", "from: hold, to: A,", "bar.yaml:19: responses.compliance.from"},
      {"to: C.x.reaction", "to: C.x.raection",
       "bar.yaml:20: responses.hinge.to: found 'C.x.raection'"},
      {"band: [0.01, 50]", "band: [0, 50]", "bar.yaml:19: responses.compliance.band"},
      {"band: [0.01, 50]", "band: [60, 50]", "bar.yaml:19: responses.compliance.band"},
      {"band: [0.01, 50]", "band: [1 s, 50]", "bar.yaml:19: responses.compliance.band"},
      {"points: 30", "points: 1", "bar.yaml:19: responses.compliance.points"},
      {"simulation:", "report: {coordinates: [E]}\nsimulation:",
       "bar.yaml:21: report.coordinates: found 'E', expected the name of a joint or coordinate"},
      {"simulation:", "report: {reactions: [A]}\nsimulation:",
       "bar.yaml:21: report.reactions: found 'A'"},
      {"simulation:", "report: {raections: [A]}\nsimulation:", "did you mean 'reactions'"},
  };
  for (const auto& [what, with, message] : mistakes) {
    try {
      const MechanismFile file = ReadMechanismText(Replace(kFourBar, what, with), "bar.yaml");
      CheckNames(file, MakeMechanism(file));
      ADD_FAILURE() << "accepted: " << with;
    } catch (const io::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message)) << with;
    }
  }
}

}  // namespace
}  // namespace kingpin::joints
