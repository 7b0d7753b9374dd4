#include "optimisation/algorithms/minimise.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "core/parallel/parallel_batch.h"
#include "tests/optimisation/algorithms/test_problems.h"

namespace kingpin::optimisation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<Algorithm> kAll = {Algorithm::kNelderMead, Algorithm::kSbplx, Algorithm::kBobyqa,
                                     Algorithm::kCobyla,     Algorithm::kSlsqp, Algorithm::kCmaEs,
                                     Algorithm::kMultistart};

MinimiseOptions With(Algorithm algorithm) {
  MinimiseOptions options;
  options.algorithm = algorithm;
  return options;
}

class EveryAlgorithm : public testing::TestWithParam<Algorithm> {};
INSTANTIATE_TEST_SUITE_P(Minimise, EveryAlgorithm, testing::ValuesIn(kAll),
                         [](const auto& info) { return GetName(info.param); });

TEST_P(EveryAlgorithm, FindsTheValleyOfRosenbrock) {
  for (const bool gradient : {false, true}) {
    const Result result = Minimise(MakeRosenbrock(3, gradient), With(GetParam()));
    EXPECT_TRUE(result.feasible);
    EXPECT_LT(result.value, 1e-10) << result.status;  // 1 + f is then exact to 1e-10
    for (const double x : result.x) EXPECT_NEAR(x, 1, 1e-4);
    EXPECT_FALSE(result.status.empty());
    EXPECT_TRUE(result.active.empty());
    EXPECT_EQ(result.gradient_evaluations > 0, gradient);
  }
}

TEST_P(EveryAlgorithm, EndsExactlyOnTheBoundsOfACorner) {
  const Result result = Minimise(MakeCorner(), With(GetParam()));
  EXPECT_THAT(result.x, ElementsAre(0.2, 0.0, -0.0825));  // bit for bit
  EXPECT_EQ(result.value, CornerValue(std::vector<double>{0.2, 0.0, -0.0825}));
  ASSERT_EQ(result.active.size(), 3u);
  const std::vector<std::string> names = {"r_L", "r_X", "x_tr"};
  const std::vector<std::string> kinds = {"lower bound", "upper bound", "upper bound"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(result.active[i].name, names[i]);
    EXPECT_EQ(result.active[i].kind, kinds[i]);
    ASSERT_TRUE(result.active[i].multiplier.has_value());
    EXPECT_GT(*result.active[i].multiplier, 0);
  }
}

TEST_P(EveryAlgorithm, DoesNotMistakeAnOptimumNearABoundForOneOnIt) {
  // Minimum a ten-thousandth of the range inside: within the snapping distance, but lower than the
  // bound.
  const Problem problem = MakeTestProblem(2, 0, 1, 0.4, [](std::span<const double> x) {
    return 1 + Square(x[0] - 1e-4) + Square(x[1] - 0.7) + 0.1 * (x[0] - 1e-4) * (x[1] - 0.7);
  });
  const Result result = Minimise(problem, With(GetParam()));
  EXPECT_NEAR(result.x[0], 1e-4, 1e-6);
  EXPECT_TRUE(result.active.empty());
}

TEST_P(EveryAlgorithm, GetsAroundDesignsThatAreNotNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  // A moat of bad designs of every kind around the half plane in which start and minimum lie.
  const Problem problem = MakeTestProblem(2, -2, 2, -1, [=](std::span<const double> x) {
    if (x[0] + x[1] > 1.5) return nan;
    if (x[0] - x[1] > 1.0) return -infinity;
    if (x[1] < -1.5) return infinity;
    return 2 + Square(x[0] - 0.5) + Square(x[1] - 0.6) + Square(x[0] + 0.3 * x[1] - 0.68);
  });
  const Result result = Minimise(problem, With(GetParam()));
  EXPECT_TRUE(result.feasible);
  EXPECT_NEAR(result.value, 2, 1e-8) << result.status;
}

TEST_P(EveryAlgorithm, SaysSoWhenEveryDesignIsBad) {
  const Problem problem = MakeTestProblem(2, 0, 1, 0.5, [](std::span<const double>) {
    return std::numeric_limits<double>::quiet_NaN();
  });
  const Result result = Minimise(problem, With(GetParam()));
  EXPECT_FALSE(result.feasible);
  EXPECT_THAT(result.x, ElementsAre(0.5, 0.5));
  EXPECT_THAT(result.status, HasSubstr("no design with a finite value was found"));
}

