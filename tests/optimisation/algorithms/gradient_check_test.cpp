#include "tests/optimisation/algorithms/gradient_check.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "optimisation/algorithms/evaluator.h"
#include "tests/optimisation/algorithms/test_problems.h"

namespace kingpin::optimisation {
namespace {

TEST(GradientCheck, ExactGradientsPassAlsoOnBounds) {
  // Fourth-order differences of polynomials of degree four or less have rounding error only.
  EXPECT_LT(
      CheckGradients(MakeRosenbrock(4, true), std::vector<double>{0.3, -1, 2, -2}).largest_error,
      1e-9);
  EXPECT_LT(CheckGradients(MakeHock71(), std::vector<double>{1, 5, 5, 1}).largest_error, 1e-9);
  EXPECT_LT(CheckGradients(MakeHock35(true), std::vector<double>{0, 3, 1}).largest_error, 1e-9);
}

TEST(GradientCheck, AWrongEntryIsNamed) {
  Problem problem = MakeHock71();
  const BatchGradient right = problem.inequalities.gradients;
  problem.inequalities.gradients = [right](std::span<const double> points, std::span<double> values,
                                           std::span<double> gradients) {
    right(points, values, gradients);
    gradients[2] *= 1.01;
  };
  const GradientCheck check = CheckGradients(problem, std::vector<double>{2, 3, 4, 2});
  EXPECT_GT(check.largest_error, 1e-3);
  EXPECT_THAT(check.worst, testing::StartsWith("product by x3: exact -12.12, difference -12"));
}

TEST(GradientCheck, ANotANumberIsTheWorstError) {
  Problem problem = MakeRosenbrock(2, true);
  problem.gradient = [](std::span<const double>, std::span<double> values,
                        std::span<double> gradients) {
    values[0] = 0;
    gradients[0] = gradients[1] = std::nan("");
  };
  EXPECT_TRUE(std::isinf(CheckGradients(problem, std::vector<double>{0, 0}).largest_error));
}

TEST(Differences, AgreeWithExactGradientsInsideAndOnBounds) {
  const Problem exact = MakeHock71();
  Problem without = exact;
  without.gradient = nullptr;
  const Control control;
  DirectEvaluator a(exact, control);
  DirectEvaluator b(without, control);
  Batch one, two;
  one.Resize(exact, 3, true);
  one.points = {1, 5, 5, 1, 2.5, 3.5, 1.5, 4.5, 5, 1, 1, 5};
  two = one;
  a.Evaluate(one);
  b.Evaluate(two);
  EXPECT_EQ(b.evaluations(), 3 * 9);
  EXPECT_EQ(b.gradient_evaluations(), 0);
  EXPECT_EQ(one.objectives, two.objectives);
  const auto compare = [](const std::vector<double>& x, const std::vector<double>& y) {
    ASSERT_EQ(x.size(), y.size());
    // Step 2.4e-5, values to 100: rounding 1e-14 * 100 / 2.4e-5, truncation below it.
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], 5e-8);
  };
  compare(one.objective_gradients, two.objective_gradients);
  compare(one.inequality_gradients, two.inequality_gradients);
  compare(one.equality_gradients, two.equality_gradients);
}

}  // namespace
}  // namespace kingpin::optimisation
