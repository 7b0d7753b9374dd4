#include "core/solve/null_space.h"

#include <Eigen/Dense>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/mechanism/project.h"
#include "core/solve/linearise.h"
#include "joints/mechanism_file.h"

namespace kingpin::joints {
namespace {

std::span<const double> GetPosition(const Mechanism& mechanism) {
  return {mechanism.start.data(), static_cast<size_t>(mechanism.system.model.positions)};
}

int CountFreedoms(const Mechanism& mechanism) {
  return solve::CalcNullSpace(mechanism.system.model, GetPosition(mechanism)).freedoms();
}

// By another way: singular values of all rows that stay, redundant ones among them, each as it is.
int CountBySingularValues(const Mechanism& mechanism) {
  const mechanism::Model& model = mechanism.system.model;
  Eigen::MatrixXd J = mechanism::CalcEquationMatrix(model, GetPosition(mechanism))
                          .bottomLeftCorner(model.rows, model.velocities);
  for (int r = 0; r < model.rows; ++r) {
    if (model.switching[r]) J.row(r).setZero();
  }
  const Eigen::VectorXd values = J.jacobiSvd().singularValues();
  return model.velocities - static_cast<int>((values.array() > 1e-7 * values[0]).count());
}

Mechanism Read(const std::string& text) {
  return MakeMechanism(ReadMechanismText(text, "mechanism.yaml"));
}

// Rows across the plane whose gradients are rounding: turned frames leave 6e-17 of them.
const std::string kTurnedFourBar = R"(kind: mechanism
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
)";

// In a plane askew: rows that depend on others to the rounding of many turns.
const std::string kParallelograms = R"(kind: mechanism
bodies:
  a: {mass: 1, centre: [0, 0, -0.1], inertia: [1e-2, 1e-2, 1e-3]}
  b: {mass: 1, centre: [0, 0, -0.1], inertia: [1e-2, 1e-2, 1e-3]}
  d: {mass: 1, centre: [0, 0, -0.1], inertia: [1e-2, 1e-2, 1e-3]}
  p: {mass: 2, centre: [0.2, 0, 0], inertia: [1e-2, 1e-2, 1e-2]}
joints:
  A: {type: revolute, turned: [0.3, 0, 0.2], child: a, axis: [0, 1, 0], angle: 0.3}
  P: {type: revolute, parent: a, at: [0, 0, -0.2], child: p, axis: [0, 1, 0], angle: -0.3}
  B: {type: revolute, parent: p, at: [0.4, 0, 0], child: b, child_at: [0, 0, -0.2], axis: [0, 1, 0], angle: 0.3}
  D: {type: revolute, parent: p, at: [0.2, 0, 0], child: d, child_at: [0, 0, -0.2], axis: [0, 1, 0], angle: 0.3}
closures:
  cb: {type: revolute, a: b, a_turned: [-90 deg, 0, 0], b: world,
       b_at: [0.3920862919816785, 0.07827789852320828, 0.011870562027482337],
       b_turned: [-1.2653541797170704, -0.15079122347706517, 0.1507912234770652]}
  cd: {type: revolute, a: d, a_turned: [-90 deg, 0, 0], b: world,
       b_at: [0.19604314599083925, 0.03913894926160414, 0.0059352810137411685],
       b_turned: [-1.2653541797170704, -0.15079122347706517, 0.1507912234770652]}
)";

TEST(NullSpace, RowsThatAreRoundingHoldNothing) {
  for (const std::string& text : {kTurnedFourBar, kParallelograms}) {
    const Mechanism mechanism = Read(text);
    EXPECT_EQ(CountFreedoms(mechanism), 1) << text;
    EXPECT_EQ(CountBySingularValues(mechanism), 1) << text;
  }
}