TEST_P(EveryAlgorithm, KeepsACurveMonotone) {
  // Best values 0.1, 0.5, 0.3, 0.9 do not rise: the closest rising ones join the middle two at 0.4.
  const std::vector<double> wanted = {0.1, 0.5, 0.3, 0.9};
  Problem problem = MakeTestProblem(4, 0, 1, 0.5, [wanted](std::span<const double> x) {
    double sum = 1;
    for (std::size_t i = 0; i < 4; ++i) sum += Square(x[i] - wanted[i]);
    return sum;
  });
  problem.linear = {{"x1 <= x2", {1, -1, 0, 0}, 0, false},
                    {"x2 <= x3", {0, 1, -1, 0}, 0, false},
                    {"x3 <= x4", {0, 0, 1, -1}, 0, false}};
  const Result result = Minimise(problem, With(GetParam()));
  EXPECT_NEAR(result.value, 1.02, 1e-8) << result.status;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(result.x[i], result.x[i + 1]);  // exactly
  ASSERT_EQ(result.active.size(), 1u);
  EXPECT_EQ(result.active[0].name, "x2 <= x3");
  // By hand: -2 (0.4 - 0.5) on x2 balances the multiplier.
  EXPECT_NEAR(result.active[0].multiplier.value_or(-1), 0.2, 1e-4);
}

TEST_P(EveryAlgorithm, FulfilsLinearEqualities) {
  Problem problem = MakeTestProblem(4, -1, 1, 0, [](std::span<const double> x) {
    return 1 + Square(x[0] + 0.8) + Square(x[1] + 0.3) + Square(x[2] - 0.1) + Square(x[3] - 0.6);
  });
  problem.linear = {{"outer", {1, 0, 0, 1}, 0, true}, {"inner", {0, 1, 1, 0}, 0, true}};
  const Result result = Minimise(problem, With(GetParam()));
  // Means of the two halves: 0.7 and 0.2; the rest is 2 (0.1^2 + 0.1^2).
  EXPECT_NEAR(result.value, 1.04, 1e-7) << result.status;
  EXPECT_NEAR(result.x[3], 0.7, 1e-3);
  EXPECT_NEAR(result.x[0], -result.x[3], 1e-9);
}

TEST_P(EveryAlgorithm, SolvesHockSchittkowski35) {
  for (const bool gradient : {false, true}) {
    const Result result = Minimise(MakeHock35(gradient), With(GetParam()));
    EXPECT_NEAR(result.value, 1.0 / 9, 1e-7) << result.status;
    ASSERT_EQ(result.active.size(), 1u);
    EXPECT_EQ(result.active[0].name, "budget");
    EXPECT_NEAR(result.active[0].multiplier.value_or(-1), 2.0 / 9, 1e-3);
  }
}

TEST_P(EveryAlgorithm, IsTheSameBitForBitForAnyNumberOfThreadsAndAnyGrouping) {
  std::vector<Result> results;
  for (const auto& [threads, concurrency] :
       {std::pair<int, std::size_t>{1, 0}, {2, 0}, {5, 0}, {1, 1}, {2, 3}}) {
    ParallelBatch pool(threads);
    Problem problem = MakeTestProblem(3, -2, 2, -1.2, Rosenbrock);
    problem.objective = [&pool](std::span<const double> points, std::span<double> values) {
      pool.Run(values.size(),
               [&](std::size_t p, int) { values[p] = Rosenbrock(points.subspan(3 * p, 3)); });
    };
    MinimiseOptions options = With(GetParam());
    options.random_starts = 2;
    options.local.max_evaluations = 300;
    options.cma_es.max_evaluations = 2000;
    options.polish.max_evaluations = 100;
    options.concurrency = concurrency;
    options.multistart.searches = 5;
    results.push_back(Minimise(problem, options));
  }
  for (const Result& result : results) {
    EXPECT_EQ(result.x, results[0].x);
    EXPECT_EQ(result.value, results[0].value);
    EXPECT_EQ(result.evaluations, results[0].evaluations);
    ASSERT_EQ(result.restarts.size(), results[0].restarts.size());
    for (std::size_t k = 0; k < result.restarts.size(); ++k) {
      EXPECT_EQ(result.restarts[k].end, results[0].restarts[k].end);
      EXPECT_EQ(result.restarts[k].evaluations, results[0].restarts[k].evaluations);
    }
  }
}

