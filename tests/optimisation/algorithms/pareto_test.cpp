#include "optimisation/algorithms/pareto.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "core/parallel/parallel_batch.h"
#include "optimisation/algorithms/nsga2.h"
#include "tests/optimisation/algorithms/test_problems.h"

namespace kingpin::optimisation {
namespace {

// Zitzler, Deb, Thiele (2000): the front is at g = 1, that is x2 = ... = xn = 0.
double CalcZdtFront(int which, double f1) {
  if (which == 1) return 1 - std::sqrt(f1);
  if (which == 2) return 1 - f1 * f1;
  return 1 - std::sqrt(f1) - f1 * std::sin(10 * std::numbers::pi * f1);
}

Problem MakeZdt(int which, std::size_t n) {
  Problem problem = MakeTestProblem(n, 0, 1, 0.5, nullptr);
  problem.objective_names = {"f1", "f2"};
  problem.objective = [=](std::span<const double> points, std::span<double> values) {
    for (std::size_t p = 0; 2 * p < values.size(); ++p) {
      const auto x = points.subspan(p * n, n);
      double g = 1;
      for (std::size_t i = 1; i < n; ++i) g += 9 * x[i] / static_cast<double>(n - 1);
      const double f1 = x[0];
      double f2 = 0;
      if (which == 1) f2 = g * (1 - std::sqrt(f1 / g));
      if (which == 2) f2 = g * (1 - Square(f1 / g));
      if (which == 3) {
        f2 = g * (1 - std::sqrt(f1 / g) - f1 / g * std::sin(10 * std::numbers::pi * f1));
      }
      values[2 * p] = f1;
      values[2 * p + 1] = f2;
    }
  };
  return problem;
}

/// Area between a front of two objectives and `reference` (Zitzler and Thiele 1998): larger is
/// better. Points that do not dominate the reference count nothing.
double CalcHypervolume(const std::vector<FrontPoint>& front, std::span<const double> reference) {
  double area = 0;
  double height = reference[1];
  for (const FrontPoint& point : FilterFront(front)) {
    if (point.objectives[0] >= reference[0] || point.objectives[1] >= height) continue;
    area += (reference[0] - point.objectives[0]) * (height - point.objectives[1]);
    height = point.objectives[1];
  }
  return area;
}

const std::vector<double> kReference = {1.1, 1.1};

/// Hypervolume of the true front, of a fine sample.
double CalcTrueHypervolume(int which) {
  std::vector<FrontPoint> front;
  for (int i = 0; i <= 4000; ++i) {
    const double f1 = i / 4000.0;
    front.push_back({{}, {f1, CalcZdtFront(which, f1)}});
  }
  return CalcHypervolume(front, kReference);
}

TEST(Hypervolume, AgreesWithTheIntegral) {
  // 1.1^2 minus the area under the curve, and the strip beyond f1 = 1; the sample loses 1/8000 of
  // it.
  EXPECT_NEAR(CalcTrueHypervolume(1), 0.1 + 2.0 / 3 + 0.11, 2e-4);
  EXPECT_NEAR(CalcTrueHypervolume(2), 0.1 + 1.0 / 3 + 0.11, 2e-4);
  EXPECT_EQ(CalcHypervolume({{{}, {2, 0}}}, kReference), 0);
  EXPECT_DOUBLE_EQ(CalcHypervolume({{{}, {0.1, 0.6}}, {{}, {0.6, 0.1}}}, kReference), 0.75);
}

TEST(Front, KeepsWhatNothingDominates) {
  const auto front = FilterFront(
      {{{1}, {1, 3}}, {{2}, {2, 2}}, {{3}, {2, 3}}, {{4}, {3, 1}}, {{5}, {2, 2}}, {{6}, {1, 4}}});
  ASSERT_EQ(front.size(), 3u);
  EXPECT_EQ(front[0].x, std::vector<double>{1});
  EXPECT_EQ(front[1].x, std::vector<double>{2});
  EXPECT_EQ(front[2].x, std::vector<double>{4});
}

TEST(Nsga2, CoversTheFrontsOfZitzlerDebThiele) {
  for (const int which : {1, 2, 3}) {
    Nsga2Options options;
    options.generations = 250;
    const Front front = RunNsga2(MakeZdt(which, 30), options);
    EXPECT_LE(front.points.size(), 64u);
    EXPECT_EQ(front.evaluations, 64 * 251);
    // Sixty-four evenly spread points themselves lose about 1 / (2 * 64) of the unit square, 0.8 %;
    // twice that is allowed.
    const double exact = CalcTrueHypervolume(which);
    EXPECT_GT(CalcHypervolume(front.points, kReference), exact - 0.016) << "ZDT" << which;
    EXPECT_LE(CalcHypervolume(front.points, kReference), exact + 1e-3);
    for (std::size_t k = 1; k < front.points.size(); ++k) {
      EXPECT_LT(front.points[k - 1].objectives[0], front.points[k].objectives[0]);
      EXPECT_GT(front.points[k - 1].objectives[1], front.points[k].objectives[1]);
    }
  }
}

TEST(Nsga2, ObeysConstraintsAndSurvivesBadDesigns) {
  Problem problem = MakeZdt(1, 4);
  problem.inequalities.names = {"f1 >= 0.3"};
  problem.inequalities.values = [](std::span<const double> points, std::span<double> values) {
    for (std::size_t p = 0; p < values.size(); ++p) values[p] = 0.3 - points[4 * p];
  };
  problem.linear = {{"x2 + x3 >= 0.2", {0, -1, -1, 0}, -0.2, false}};
  const BatchFunction inner = problem.objective;
  problem.objective = [inner](std::span<const double> points, std::span<double> values) {
    inner(points, values);
    for (std::size_t p = 0; 2 * p < values.size(); ++p) {
      if (points[4 * p] > 0.8) values[2 * p + 1] = std::nan("");
    }
  };
  const Front front = RunNsga2(problem);
  ASSERT_GT(front.points.size(), 20u);
  for (const FrontPoint& point : front.points) {
    EXPECT_GE(point.x[0], 0.3 - 1e-8);
    EXPECT_LE(point.x[0], 0.8);
    EXPECT_GE(point.x[1] + point.x[2], 0.2 - 1e-8);
    EXPECT_TRUE(std::isfinite(point.objectives[1]));
  }
  EXPECT_NEAR(front.points.front().x[0], 0.3, 0.02);
  EXPECT_NEAR(front.points.back().x[0], 0.8, 0.02);
}

TEST(Nsga2, KeepsAGivenDesignThatIsOnTheFront) {
  Problem problem = MakeZdt(1, 10);
  Nsga2Options options;
  options.generations = 5;
  options.starts = {std::vector<double>(10, 0.0)};
  options.starts[0][0] = 0.25;
  const Front front = RunNsga2(problem, options);
  bool found = false;
  for (const FrontPoint& point : front.points) found = found || point.x == options.starts[0];
  EXPECT_TRUE(found);
}

TEST(Nsga2, IsTheSameForAnyNumberOfThreads) {
  std::vector<Front> populations;
  for (const int threads : {1, 2, 5}) {
    ParallelBatch pool(threads);
    Problem problem = MakeZdt(3, 5);
    const BatchFunction inner = problem.objective;
    problem.objective = [&, inner](std::span<const double> points, std::span<double> values) {
      pool.Run(values.size() / 2, [&](std::size_t p, int) {
        inner(points.subspan(5 * p, 5), values.subspan(2 * p, 2));
      });
    };
    Nsga2Options nsga2;
    nsga2.generations = 20;
    populations.push_back(RunNsga2(problem, nsga2));
  }
  for (const Front& front : populations) {
    ASSERT_EQ(front.points.size(), populations[0].points.size());
    for (std::size_t k = 0; k < front.points.size(); ++k) {
      EXPECT_EQ(front.points[k].x, populations[0].points[k].x);
      EXPECT_EQ(front.points[k].objectives, populations[0].points[k].objectives);
    }
  }
}

TEST(Nsga2, KeepsTheFrontSoFarWhenCancelled) {
  int batches = 0;
  Control control;
  control.cancelled = [&] { return ++batches > 6; };
  const Front population = RunNsga2(MakeZdt(1, 5), {}, control);
  EXPECT_TRUE(population.cancelled);
  EXPECT_FALSE(population.points.empty());
  EXPECT_EQ(population.evaluations, 6 * 64);
}

TEST(Nsga2, RefusesWhatItCannotTreat) {
  Problem problem = MakeZdt(1, 4);
  problem.variables[2].lower = 2;
  EXPECT_THROW(RunNsga2(problem), io::InputError);
  EXPECT_THROW(RunNsga2(MakeHock71()), io::InputError);
}

}  // namespace
}  // namespace kingpin::optimisation
