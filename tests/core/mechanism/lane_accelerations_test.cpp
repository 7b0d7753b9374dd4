#include "core/mechanism/lane_accelerations.h"

#include <gtest/gtest.h>

#include "core/mechanism/accelerations.h"
#include "core/mechanism/compile.h"
#include "core/mechanism/project.h"
#include "tests/core/mechanism/random_mechanism.h"

namespace kingpin::mechanism {
namespace {

// A random tree with two spherical loops, put together wherever it is: the second body of each loop
// gets its point where the first one's is.
Model MakeLoops(RandomMechanism& random, std::vector<double>& q) {
  Model model =
      random.MakeTree(12, {JointKind::kRevolute, JointKind::kScrew, JointKind::kSpherical});
  q = random.MakePositions(model);
  CompileTopology(model);
  Workspace<double> w(model);
  UpdatePositions(model, q.data(), w);
  for (const auto& [a, b] : {std::pair{5, 11}, std::pair{12, 2}}) {
    const Vector3<double> p = random.NormalVector();
    const Transform<double> X_WB{w.R[b], w.p[b]};
    model.points.push_back(
        {a, b, w.R[a].TransposeTimes(p - w.p[a]), {{}, X_WB.Inverse() * p}, 7, model.rows});
    for (int r = 0; r < 3; ++r) {
      model.row_names.push_back("loop");
      model.holonomic.push_back(1);
      ++model.rows;
    }
  }
  CompileTopology(model);
  CompileElimination(model, q);
  return model;
}

TEST(LaneAccelerations, EveryLaneGivesWhatTheScalarSolutionGives) {
  RandomMechanism random(21);
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<double> q0;
    const Model model = MakeLoops(random, q0);
    for (int lanes : {1, 8}) {
      const auto kernel = MakeLaneAccelerations(model, lanes);
      ASSERT_EQ(kernel->lanes(), lanes);
      std::vector<double> q(model.positions * lanes), v(model.velocities * lanes),
          force(model.velocities * lanes), a(model.velocities * lanes), r(model.rows * lanes);
      std::vector<std::vector<double>> positions(lanes, q0), velocities(lanes), forces(lanes);
      for (int lane = 0; lane < lanes; ++lane) {
        velocities[lane] = random.MakeVelocities(model);
        forces[lane] = random.MakeVelocities(model);
        std::vector<double> direction = random.MakeVelocities(model);
        for (double& d : direction) d *= 0.01;
        MoveOnConstraints(model, direction, positions[lane]);
        for (int i = 0; i < model.positions; ++i) q[i * lanes + lane] = positions[lane][i];
        for (int i = 0; i < model.velocities; ++i) {
          v[i * lanes + lane] = velocities[lane][i];
          force[i * lanes + lane] = forces[lane][i];
        }
      }
      ASSERT_TRUE(kernel->Calc(q.data(), v.data(), force.data(), a.data(), r.data()));
      for (int lane = 0; lane < lanes; ++lane) {
        Workspace<double> w(model);
        UpdatePositions(model, positions[lane].data(), w);
        UpdateVelocities(model, velocities[lane].data(), w);
        UpdateClosures(model, w);
        w.generalised = forces[lane];
        std::vector<double> still(model.rows), wanted(model.velocities), reaction(model.rows);
        SolveAccelerations(model, still, w, wanted, reaction);
        double size = 0;
        for (double x : wanted) size = std::max(size, std::abs(x));
        for (int i = 0; i < model.velocities; ++i)
          EXPECT_NEAR(a[i * lanes + lane], wanted[i], 1e-10 * size);
        size = 0;
        for (double x : reaction) size = std::max(size, std::abs(x));
        for (int i = 0; i < model.rows; ++i)
          EXPECT_NEAR(r[i * lanes + lane], reaction[i], 1e-10 * size);
      }
    }
  }
}

// A free root carries the reference point: 10 km from the world's origin the accelerations keep
// their digits.
TEST(Accelerations, AreTheSameTenKilometresAway) {
  RandomMechanism random(23);
  Model model =
      random.MakeTree(10, {JointKind::kRevolute, JointKind::kPrismatic, JointKind::kSpherical});
  model.links[1].kind = JointKind::kFree;
  model.positions = model.velocities = 0;
  for (Link& link : model.links) {
    if (&link == &model.links[0]) continue;
    if (link.parent == 0) link.parent = 1;
    if (&link == &model.links[1]) link.parent = 0;
    link.q = model.positions;
    link.v = model.velocities;
    model.positions += CountPositions(link.kind);
    model.velocities += CountVelocities(link.kind);
  }
  std::vector<double> q = random.MakePositions(model);
  const std::vector<double> v = random.MakeVelocities(model);
  CompileTopology(model);
  CompileElimination(model, q);
  std::vector<double> a[2];
  for (auto& acceleration : a) {
    Workspace<double> w(model);
    UpdatePositions(model, q.data(), w);
    UpdateVelocities(model, v.data(), w);
    acceleration.resize(model.velocities);
    SolveAccelerations(model, {}, w, acceleration, {});
    q[0] += 8000, q[1] -= 6000;
  }
  for (int i = 0; i < model.velocities; ++i)
    EXPECT_NEAR(a[1][i], a[0][i], 1e-9 * (1 + std::abs(a[0][i])));
}

}  // namespace
}  // namespace kingpin::mechanism