TEST_P(EveryAlgorithm, StopsWithTheBestSoFarWhenCancelled) {
  int batches = 0;
  Control control;
  control.cancelled = [&] { return batches > 7; };
  double last = std::numeric_limits<double>::infinity();
  long counted = 0;
  control.progress = [&](long evaluations, double best) {
    ++batches;
    EXPECT_LE(best, last);
    EXPECT_GT(evaluations, counted);
    last = best;
    counted = evaluations;
  };
  MinimiseOptions options = With(GetParam());
  options.random_starts = 4;
  const Result result = Minimise(MakeRosenbrock(3, false), options, control);
  EXPECT_TRUE(result.cancelled);
  EXPECT_EQ(batches, 8);
  EXPECT_EQ(result.value, last);
  EXPECT_LE(result.value, result.start_value);
  EXPECT_THAT(result.status, HasSubstr("cancelled"));
}

TEST_P(EveryAlgorithm, StopsAtTheLimitOfEvaluations) {
  Control control;
  control.max_evaluations = 40;
  MinimiseOptions options = With(GetParam());
  options.multistart.samples = 16;
  const Result result = Minimise(MakeRosenbrock(3, false), options, control);
  EXPECT_LE(result.evaluations, 40 + 16 * 8);  // the batch that passes the limit is finished
  EXPECT_THAT(result.status, HasSubstr("limit of"));
  EXPECT_TRUE(result.feasible);
}

TEST_P(EveryAlgorithm, LetsExceptionsOfTheObjectiveThrough) {
  int calls = 0;
  Problem problem = MakeRosenbrock(3, false);
  problem.objective = [&](std::span<const double> points, std::span<double> values) {
    if (++calls == 6) throw std::domain_error("licence lost");
    for (std::size_t p = 0; p < values.size(); ++p)
      values[p] = Rosenbrock(points.subspan(3 * p, 3));
  };
  MinimiseOptions options = With(GetParam());
  options.random_starts = 4;
  try {
    Minimise(problem, options);
    FAIL() << "no exception";
  } catch (const std::domain_error& error) {
    EXPECT_STREQ(error.what(), "licence lost");
  }
}

TEST_P(EveryAlgorithm, NeverEndsAboveAnyOfItsStarts) {
  // Noise without any slope: whatever a search does, it cannot rely on where it goes.
  const auto noise = [](std::span<const double> x) {
    return std::fmod(std::abs(std::sin(1e5 * x[0] + 3e4 * x[1]) * 43758.5453), 1.0);
  };
  MinimiseOptions options = With(GetParam());
  options.starts = {{0.123, 0.456}, {0.9, 0.1}};
  options.cma_es.max_evaluations = 2000;
  const Result result = Minimise(MakeTestProblem(2, 0, 1, 0.3, noise), options);
  EXPECT_LE(result.value, noise(options.starts[0]));
  EXPECT_LE(result.value, noise(options.starts[1]));
  EXPECT_LE(result.value, result.start_value);
  EXPECT_EQ(result.value, noise(result.x));  // the value belongs to the design, to the last bit
}

TEST_P(EveryAlgorithm, LeavesLockedVariablesAlone) {
  Problem problem = MakeRosenbrock(3, false);
  problem.variables[1].lower = problem.variables[1].upper = problem.variables[1].start = 0.25;
  const Result result = Minimise(problem, With(GetParam()));
  EXPECT_EQ(result.x[1], 0.25);
  EXPECT_NEAR(result.x[2], 0.0625, 1e-5);
  for (Variable& variable : problem.variables) variable.lower = variable.upper = variable.start;
  const Result nothing = Minimise(problem, With(GetParam()));
  EXPECT_EQ(nothing.x, problem.GetStart());
  EXPECT_EQ(nothing.value, nothing.start_value);
}

TEST_P(EveryAlgorithm, WorksWithOneVariable) {
  const Problem problem = MakeTestProblem(
      1, 0, 4, 3.5, [](std::span<const double> x) { return 3 + std::cosh(x[0] - 1.5); });
  const Result result = Minimise(problem, With(GetParam()));
  EXPECT_NEAR(result.value, 4, 1e-12);
}

