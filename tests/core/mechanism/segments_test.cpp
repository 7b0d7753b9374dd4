#include "core/mechanism/segments.h"

#include <Eigen/Dense>
#include <cmath>

#include <gtest/gtest.h>

#include "core/mechanism/accelerations.h"
#include "core/mechanism/compile.h"
#include "core/mechanism/evaluator.h"
#include "core/mechanism/jacobian.h"
#include "core/mechanism/lane_accelerations.h"
#include "tests/core/mechanism/random_mechanism.h"

namespace kingpin::mechanism {
namespace {

constexpr CutRule kWhole{.depth = 1 << 20};
constexpr CutRule kShort{.depth = 0, .length = 3};

double CalcNorm(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<int>(x.size())).norm();
}

double CalcDistance(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0;
  for (size_t i = 0; i < x.size(); ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
  return std::sqrt(sum);
}

// A random tree with closures of every kind but rolling, met wherever it is.
Model MakeRandomLoops(RandomMechanism& random, int links, std::vector<double>& q) {
  Model model = random.MakeTree(links, {JointKind::kRevolute, JointKind::kRevolute,
                                        JointKind::kScrew, JointKind::kSpherical});
  q = random.MakePositions(model);
  CompileTopology(model);
  Workspace<double> w(model);
  UpdatePositions(model, q.data(), w);
  const auto add_rows = [&](int count) {
    for (int r = 0; r < count; ++r) {
      model.row_names.push_back("row " + std::to_string(model.rows++));
      model.holonomic.push_back(1);
    }
  };
  const auto to_link = [&](int l, const Vector3<double>& p) {
    return w.R[l].TransposeTimes(p - w.p[l]);
  };
  const int ends[][2] = {{3, links}, {links - 2, links / 2}, {links / 3, 1}, {links - 4, 0}};
  for (const auto& [a, b] : ends) {
    const Vector3<double> p = random.NormalVector();
    model.points.push_back({a, b, to_link(a, p), {{}, to_link(b, p)}, 3, model.rows});
    add_rows(2);
  }
  const int a = links - 1, b = 2;
  const Vector3<double> p = random.NormalVector(), d = random.NormalVector();
  model.distances.push_back({a, b, to_link(a, p), to_link(b, p + d), CalcNorm(d), model.rows});
  add_rows(1);
  const Vector3<double> u = random.UnitVector(), n = Cross(u, random.UnitVector());
  model.perpendiculars.push_back({links - 3, 4, w.R[links - 3].TransposeTimes(u),
                                  w.R[4].TransposeTimes((1.0 / CalcNorm(n)) * n), model.rows});
  add_rows(1);
  model.linear.push_back(
      {{{model.links[1].q, model.links[1].v, 2.0}, {model.links[5].q, model.links[5].v, -0.7}},
       true,
       model.rows});
  add_rows(1);
  CompileTopology(model);
  return model;
}

struct Solution {
  std::vector<double> acceleration, reaction;
};

Solution Solve(const Model& model, const std::vector<double>& q, const std::vector<double>& v,
               const std::vector<double>& force) {
  Workspace<double> w(model);
  UpdatePositions(model, q.data(), w);
  UpdateVelocities(model, v.data(), w);
  UpdateClosures(model, w);
  w.generalised = force;
  for (size_t l = 1; l < model.links.size(); ++l) {
    w.f[l] = {{0.1, 0.2 * static_cast<double>(l), -0.3}, {1, -2, 0.5}};
  }
  Solution solution{std::vector<double>(model.velocities), std::vector<double>(model.rows)};
  SolveAccelerations(model, std::vector<double>(model.rows, 0.4), w, solution.acceleration,
                     solution.reaction);
  EXPECT_FALSE(w.singular);
  return solution;
}

// Both are rounded: relative to the largest, what the conditioning of random loops leaves.
TEST(Segments, CutTreesGiveTheAccelerationsAndReactionsOfWholeOnes) {
  RandomMechanism random(31);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> q;
    Model whole = MakeRandomLoops(random, 15 + trial, q), cut = whole;
    CompileElimination(whole, q, kWhole);
    CompileElimination(cut, q, kShort);
    ASSERT_EQ(whole.CountCuts(), 0);
    ASSERT_GT(cut.CountCuts(), 0) << trial;
    const std::vector<double> v = random.MakeVelocities(whole),
                              force = random.MakeVelocities(whole);
    const Solution a = Solve(whole, q, v, force), b = Solve(cut, q, v, force);
    EXPECT_LT(CalcDistance(a.acceleration, b.acceleration), 1e-11 * CalcNorm(a.acceleration))
        << trial;
    EXPECT_LT(CalcDistance(a.reaction, b.reaction), 1e-11 * CalcNorm(a.reaction)) << trial;
  }
}

TEST(Segments, CutTreesHaveTheDerivativesOfWholeOnes) {
  RandomMechanism random(32);
  std::vector<double> q;
  System whole, cut;
  whole.model = MakeRandomLoops(random, 20, q);
  cut.model = whole.model;
  CompileElimination(whole.model, q, kWhole);
  CompileElimination(cut.model, q, kShort);
  std::vector<double> y = q;
  for (double v : random.MakeVelocities(whole.model)) y.push_back(v);
  const std::vector<double> active(whole.model.rows, 1.0);
  JacobianEvaluator of_whole(whole), of_cut(cut);
  Eigen::MatrixXd a(of_whole.rows(), of_whole.columns()), b = a;
  of_whole.Calc(0, y, active, a);
  of_cut.Calc(0, y, active, b);
  EXPECT_LT((a - b).norm(), 1e-10 * a.norm());
}

TEST(Segments, CutTreesAreProjectedOntoTheSameState) {
  RandomMechanism random(33);
  std::vector<double> q;
  System whole, cut;
  whole.model = MakeRandomLoops(random, 20, q);
  for (System* system : {&whole, &cut}) {
    system->model = whole.model;
    CompileElimination(system->model, q, system == &whole ? kWhole : kShort);
    system->drives.resize(system->model.rows);
  }
  std::vector<double> a = q;
  for (double v : random.MakeVelocities(whole.model)) a.push_back(v);
  a[whole.model.links[2].q] += 1e-3;
  std::vector<double> b = a;
  Evaluator(whole).Project(0, a, 1e-12, 1e-12);
  Evaluator(cut).Project(0, b, 1e-12, 1e-12);
  EXPECT_LT(CalcDistance(a, b), 1e-10 * CalcNorm(a));
  EXPECT_LT(Evaluator(cut).CalcResiduals(0, b).velocity, 1e-10);
}

TEST(Segments, LanesSolveCutTrees) {
  RandomMechanism random(34);
  std::vector<double> q;
  Model model = MakeRandomLoops(random, 20, q);
  CompileElimination(model, q, kShort);
  constexpr int kLanes = 8;
  const auto kernel = MakeLaneAccelerations(model, kLanes);
  std::vector<double> qs, vs, none(model.velocities * kLanes), a(none), r(model.rows * kLanes);
  const std::vector<double> v = random.MakeVelocities(model);
  for (double x : q) qs.insert(qs.end(), kLanes, x);
  for (double x : v) {
    for (int lane = 0; lane < kLanes; ++lane) vs.push_back(x * (1 + lane));
  }
  ASSERT_TRUE(kernel->Calc(qs.data(), vs.data(), none.data(), a.data(), r.data()));
  for (int lane = 0; lane < kLanes; ++lane) {
    Workspace<double> w(model);
    std::vector<double> own(v), acceleration(model.velocities), reaction(model.rows), mine;
    for (double& x : own) x *= 1 + lane;
    UpdatePositions(model, q.data(), w);
    UpdateVelocities(model, own.data(), w);
    UpdateClosures(model, w);
    SolveAccelerations(model, std::vector<double>(model.rows), w, acceleration, reaction);
    for (int i = 0; i < model.velocities; ++i) mine.push_back(a[i * kLanes + lane]);
    EXPECT_LT(CalcDistance(mine, acceleration), 1e-11 * CalcNorm(acceleration));
  }
}

// At q = 0 all links lie along a coil; neighbours of a loop are ten bodies apart.
Model MakeChain(int bodies, bool loops, bool planar, std::vector<double>& q) {
  Model model;
  model.links.emplace_back();
  std::vector<Transform<double>> X(1);
  const Vector3<double> axes[3] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  const auto get_point = [&](double n) -> Vector3<double> {
    if (planar) return {0.2 * n, 0, 0};
    return {0.1 * n, 0.2 * std::cos(0.7 * n), 0.2 * std::sin(0.7 * n)};
  };
  for (int n = 0; n < bodies; ++n) {
    X.push_back({math::MakeRotationWithZ(axes[planar ? 0 : n % 3]), get_point(n)});
    Link link;
    link.parent = n;
    link.q = link.v = n;
    link.X_PF = X[n].Inverse() * X[n + 1];
    link.mass = 1.5;
    link.centre = X[n + 1].Inverse() * get_point(n + 0.5);
    for (int i = 0; i < 3; ++i) link.central_inertia[i] = 0.02 * (1 + 0.3 * i);
    model.links.push_back(link);
    if (loops && (n + 1) % 10 == 0) {
      const int a = n + 1, b = n - 9;
      const Vector3<double> p = get_point(n + 1);
      model.points.push_back(
          {a, b, X[a].Inverse() * p, {X[b].R.Transpose(), X[b].Inverse() * p}, 7, model.rows});
      model.rows += 3;
    }
  }
  model.positions = model.velocities = bodies;
  model.row_names.resize(model.rows);
  model.holonomic.resize(model.rows, 1);
  q.assign(bodies, 0.0);
  CompileTopology(model);
  return model;
}

// The other route: a planar pendulum of rods by the forces in its joints, absolute coordinates and
// a block tridiagonal system. Rod i: m a = f_i - f_(i+1) + m g, J α = -d × f_i - d × f_(i+1), with
// d from its centre to its far end, and the joints' accelerations agree.
std::vector<double> CalcRodAccelerations(const std::vector<double>& angle,
                                         const std::vector<double>& speed, double m, double J,
                                         double length, double gravity) {
  using Vector2 = Eigen::Vector2d;
  using Matrix2 = Eigen::Matrix2d;
  const int n = static_cast<int>(angle.size());
  std::vector<Vector2> d(n), side(n);
  for (int i = 0; i < n; ++i) {
    d[i] = 0.5 * length * Vector2(std::cos(angle[i]), std::sin(angle[i]));
    side[i] = Vector2(-d[i].y(), d[i].x());  // z × d
  }
  // joint i: acceleration of rod i's near end minus that of rod i-1's far end
  std::vector<Matrix2> diagonal(n), upper(n);
  std::vector<Vector2> right(n);
  for (int i = 0; i < n; ++i) {
    const Matrix2 shared = side[i] * side[i].transpose() / J;
    diagonal[i] = Matrix2::Identity() / m + shared;
    upper[i] = -Matrix2::Identity() / m + shared;
    right[i] = Vector2(0, i == 0 ? gravity : 0) - d[i] * speed[i] * speed[i];
    if (i == 0) continue;
    diagonal[i] += Matrix2::Identity() / m + side[i - 1] * side[i - 1].transpose() / J;
    right[i] -= d[i - 1] * speed[i - 1] * speed[i - 1];
  }
  for (int i = 1; i < n; ++i) {
    const Matrix2 factor = upper[i - 1].transpose() * diagonal[i - 1].inverse();
    diagonal[i] -= factor * upper[i - 1];
    right[i] -= factor * right[i - 1];
  }
  std::vector<Vector2> f(n + 1, Vector2::Zero());
  for (int i = n - 1; i >= 0; --i) {
    f[i] = diagonal[i].inverse() * (i + 1 < n ? Vector2(right[i] - upper[i] * f[i + 1]) : right[i]);
  }
  std::vector<double> alpha(n);
  for (int i = 0; i < n; ++i) alpha[i] = -side[i].dot(f[i] + f[i + 1]) / J;
  return alpha;
}

TEST(Segments, PendulumOfAThousandRodsMovesAsItsJointForcesSay) {
  const int bodies = 1000;
  std::vector<double> q, angle(bodies), speed(bodies);
  Model model = MakeChain(bodies, false, true, q);
  model.gravity = {0, -9.81, 0};
  CompileElimination(model, q);
  EXPECT_GT(model.CountCuts(), 50);
  RandomMechanism random(35);
  std::vector<double> v(bodies);
  double sum = 0, rate = 0;
  for (int i = 0; i < bodies; ++i) {
    q[i] = 0.1 * random.Normal(), v[i] = 0.1 * random.Normal();
    angle[i] = sum += q[i], speed[i] = rate += v[i];
  }
  Workspace<double> w(model);
  UpdatePositions(model, q.data(), w);
  UpdateVelocities(model, v.data(), w);
  std::vector<double> a(bodies);
  SolveAccelerations(model, {}, w, a, {});
  EXPECT_FALSE(w.singular);
  const std::vector<double> wanted =
      CalcRodAccelerations(angle, speed, 1.5, model.links[1].central_inertia[2], 0.2, 9.81);
  std::vector<double> mine;
  double alpha = 0;
  for (double x : a) mine.push_back(alpha += x);
  EXPECT_LT(CalcDistance(mine, wanted), 1e-11 * CalcNorm(wanted));
}

TEST(Segments, CostGrowsLinearlyAlongAChain) {
  for (bool loops : {false, true}) {
    std::vector<double> q;
    const auto count = [&](int bodies) {
      Model model = MakeChain(bodies, loops, false, q);
      CompileElimination(model, q);
      return static_cast<double>(model.pattern.operations());
    };
    // the ends of the chain cost less than what is between
    const double third = count(330), two_thirds = count(660), whole = count(990);
    EXPECT_NEAR(whole - two_thirds, two_thirds - third, 0.05 * third);
    EXPECT_LT(whole, 3.3 * third);
  }
}

// A planar chain holds each of its spherical loops in a plane anyway: one row of three is
// redundant.
TEST(Segments, RedundantRowsOfCutTreesAreFound) {
  std::vector<double> q;
  Model model = MakeChain(60, true, true, q);
  for (int i = 0; i < 60; ++i) q[i] = i % 2 == 0 ? 0.2 : -0.2;
  // the points meet where the chain is now
  Workspace<double> w(model);
  UpdatePositions(model, q.data(), w);
  for (PointClosure& c : model.points) {
    c.X_BF.p = w.R[c.b].TransposeTimes(w.R[c.a] * c.p_A + w.p[c.a] - w.p[c.b]);
  }
  CompileElimination(model, q, kShort);
  ASSERT_GT(model.CountCuts(), 5);
  for (int loop = 0; loop < 6; ++loop) {
    int redundant = 0;
    for (int r = 0; r < 3; ++r) redundant += model.redundant[3 * loop + r];
    EXPECT_EQ(redundant, 1) << loop;
  }
}

}  // namespace
}  // namespace kingpin::mechanism
