#include "core/mechanism/inverse_dynamics.h"

#include <Eigen/Dense>

#include <gtest/gtest.h>

#include "core/mechanism/accelerations.h"
#include "core/mechanism/compile.h"
#include "core/mechanism/project.h"
#include "tests/core/mechanism/random_mechanism.h"

namespace kingpin::mechanism {
namespace {

const std::vector<JointKind> kAllKinds = {JointKind::kRevolute, JointKind::kPrismatic,
                                          JointKind::kScrew, JointKind::kSpherical,
                                          JointKind::kFree};

TEST(InverseDynamics, IsTheInverseOfForwardDynamicsUnderAnyForces) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RandomMechanism random(seed);
    Model model = random.MakeTree(8, kAllKinds);
    CompileTopology(model);
    const std::vector<double> q = random.MakePositions(model);
    CompileElimination(model, q);
    const int n = model.velocities;
    std::vector<double> v(n), acceleration(n), force(n), back(n);
    for (int i = 0; i < n; ++i) v[i] = random.Normal(), acceleration[i] = random.Normal();
    std::vector<math::Wrench<double>> applied(model.links.size());
    for (auto& f : applied) f = {random.NormalVector(), random.NormalVector()};

    Workspace<double> w(model);
    UpdatePositions(model, q.data(), w);
    UpdateVelocities(model, v.data(), w);
    w.f = applied;
    CalcInverseDynamics(model, acceleration.data(), w, force.data());

    UpdateVelocities(model, v.data(), w);
    w.f = applied;
    w.generalised = force;
    SolveAccelerations(model, {}, w, back, {});
    // The pivots of eight links with masses near one stay within a few powers of ten.
    for (int i = 0; i < n; ++i) EXPECT_NEAR(back[i], acceleration[i], 1e-9) << seed << ' ' << i;
  }
}

TEST(InverseDynamics, IsMassTimesAccelerationPlusBias) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RandomMechanism random(seed);
    Model model = random.MakeTree(8, kAllKinds);
    CompileTopology(model);
    const std::vector<double> q = random.MakePositions(model);
    CompileElimination(model, q);
    const int n = model.velocities;
    Eigen::VectorXd v(n), acceleration(n), force(n), bias(n);
    for (int i = 0; i < n; ++i) v[i] = random.Normal(), acceleration[i] = random.Normal();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);

    Workspace<double> w(model);
    UpdatePositions(model, q.data(), w);
    UpdateVelocities(model, v.data(), w);
    CalcInverseDynamics(model, none.data(), w, bias.data());
    std::fill(w.f.begin(), w.f.end(), Wrench<double>{});
    CalcInverseDynamics(model, acceleration.data(), w, force.data());
    const Eigen::MatrixXd M = CalcEquationMatrix(model, q).topLeftCorner(n, n);
    // rounding only
    EXPECT_LT((force - M * acceleration - bias).norm(), 1e-12 * force.norm()) << seed;
  }
}

}  // namespace
}  // namespace kingpin::mechanism