TEST(Minimise, ConstrainedAlgorithmsSolveHockSchittkowski43) {
  for (const Algorithm algorithm : {Algorithm::kCobyla, Algorithm::kSlsqp, Algorithm::kMultistart,
                                    Algorithm::kCmaEs, Algorithm::kNelderMead, Algorithm::kSbplx}) {
    const Result result = Minimise(MakeHock43(), With(algorithm));
    EXPECT_TRUE(result.feasible);
    EXPECT_NEAR(result.value, -44, 1e-5) << GetName(algorithm) << ": " << result.status;
    ASSERT_EQ(result.active.size(), 2u) << GetName(algorithm);
    EXPECT_EQ(result.active[0].name, "c1");
    EXPECT_EQ(result.active[1].name, "c3");
    EXPECT_NEAR(result.active[0].multiplier.value_or(-1), 1, 1e-2);  // the book's multipliers
    EXPECT_NEAR(result.active[1].multiplier.value_or(-1), 2, 1e-2);
  }
}

TEST(Minimise, ConstrainedAlgorithmsSolveHockSchittkowski71) {
  for (const Algorithm algorithm :
       {Algorithm::kCobyla, Algorithm::kSlsqp, Algorithm::kMultistart}) {
    const Result result = Minimise(MakeHock71(), With(algorithm));
    EXPECT_TRUE(result.feasible);
    EXPECT_NEAR(result.value, 17.0140173, 2e-6) << GetName(algorithm) << ": " << result.status;
    EXPECT_EQ(result.x[0], 1.0);
    ASSERT_EQ(result.active.size(), 3u);
    EXPECT_EQ(result.active[0].kind, "lower bound");
    EXPECT_EQ(result.active[1].kind, "inequality");
    EXPECT_EQ(result.active[2].kind, "equality");
    EXPECT_GT(result.active[0].multiplier.value_or(-1), 0);
    EXPECT_GT(result.active[1].multiplier.value_or(-1), 0);
  }
}

TEST(Minimise, GlobalStrategiesLeaveLocalMinima) {
  for (const Algorithm algorithm : {Algorithm::kMultistart, Algorithm::kCmaEs}) {
    const Result rastrigin =
        Minimise(MakeTestProblem(2, -5.12, 5.12, 4, Rastrigin), With(algorithm));
    EXPECT_NEAR(rastrigin.value, 0, 1e-8) << GetName(algorithm);
    const Result schwefel =
        Minimise(MakeTestProblem(2, -500, 500, -300, Schwefel), With(algorithm));
    EXPECT_NEAR(schwefel.value, -2 * 418.98288727, 1e-6) << GetName(algorithm);
  }
}

TEST(Minimise, TheMultistartEndsInTheSamePlaceFromTwentyStarts) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int run = 0; run < 20; ++run) {
    Problem problem = MakeTestProblem(6, 0, 1, 0.5, Hartmann6);
    for (Variable& variable : problem.variables) variable.start = uniform(engine);
    MinimiseOptions options;
    options.seed = static_cast<std::uint64_t>(run) + 1;
    const Result result = Minimise(problem, options);
    EXPECT_NEAR(result.value, -3.322368, 1e-6) << "run " << run << ": " << result.status;
  }
}

TEST(Minimise, TheRestartsSayHowUniqueTheOptimumIs) {
  // Two minima, at x1 = -1 (value 1) and x1 = +1 (value 1.2).
  const Problem problem = MakeTestProblem(2, -2, 2, 1.5, [](std::span<const double> x) {
    return 1.1 + Square(x[0] * x[0] - 1) + 0.1 * x[0] + Square(x[1] - 0.5);
  });
  MinimiseOptions options = With(Algorithm::kNelderMead);
  options.random_starts = 9;
  const Result result = Minimise(problem, options);
  EXPECT_EQ(result.restarts.size(), 10u);
  ASSERT_EQ(result.minima.size(), 2u);
  EXPECT_LT(result.minima[0].x[0], 0);
  EXPECT_GT(result.minima[1].x[0], 0);
  EXPECT_EQ(result.minima[0].searches + result.minima[1].searches, 10);
  EXPECT_NEAR(result.spread, (result.minima[1].value - result.value) / result.value, 1e-6);
  for (const Restart& restart : result.restarts) {
    const LocalMinimum& minimum = result.minima.at(restart.minimum);
    EXPECT_NEAR(restart.value, minimum.value, 1e-6);
    EXPECT_LE(restart.value, restart.start_value);
  }
  EXPECT_THAT(result.status, HasSubstr("of 2 distinct minima"));
  ASSERT_FALSE(result.history.empty());
  for (std::size_t k = 1; k < result.history.size(); ++k) {
    EXPECT_LE(result.history[k].value, result.history[k - 1].value);
    EXPECT_GE(result.history[k].evaluations, result.history[k - 1].evaluations);
  }
}

