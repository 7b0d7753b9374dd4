#include "core/mechanism/dynamics.h"

#include <Eigen/Dense>

#include <gtest/gtest.h>

#include "core/mechanism/accelerations.h"
#include "core/mechanism/compile.h"
#include "core/mechanism/project.h"
#include "tests/core/mechanism/random_mechanism.h"

namespace kingpin::mechanism {
namespace {

using Matrix4 = Eigen::Matrix4d;

Matrix4 Expand(const Transform<double>& X) {
  Matrix4 T = Matrix4::Identity();
  const Vector3<double>* columns[4] = {&X.R.x, &X.R.y, &X.R.z, &X.p};
  for (int j = 0; j < 4; ++j) {
    T(0, j) = columns[j]->x, T(1, j) = columns[j]->y, T(2, j) = columns[j]->z;
  }
  return T;
}

Matrix4 Twist(const Vector3<double>& w, const Vector3<double>& v) {
  Matrix4 t;
  t << 0, -w.z, w.y, v.x, w.z, 0, -w.x, v.y, -w.y, w.x, 0, v.z, 0, 0, 0, 0;
  return t;
}

// The other route to the equations of motion: 4x4 homogeneous transforms and the trace form
//   M_jk = Σ tr(T,j H T,kᵀ),  bias_j = Σ tr(T,j H T̈ᵀ) - Σ m gᵀ T,j c,  T̈ at zero joint
//   accelerations
// with the pseudo-inertia H = ∫ r rᵀ dm of homogeneous points (d'Alembert's principle with δr = T,j
// r').
struct TraceForm {
  Eigen::MatrixXd M;
  Eigen::VectorXd bias;
};

TraceForm CalcTraceForm(const Model& model, const std::vector<double>& q,
                        const std::vector<double>& v) {
  const int links = static_cast<int>(model.links.size()), n = model.velocities;
  std::vector<Matrix4> T(links), Td(links), Tdd(links);
  std::vector<std::vector<Matrix4>> Tj(links, std::vector<Matrix4>(n, Matrix4::Zero()));
  T[0].setIdentity(), Td[0].setZero(), Tdd[0].setZero();
  TraceForm result{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (int l = 1; l < links; ++l) {
    const Link& link = model.links[l];
    const double* x = &q[link.q];
    const double* u = &v[link.v];
    const Vector3<double> ez{0, 0, 1};
    // joint transform, its derivative along each coordinate, and its second time derivative at
    // constant v; all joints here are X_FL(t) with body-fixed twist ξ (constant for constant v): Ẋ
    // = X ξ, Ẍ = X ξ² - except that a free joint's origin moves along axes that turn with the link,
    // which the same formula contains.
    Matrix4 X = Matrix4::Identity();
    std::vector<Matrix4> xi;
    switch (link.kind) {
      case JointKind::kRevolute:
      case JointKind::kScrew:
        X = Expand({internal::TurnAboutZ(Rotation<double>{}, x[0]), {0, 0, link.pitch * x[0]}});
        xi = {Twist(ez, {0, 0, link.pitch})};
        break;
      case JointKind::kPrismatic:
        X = Expand({{}, {0, 0, x[0]}});
        xi = {Twist({}, ez)};
        break;
      case JointKind::kSpherical:
        X = Expand({MakeRotation(math::Quaternion<double>{x[0], x[1], x[2], x[3]}), {}});
        for (int k = 0; k < 3; ++k)
          xi.push_back(Twist({k == 0 ? 1. : 0., k == 1 ? 1. : 0., k == 2 ? 1. : 0.}, {}));
        break;
      case JointKind::kFree:
        X = Expand(
            {MakeRotation(math::Quaternion<double>{x[3], x[4], x[5], x[6]}), {x[0], x[1], x[2]}});
        for (int k = 0; k < 3; ++k)
          xi.push_back(Twist({}, {k == 0 ? 1. : 0., k == 1 ? 1. : 0., k == 2 ? 1. : 0.}));
        for (int k = 0; k < 3; ++k)
          xi.push_back(Twist({k == 0 ? 1. : 0., k == 1 ? 1. : 0., k == 2 ? 1. : 0.}, {}));
        break;
    }
    Matrix4 twist = Matrix4::Zero();
    for (size_t i = 0; i < xi.size(); ++i) twist += u[i] * xi[i];
    const Matrix4 F = Expand(link.X_PF), Xd = X * twist, Xdd = X * twist * twist;
    const int p = link.parent;
    T[l] = T[p] * F * X;
    Td[l] = Td[p] * F * X + T[p] * F * Xd;
    Tdd[l] = Tdd[p] * F * X + 2 * Td[p] * F * Xd + T[p] * F * Xdd;
    for (int j = 0; j < n; ++j) Tj[l][j] = Tj[p][j] * F * X;
    for (size_t i = 0; i < xi.size(); ++i) Tj[l][link.v + i] = T[p] * F * X * xi[i];

    Matrix4 H = Matrix4::Zero();
    const double* J = link.central_inertia;
    const Eigen::Vector3d c(link.centre.x, link.centre.y, link.centre.z);
    Eigen::Matrix3d second;  // ∫ r rᵀ dm about the centre
    second << (-J[0] + J[1] + J[2]) / 2, -J[3], -J[4], -J[3], (J[0] - J[1] + J[2]) / 2, -J[5],
        -J[4], -J[5], (J[0] + J[1] - J[2]) / 2;
    H.topLeftCorner<3, 3>() = second + link.mass * c * c.transpose();
    H.topRightCorner<3, 1>() = link.mass * c;
    H.bottomLeftCorner<1, 3>() = link.mass * c.transpose();
    H(3, 3) = link.mass;
    const Eigen::Vector4d g(model.gravity.x, model.gravity.y, model.gravity.z, 0),
        centre(c.x(), c.y(), c.z(), 1);
    for (int j = 0; j < n; ++j) {
      const Matrix4 TjH = Tj[l][j] * H;
      for (int k = 0; k < n; ++k) result.M(j, k) += (TjH * Tj[l][k].transpose()).trace();
      result.bias[j] += (TjH * Tdd[l].transpose()).trace() - link.mass * g.dot(Tj[l][j] * centre);
    }
  }
  return result;
}

TEST(Dynamics, MassMatrixAndBiasAreThoseOfTheTraceForm) {
  RandomMechanism random(7);
  for (int trial = 0; trial < 30; ++trial) {
    Model model = random.MakeTree(1 + trial, kAllKinds);
    const std::vector<double> q = random.MakePositions(model), v = random.MakeVelocities(model);
    CompileTopology(model);
    CompileElimination(model, q, CutRule{.depth = 1000});  // whole: F is read from the equations
    Workspace<double> w(model);
    UpdatePositions(model, q.data(), w);
    UpdateVelocities(model, v.data(), w);
    const std::vector<double> none(1, 0.0);
    AssembleEquations(model, none.data(), w);
    const TraceForm wanted = CalcTraceForm(model, q, v);
    Eigen::MatrixXd M = CalcEquationMatrix(model, q);
    EXPECT_LT((M - wanted.M).norm(), 1e-12 * wanted.M.norm()) << trial;
    Eigen::VectorXd bias(model.velocities);
    for (int i = 0; i < model.velocities; ++i) bias[i] = -w.k[model.pattern.GetRightSideSlot(i)];
    EXPECT_LT((bias - wanted.bias).norm(), 1e-12 * wanted.bias.norm()) << trial;

    std::vector<double> a(model.velocities), r(1);
    Workspace<double> again(model);
    UpdatePositions(model, q.data(), again);
    UpdateVelocities(model, v.data(), again);
    SolveAccelerations(model, none, again, a, r);
    const Eigen::VectorXd exact = wanted.M.ldlt().solve(-wanted.bias);
    EXPECT_LT((Eigen::Map<Eigen::VectorXd>(a.data(), a.size()) - exact).norm(),
              1e-10 * exact.norm())
        << trial;
  }
}

}  // namespace
}  // namespace kingpin::mechanism
