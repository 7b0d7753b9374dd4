#include "bodies/rigid_inertia.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/math/quaternion.h"
#include "tests/floating_point_traps.h"

namespace kingpin::bodies {
namespace {

void ExpectNear(const RigidInertia& a, const RigidInertia& b, double tolerance) {
  EXPECT_NEAR(a.mass, b.mass, tolerance);
  EXPECT_NEAR(CalcNorm(a.centre - b.centre), 0, tolerance);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(a.central[i], b.central[i], tolerance) << i;
}

Transform<double> MakePose(const Vector3<double>& r, const Vector3<double>& p) {
  return {math::MakeRotation(math::MakeQuaternion(r)), p};
}

TEST(RigidInertia, SolidsAreIntegralsOverTheirPoints) {
  // midpoint sums over fine grids: second order, 1e-4 with 100 cells
  const auto sum = [](double dx, double dy, double dz, const auto& inside) {
    constexpr int n = 100;
    double count = 0, xx = 0, yy = 0, zz = 0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < n; ++k) {
          const double x = dx * ((i + 0.5) / n - 0.5), y = dy * ((j + 0.5) / n - 0.5),
                       z = dz * ((k + 0.5) / n - 0.5);
          if (!inside(x, y, z)) continue;
          ++count, xx += y * y + z * z, yy += x * x + z * z, zz += x * x + y * y;
        }
      }
    }
    return RigidInertia{1, {}, {xx / count, yy / count, zz / count, 0, 0, 0}};
  };
  ExpectNear(MakeBox(1, {1, 2, 3}), sum(1, 2, 3, [](double, double, double) { return true; }),
             1e-3);
  ExpectNear(MakeSphere(1, 1),
             sum(2, 2, 2, [](double x, double y, double z) { return x * x + y * y + z * z < 1; }),
             1e-3);
  ExpectNear(
      MakeTube(1, 1, 0.5, 3),
      sum(3, 2, 2,
          [](double, double y, double z) { return y * y + z * z < 1 && y * y + z * z > 0.25; }),
      2e-3);
}

TEST(RigidInertia, PseudoInertiaAndBack) {
  const RigidInertia body = Move(MakeBox(2, {0.3, 0.4, 0.5}), MakePose({1, 2, 3}, {4, 5, 6}));
  const Eigen::Matrix4d H = CalcPseudoInertia(body);
  ExpectNear(MakeFromPseudoInertia(H), body, 1e-12);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(H).eigenvalues()[0], 0);
  // H moves like the points: T H Tᵀ
  const Transform<double> X = MakePose({-0.2, 0.5, 1}, {1, -2, 0.5});
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.col(0).head<3>() << X.R.x.x, X.R.x.y, X.R.x.z;
  T.col(1).head<3>() << X.R.y.x, X.R.y.y, X.R.y.z;
  T.col(2).head<3>() << X.R.z.x, X.R.z.y, X.R.z.z;
  T.col(3).head<3>() << X.p.x, X.p.y, X.p.z;
  EXPECT_LT((CalcPseudoInertia(Move(body, X)) - T * H * T.transpose()).cwiseAbs().maxCoeff(),
            1e-12);
}

TEST(RigidInertia, HalvesOfABoxAreTheBox) {
  const RigidInertia half = MakeBox(1, {0.5, 0.4, 0.3});
  const RigidInertia parts[] = {Move(half, {{}, {0.25, 0, 0}}), Move(half, {{}, {-0.25, 0, 0}})};
  ExpectNear(Combine(parts), MakeBox(2, {1, 0.4, 0.3}), 1e-14);
}

TEST(RigidInertia, PrincipalMomentsComeBack) {
  const Rotation<double> R = MakePose({0.4, -1, 0.3}, {}).R;
  const RigidInertia body = MakeFromPrincipalMoments(2, {1, 2, 3}, {2, 3, 4}, R);
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(MakeTensor(body.central)).eigenvalues();
  EXPECT_LT((moments - Eigen::Vector3d(2, 3, 4)).norm(), 1e-13);
  // about the axis R.y
  const Eigen::Vector3d y(R.y.x, R.y.y, R.y.z);
  EXPECT_NEAR(y.dot(MakeTensor(body.central) * y), 3, 1e-13);
}

TEST(RigidInertia, ProblemsAreFound) {
  const WithoutTraps nan_is_the_subject;
  EXPECT_FALSE(FindInertiaProblem(MakeRod(1, 2)));
  EXPECT_FALSE(FindInertiaProblem({}));
  EXPECT_EQ(FindInertiaProblem({-1, {}, {}})->part, "mass");
  EXPECT_EQ(FindInertiaProblem({0, {}, {1, 1, 1, 0, 0, 0}})->part, "mass");
  EXPECT_EQ(FindInertiaProblem({1, {}, {1, 1, 2.1, 0, 0, 0}})->found,
            "principal moments 1, 1, 2.1 kg m^2");
  EXPECT_EQ(FindInertiaProblem({1, {}, {1, 1, 1, 1.5, 0, 0}})->part, "inertia");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FindInertiaProblem({nan, {}, {}})->part, "mass");
  EXPECT_EQ(FindInertiaProblem({1, {nan, 0, 0}, {}})->part, "centre");
  EXPECT_EQ(FindInertiaProblem({1, {}, {nan, 0, 0, 0, 0, 0}})->part, "inertia");
}

}  // namespace
}  // namespace kingpin::bodies