TEST(Minimise, ALevelSetOfEqualCornersDoesNotStopTheSimplex) {
  // The start simplex of a symmetric function has equal values at its corners, which says nothing.
  const Problem problem = MakeTestProblem(2, -1, 1, 0.45, [](std::span<const double> x) {
    return 1 + Square(x[0] - 0.5) + Square(x[1] - 0.5);
  });
  MinimiseOptions options = With(Algorithm::kNelderMead);
  options.polish.enabled = false;
  EXPECT_NEAR(Minimise(problem, options).value, 1, 1e-12);
}

std::string CatchInputError(const std::function<void()>& action, std::string* key = nullptr) {
  try {
    action();
  } catch (const io::InputError& error) {
    if (key != nullptr) *key = error.problem().key;
    return error.what();
  }
  return "no error";
}

TEST(Minimise, UnusableProblemsAreRefusedByName) {
  const auto message = [](const std::function<void(Problem&)>& change) {
    Problem problem = MakeCorner();
    change(problem);
    return CatchInputError([&] { Minimise(problem); });
  };
  EXPECT_EQ(message([](Problem& p) { p.variables.clear(); }),
            "variables: found none, expected at least one design variable");
  EXPECT_EQ(message([](Problem& p) { p.objective = nullptr; }),
            "objective: found none, expected a function to minimise");
  EXPECT_EQ(message([](Problem& p) { p.variables[0].lower = 0.5; }),
            "r_L: found lower bound 0.5 m above upper bound 0.4 m, expected lower <= upper; "
            "exchange the two");
  EXPECT_EQ(message([](Problem& p) { p.variables[1].start = 0.1; }),
            "r_X: found start 0.1 m, expected a value from -0.3 m to 0 m; "
            "move the start or widen the bounds");
  EXPECT_EQ(message([](Problem& p) { p.variables[1].start = std::nan(""); }),
            "r_X: found start nan m, expected a value from -0.3 m to 0 m; "
            "move the start or widen the bounds");
  EXPECT_EQ(message([](Problem& p) { p.variables[2].upper = INFINITY; }),
            "x_tr: found upper bound inf, expected a finite bound");
  EXPECT_EQ(message([](Problem& p) { p.variables[2].name = "r_L"; }),
            "r_L: found the name twice, expected each variable once");
  EXPECT_EQ(message([](Problem& p) {
              p.linear = {{"sum", {1, 1}, 0, false}};
            }),
            "sum: found 2 coefficients, expected 3, one per variable");
  EXPECT_EQ(message([](Problem& p) {
              p.objective_names = {"a", "b"};
            }),
            "objective: found 2 objectives, expected one; use nsga2 or a weighted sweep for a "
            "Pareto front");
  std::string key;
  CatchInputError(
      [&] {
        MinimiseOptions options;
        options.starts = {{0.3, -0.1, 0.0}};
        Minimise(MakeCorner(), options);
      },
      &key);
  EXPECT_EQ(key, "x_tr");
}

TEST(Minimise, AnAlgorithmThatCannotTreatAConstraintIsRefused) {
  EXPECT_EQ(CatchInputError([] { Minimise(MakeHock71(), With(Algorithm::kNelderMead)); }),
            "sphere: found nonlinear equality with algorithm nelder_mead, expected an algorithm "
            "that can treat it; use slsqp, cobyla or multistart");
  EXPECT_THAT(CatchInputError([] { Minimise(MakeHock43(), With(Algorithm::kBobyqa)); }),
              HasSubstr("c1: found nonlinear inequality with algorithm bobyqa"));
}

}  // namespace
}  // namespace kingpin::optimisation
