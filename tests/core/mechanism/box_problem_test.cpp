#include "core/mechanism/box_problem.h"

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace kingpin::mechanism {
namespace {

// The conditions themselves, on random matrices of full and of less than full rank.
TEST(BoxProblem, EveryForceIsInItsBoxAndOpposes) {
  std::mt19937 random(20261122);
  std::normal_distribution<double> normal;
  int held = 0, moving = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const int n = 1 + trial % 6, rank = 1 + trial % std::max(1, n - (trial / 7) % n);
    const Eigen::MatrixXd J =
        Eigen::MatrixXd::NullaryExpr(n, rank, [&](auto, auto) { return normal(random); });
    const Eigen::VectorXd force =
        Eigen::VectorXd::NullaryExpr(rank, [&] { return normal(random); });
    const Eigen::MatrixXd A = J * J.transpose();
    BoxProblem box(6);
    box.Resize(n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) box.A(i, j) = A(i, j);
      box.b[i] = J.row(i).dot(force);
      box.reference[i] = 2 * A(i, i);
      box.limit[i] = trial % 5 == 0 && i == 0 ? 0 : 0.5 * std::abs(normal(random));
    }
    box.Solve();
    for (int i = 0; i < n; ++i) {
      double a = box.b[i];
      for (int j = 0; j < n; ++j) a += A(i, j) * box.R[j];
      EXPECT_NEAR(box.a[i], a, 1e-8);
      EXPECT_LE(std::abs(box.R[i]), box.limit[i] * (1 + 1e-12));
      if (box.a[i] > 0) {
        EXPECT_EQ(box.R[i], -box.limit[i]) << trial;
      }
      if (box.a[i] < 0) {
        EXPECT_EQ(box.R[i], box.limit[i]) << trial;
      }
      (box.a[i] == 0 ? held : moving) += 1;
    }
  }
  EXPECT_GT(held, 500);
  EXPECT_GT(moving, 500);
}

// One freedom, three brakes: together they hold 6, and no more.
TEST(BoxProblem, ForcesOnOneFreedomShareTheLoad) {
  for (double load : {5.9, 6.1}) {
    BoxProblem box(3);
    box.Resize(3);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) box.A(i, j) = 2;
      box.b[i] = -2 * load;
      box.reference[i] = 2;
      box.limit[i] = i + 1;
    }
    box.Solve();
    EXPECT_NEAR(box.R[0] + box.R[1] + box.R[2], std::min(load, 6.0), 1e-12);
    EXPECT_EQ(box.a[0], box.a[2]);
    EXPECT_NEAR(box.a[0], load < 6 ? 0 : -0.2, 1e-12);
    char all[] = {1, 1, 1};
    box.KeepIndependent(all);
    EXPECT_EQ(all[0] + all[1] + all[2], 1);
  }
}

// At a dead centre a force moves nothing, so it holds nothing.
TEST(BoxProblem, AForceWithoutEffectDoesNotHold) {
  BoxProblem box(1);
  box.Resize(1);
  box.A(0, 0) = 1e-20;
  box.b[0] = -3;
  box.reference[0] = 1;
  box.limit[0] = 100;
  box.Solve();
  EXPECT_EQ(box.a[0], -3);
}

}  // namespace
}  // namespace kingpin::mechanism
