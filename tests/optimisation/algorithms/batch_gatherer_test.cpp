#include "optimisation/algorithms/batch_gatherer.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "optimisation/algorithms/local_search.h"
#include "tests/optimisation/algorithms/test_problems.h"

namespace kingpin::optimisation {
namespace {

/// Asks `count` times for one point and adds up the values.
std::function<void(Evaluator&)> MakeAsker(const Problem& problem, int count, double& sum) {
  return [&problem, count, &sum](Evaluator& evaluator) {
    Batch batch;
    batch.Resize(problem, 1, false);
    for (int i = 0; i < count; ++i) {
      batch.points = {0.01 * i, 0.02 * i};
      evaluator.Evaluate(batch);
      sum += batch.objectives[0];
    }
  };
}

TEST(BatchGatherer, WaitingSearchesShareBatchesAndDropOutWhenDone) {
  std::vector<std::size_t> sizes;
  Problem problem = MakeTestProblem(2, 0, 1, 0.5, Rosenbrock);
  const BatchFunction inner = problem.objective;
  problem.objective = [&](std::span<const double> points, std::span<double> values) {
    sizes.push_back(values.size());
    inner(points, values);
  };
  const Control control;
  DirectEvaluator direct(problem, control);
  BatchGatherer gatherer(problem, direct);
  std::vector<double> sums(5, 0.0);
  const std::vector<int> counts = {3, 1, 0, 5, 3};
  for (std::size_t k = 0; k < 5; ++k) gatherer.Add(MakeAsker(problem, counts[k], sums[k]));
  gatherer.Run();
  EXPECT_EQ(sizes, (std::vector<std::size_t>{4, 3, 3, 1, 1}));
  EXPECT_EQ(direct.evaluations(), 12);
  EXPECT_EQ(sums[0], sums[4]);
  EXPECT_EQ(sums[2], 0);
}

TEST(BatchGatherer, WaitingSearchesTakeTheSeatsOfThoseThatEnd) {
  std::vector<std::size_t> sizes;
  Problem problem = MakeTestProblem(2, 0, 1, 0.5, Rosenbrock);
  const BatchFunction inner = problem.objective;
  problem.objective = [&](std::span<const double> points, std::span<double> values) {
    sizes.push_back(values.size());
    inner(points, values);
  };
  const Control control;
  DirectEvaluator direct(problem, control);
  BatchGatherer gatherer(problem, direct, 2);
  std::vector<double> sums(4, 0.0);
  for (double& sum : sums) gatherer.Add(MakeAsker(problem, 3, sum));
  gatherer.Run();
  EXPECT_EQ(sizes, std::vector<std::size_t>(6, 2));
}

TEST(BatchGatherer, ASearchThatThrowsEndsTheOthersInGoodOrder) {
  Problem problem = MakeTestProblem(2, 0, 1, 0.5, Rosenbrock);
  const Control control;
  DirectEvaluator direct(problem, control);
  BatchGatherer gatherer(problem, direct);
  bool unwound = false;
  double sum = 0;
  gatherer.Add([&](Evaluator& evaluator) {
    struct Guard {
      bool& flag;
      ~Guard() { flag = true; }
    } guard{unwound};
    MakeAsker(problem, 1000, sum)(evaluator);
  });
  gatherer.Add([&](Evaluator& evaluator) {
    MakeAsker(problem, 3, sum)(evaluator);
    throw std::runtime_error("second search");
  });
  EXPECT_THROW(gatherer.Run(), std::runtime_error);
  EXPECT_TRUE(unwound);
  EXPECT_LE(direct.evaluations(), 8);
}

TEST(BatchGatherer, SixteenSimplexesFillTheLanes) {
  long batches = 0;
  long points_in_all = 0;
  Problem problem = MakeTestProblem(2, -2, 2, 0.5, Rosenbrock);
  const BatchFunction inner = problem.objective;
  problem.objective = [&](std::span<const double> points, std::span<double> values) {
    ++batches;
    points_in_all += static_cast<long>(values.size());
    inner(points, values);
  };
  const Control control;
  DirectEvaluator direct(problem, control);
  const SearchSpace space(problem, problem.GetStart());
  std::vector<long> alone;
  std::vector<double> ends;
  for (const std::size_t concurrency : {1, 0}) {
    batches = points_in_all = 0;
    BatchGatherer gatherer(problem, direct, concurrency);
    std::vector<double> found(16);
    for (int k = 0; k < 16; ++k) {
      gatherer.Add([&, k](Evaluator& evaluator) {
        SearchView view(evaluator, space);
        LocalOptions options;
        options.fresh_simplexes = 0;
        const double a = k / 16.0;
        RunLocalSearch(view, options, std::vector<double>{a, 1 - a});
        found[k] = view.best().value;
      });
    }
    gatherer.Run();
    alone.push_back(batches);
    if (ends.empty()) ends = found;
    EXPECT_EQ(found, ends);  // bit for bit, whoever runs beside it
  }
  EXPECT_GT(static_cast<double>(points_in_all) / static_cast<double>(alone[1]), 8);
  EXPECT_LT(alone[1], alone[0] / 8);
}

}  // namespace
}  // namespace kingpin::optimisation
