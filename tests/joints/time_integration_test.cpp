#include <gtest/gtest.h>

#include "core/solve/rosenbrock.h"
#include "core/solve/runge_kutta4.h"
#include "tests/joints/example_mechanisms.h"

namespace kingpin::joints {
namespace {

enum class Method { kRungeKutta4, kRosenbrock, kRosenbrockOldJacobian };

std::vector<double> Integrate(const Mechanism& mechanism, Method method, double duration,
                              int steps) {
  mechanism::Evaluator evaluator(mechanism.system);
  solve::RungeKutta4 runge_kutta(mechanism.system);
  solve::Rosenbrock rosenbrock(mechanism.system);
  std::vector<double> y = mechanism.start;
  const double h = duration / steps;
  for (int n = 0; n < steps; ++n) {
    if (method == Method::kRungeKutta4) {
      runge_kutta.Step(evaluator, n * h, h, y);
    } else {
      // the old Jacobian is that of the start, wrong by any measure after a while
      if (n == 0 || method == Method::kRosenbrock) rosenbrock.UpdateJacobian(evaluator, n * h, y);
      rosenbrock.Step(evaluator, n * h, h, y);
    }
    evaluator.Project((n + 1) * h, y, 1e-13, 1e-13);
  }
  return y;
}

double CalcDistance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

double CalcOrder(const Mechanism& mechanism, Method method, double duration, int steps) {
  const std::vector<double> exact =
      Integrate(mechanism, Method::kRungeKutta4, duration, 16 * steps);
  const double coarse = CalcDistance(Integrate(mechanism, method, duration, steps), exact);
  const double fine = CalcDistance(Integrate(mechanism, method, duration, 2 * steps), exact);
  return std::log2(coarse / fine);
}

TEST(TimeIntegration, KeepsItsOrderOnATree) {
  const Mechanism top = MakeMechanism(MakeHeavyTop());
  EXPECT_NEAR(CalcOrder(top, Method::kRungeKutta4, 0.2, 400), 4, 0.2);
  EXPECT_NEAR(CalcOrder(top, Method::kRosenbrock, 0.2, 800), 3, 0.2);
  EXPECT_NEAR(CalcOrder(top, Method::kRosenbrockOldJacobian, 0.2, 800), 3, 0.2);
}

TEST(TimeIntegration, KeepsItsOrderOnAClosedLoop) {
  const Mechanism four_bar = MakeMechanism(MakeFourBar(5));
  EXPECT_NEAR(CalcOrder(four_bar, Method::kRungeKutta4, 1, 800), 4, 0.2);
  EXPECT_NEAR(CalcOrder(four_bar, Method::kRosenbrock, 1, 1600), 3, 0.2);
  EXPECT_NEAR(CalcOrder(four_bar, Method::kRosenbrockOldJacobian, 1, 1600), 3, 0.2);
}

TEST(TimeIntegration, EnergyIsConservedOnTheFourBar) {
  const Mechanism four_bar = MakeMechanism(MakeFourBar(5));
  mechanism::Evaluator evaluator(four_bar.system);
  const mechanism::Energy before = evaluator.CalcEnergy(0, four_bar.start);
  const mechanism::Energy after =
      evaluator.CalcEnergy(2, Integrate(four_bar, Method::kRungeKutta4, 2, 8000));
  EXPECT_NEAR(after.kinetic + after.potential, before.kinetic + before.potential,
              1e-8 * before.kinetic);
  EXPECT_GT(std::abs(after.kinetic - before.kinetic), 1e-2 * before.kinetic);  // something happened
}

TEST(TimeIntegration, TheFourBarHasOneRedundantRow) {
  const Mechanism four_bar = MakeMechanism(MakeFourBar(5));
  ASSERT_EQ(four_bar.system.model.rows, 3);
  int redundant = 0;
  for (char r : four_bar.system.model.redundant) redundant += r;
  EXPECT_EQ(redundant, 1);
  EXPECT_TRUE(four_bar.system.model.redundant[1]);  // y, out of the plane
}

}  // namespace
}  // namespace kingpin::joints
