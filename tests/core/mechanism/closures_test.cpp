#include "core/mechanism/closures.h"

#include <Eigen/Dense>

#include <gtest/gtest.h>

#include "core/mechanism/accelerations.h"
#include "core/mechanism/compile.h"
#include "core/mechanism/project.h"
#include "tests/core/mechanism/random_mechanism.h"

namespace kingpin::mechanism {
namespace {

// A tree with one closure of every kind between random links. Not assembled: rows measure what they
// measure anywhere.
Model MakeClosedTree(RandomMechanism& random, int links) {
  Model model = random.MakeTree(links, kAllKinds);
  const auto link = [&] {
    return static_cast<int>(std::abs(random.Normal()) * 1000) % (links + 1);
  };
  const auto two = [&](int& a, int& b) {
    a = link();
    do b = link();
    while (b == a);
  };
  const auto add_rows = [&](int count) {
    const int first = model.rows;
    for (int r = 0; r < count; ++r) {
      model.row_names.push_back("row " + std::to_string(model.rows++));
      model.holonomic.push_back(1);
    }
    return first;
  };
  int a, b;
  for (int axes : {7, 3, 1}) {
    two(a, b);
    model.points.push_back({a,
                            b,
                            random.NormalVector(),
                            {random.MakeRotation(), random.NormalVector()},
                            axes,
                            add_rows(__builtin_popcount(axes))});
  }
  two(a, b);
  model.perpendiculars.push_back({a, b, random.UnitVector(), random.UnitVector(), add_rows(1)});
  two(a, b);
  model.distances.push_back({a, b, random.NormalVector(), random.NormalVector(), 0.7, add_rows(1)});
  two(a, b);
  model.discs.push_back({a,
                         b,
                         random.NormalVector(),
                         random.UnitVector(),
                         0.3,
                         {random.MakeRotation(), random.NormalVector()},
                         add_rows(3)});
  for (int k = 1; k <= 2; ++k) model.holonomic[model.rows - k] = 0;
  return model;
}

struct Rows {
  Eigen::VectorXd residual, rate, bias;
};

// Φ, the rate of each row from its gradients, and J̇v.
Rows CalcRows(const Model& model, const std::vector<double>& q, const std::vector<double>& v) {
  Workspace<double> w(model);
  UpdatePositions(model, q.data(), w);
  UpdateVelocities(model, v.data(), w);
  UpdateClosures(model, w);
  Rows rows{CalcResidual(model, q), Eigen::VectorXd::Zero(model.rows),
            Eigen::VectorXd::Zero(model.rows)};
  for (int r = 0; r < model.rows; ++r) {
    for (int s = model.support_begin[r]; s < model.support_begin[r + 1]; ++s) {
      const Model::Support& support = model.supports[s];
      rows.rate[r] += support.sign * Dot(w.axes[support.dof], w.W[r]) * v[support.dof];
    }
    rows.bias[r] = w.bias[r];
  }
  return rows;
}

// dq/dt = N(q) v, integrated by one step of fourth order: exact enough for differences with steps
// of 1e-3.
std::vector<double> Advance(const Model& model, const std::vector<double>& q,
                            const std::vector<double>& v, double h) {
  const size_t n = q.size();
  std::vector<double> k1(n), k2(n), k3(n), k4(n), x(n);
  CalcPositionRates(model, q.data(), v.data(), k1.data());
  for (size_t i = 0; i < n; ++i) x[i] = q[i] + h / 2 * k1[i];
  CalcPositionRates(model, x.data(), v.data(), k2.data());
  for (size_t i = 0; i < n; ++i) x[i] = q[i] + h / 2 * k2[i];
  CalcPositionRates(model, x.data(), v.data(), k3.data());
  for (size_t i = 0; i < n; ++i) x[i] = q[i] + h * k3[i];
  CalcPositionRates(model, x.data(), v.data(), k4.data());
  for (size_t i = 0; i < n; ++i) x[i] = q[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  return x;
}

TEST(Closures, RatesAndAccelerationsAreTheDerivativesOfTheResidual) {
  RandomMechanism random(11);
  for (int trial = 0; trial < 20; ++trial) {
    Model model = MakeClosedTree(random, 6);
    const std::vector<double> q = random.MakePositions(model);
    std::vector<double> v = random.MakeVelocities(model);
    CompileTopology(model);
    CompileElimination(model, q);
    const Rows rows = CalcRows(model, q, v);
    // central differences of fourth order along the motion with constant v
    const double h = 1e-3;
    Rows at[5];
    for (int k = -2; k <= 2; ++k) at[k + 2] = CalcRows(model, Advance(model, q, v, k * h), v);
    for (int r = 0; r < model.rows; ++r) {
      const auto slope = [&](auto pick) {
        return (8 * (pick(at[3])[r] - pick(at[1])[r]) - (pick(at[4])[r] - pick(at[0])[r])) /
               (12 * h);
      };
      const double scale = 1 + std::abs(rows.bias[r]) + std::abs(rows.rate[r]);
      if (model.holonomic[r]) {
        EXPECT_NEAR(rows.rate[r], slope([](const Rows& x) { return x.residual; }), 1e-7 * scale)
            << r;
      }
      EXPECT_NEAR(rows.bias[r], slope([](const Rows& x) { return x.rate; }), 1e-6 * scale) << r;
    }
  }
}

// The same system by another route: accelerations of a tree whose loops are closed, from the mass
// matrix and the gradients alone, by a dense decomposition.
TEST(Accelerations, AgreeWithADenseSolutionOfTheWholeSystem) {
  RandomMechanism random(13);
  for (int trial = 0; trial < 20; ++trial) {
    Model model = MakeClosedTree(random, 8);
    const std::vector<double> q = random.MakePositions(model);
    const std::vector<double> v = random.MakeVelocities(model);
    CompileTopology(model);
    CompileElimination(model, q);
    // Random links may make rows depend on each other; drives that some acceleration meets keep
    // them consistent.
    const Eigen::MatrixXd K = CalcEquationMatrix(model, q);
    const Eigen::MatrixXd D = K.topRightCorner(model.velocities, model.rows);
    const Rows rows = CalcRows(model, q, v);
    Eigen::VectorXd some(model.velocities);
    for (double& x : some) x = random.Normal();
    const Eigen::VectorXd drive = D.transpose() * some + rows.bias;
    std::vector<double> a(model.velocities), R(model.rows);
    Workspace<double> w(model);
    UpdatePositions(model, q.data(), w);
    UpdateVelocities(model, v.data(), w);
    UpdateClosures(model, w);
    for (auto& f : w.f) f = {random.NormalVector(), random.NormalVector()};
    for (double& t : w.generalised) t = random.Normal();
    SolveAccelerations(model, {drive.data(), static_cast<size_t>(model.rows)}, w, a, R);

    const Eigen::Map<Eigen::VectorXd> qdd(a.data(), model.velocities),
        reaction(R.data(), model.rows);
    const Eigen::VectorXd miss = D.transpose() * qdd + rows.bias - drive;
    EXPECT_LT(miss.norm(), 1e-9 * (1 + rows.bias.norm())) << trial;
    Eigen::VectorXd F(model.velocities);
    for (int i = 0; i < model.velocities; ++i) F[i] = w.kept_k[model.pattern.GetRightSideSlot(i)];
    EXPECT_LT((K.topLeftCorner(model.velocities, model.velocities) * qdd - D * reaction - F).norm(),
              1e-9 * F.norm())
        << trial;
  }
}

}  // namespace
}  // namespace kingpin::mechanism