TEST(NullSpace, AShaftKeepsItsModesWhereverItStands) {
  for (const char* place : {"[0, -0.6, 0]", "[0, -0.6, 0.001]", "[0.001, -0.6, 0]"}) {
    io::ReadOptions options;
    options.overrides = {io::ParseOverride(std::string("beams.shaft.at=") + place)};
    const Mechanism mechanism = MakeMechanism(ReadMechanismFile(
        KINGPIN_SOURCE_DIR "/examples/mechanisms/slider_crank_shaft.yaml", options));
    EXPECT_EQ(CountFreedoms(mechanism), 6) << place;
    EXPECT_EQ(CountBySingularValues(mechanism), 6) << place;
    const auto modes = solve::CalcModes(solve::Linearise(mechanism.system, 0, mechanism.start));
    EXPECT_NEAR(modes.at(0).frequency, 34.5, 0.2) << place;
  }
}

TEST(NullSpace, ItsDirectionsMeetTheRowsAndAreOrthonormalInTheMass) {
  for (const std::string& text : {kTurnedFourBar, kParallelograms}) {
    const Mechanism mechanism = Read(text);
    const mechanism::Model& model = mechanism.system.model;
    const int nv = model.velocities;
    const Eigen::MatrixXd K = mechanism::CalcEquationMatrix(model, GetPosition(mechanism));
    const solve::NullSpace space = solve::CalcNullSpace(model, GetPosition(mechanism));
    const Eigen::MatrixXd& T = space.basis;
    EXPECT_LE((K.bottomLeftCorner(model.rows, nv) * T).norm(), 1e-11 * T.norm());
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(T.cols(), T.cols());
    EXPECT_LE((T.transpose() * K.topLeftCorner(nv, nv) * T - one).norm(), 1e-12);
    EXPECT_LE((space.inverse * T - one).norm(), 1e-12);
  }
}

// Where rows depend on each other in a position alone, it has more freedom there.
TEST(NullSpace, AParallelogramLaidFlatMayLeaveItsPath) {
  const std::string text = R"(kind: mechanism
bodies:
  crank:   {mass: 1, centre: [0.1, 0, 0], inertia: [1e-4, 1e-3, 1e-3]}
  coupler: {mass: 1, centre: [0.2, 0, 0], inertia: [1e-3, 0.03, 0.03]}
  rocker:  {mass: 1, centre: [0.1, 0, 0], inertia: [1e-3, 0.012, 0.012]}
joints:
  A: {type: revolute, child: crank, axis: [0, 1, 0], angle: ANGLE}
  B: {type: revolute, parent: crank, at: [0.2, 0, 0], child: coupler, axis: [0, 1, 0], angle: -ANGLE}
  D: {type: revolute, at: [0.4, 0, 0], child: rocker, axis: [0, 1, 0], angle: ANGLE}
closures:
  C: {type: spherical, a: coupler, a_at: [0.4, 0, 0], b: rocker, b_at: [0.2, 0, 0]}
)";
  const auto count = [&](const std::string& angle) {
    std::string with = text;
    for (size_t at; (at = with.find("ANGLE")) != std::string::npos;) with.replace(at, 5, angle);
    return CountFreedoms(Read(with));
  };
  EXPECT_EQ(count("0.5"), 1);
  EXPECT_EQ(count("0.0"), 2);
}

// A disc rolls in a plane; a rack of the same pitch line asks for the same once more, as a
// position.
TEST(NullSpace, APositionThatRatesAlsoHoldStaysHeld) {
  const Mechanism mechanism = Read(R"(kind: mechanism
bodies:
  sledge: {mass: 1, inertia: [0.1, 0.1, 0.1]}
  disc: {mass: 1, inertia: [0.1, 0.1, 0.1]}
joints:
  along: {type: prismatic, at: [0, 0, 0.2], child: sledge, axis: [1, 0, 0]}
  axle: {type: revolute, parent: sledge, child: disc, axis: [0, 1, 0]}
closures:
  wheel: {type: rolling_disc, a: disc, a_turned: [-90 deg, 0, 0], b: world, radius: 0.2}
couplings:
  rack: {terms: [{joint: along}, {joint: axle, factor: -0.2}]}
)");
  const solve::Linearisation linear = solve::Linearise(mechanism.system, 0, mechanism.start);
  EXPECT_EQ(linear.positions, 1);
  EXPECT_EQ(linear.velocities, 1);
}

}  // namespace
}  // namespace kingpin::joints
