// What the machinery of the optimisation costs beside the objective: per evaluation of searches in
// lockstep, and per batch handed to the pool.
#include <cmath>
#include <span>

#include <benchmark/benchmark.h>

#include "core/parallel/parallel_batch.h"
#include "optimisation/algorithms/batch_gatherer.h"
#include "optimisation/algorithms/minimise.h"

namespace kingpin::optimisation {
namespace {

Problem MakeBowl() {
  Problem problem;
  for (const char* name : {"a", "b", "c", "d"}) problem.variables.push_back({name, "", 0, 1, 0.8});
  problem.objective = MakeBatch(4, [](std::span<const double> x) {
    double sum = 0;
    for (const double value : x) sum += (value - 0.3) * (value - 0.3);
    return sum;
  });
  return problem;
}

// The time of one evaluation by one of many searches: switching fibres, gathering, scattering,
// counting.
void GathererPerEvaluation(benchmark::State& state) {
  const Problem problem = MakeBowl();
  const Control control;
  const auto searches = static_cast<int>(state.range(0));
  constexpr int kEvaluations = 1000;
  for ([[maybe_unused]] auto step : state) {
    DirectEvaluator direct(problem, control);
    BatchGatherer gatherer(problem, direct);
    for (int k = 0; k < searches; ++k) {
      gatherer.Add([&](Evaluator& evaluator) {
        Batch batch;
        batch.Resize(problem, 1, false);
        batch.points.assign(4, 0.5);
        for (int i = 0; i < kEvaluations; ++i) evaluator.Evaluate(batch);
      });
    }
    gatherer.Run();
  }
  state.SetItemsProcessed(state.iterations() * searches * kEvaluations);
}
BENCHMARK(GathererPerEvaluation)->Arg(1)->Arg(16)->Arg(64);

// The same with a real search; items are evaluations of the objective.
void MultistartPerEvaluation(benchmark::State& state) {
  const Problem problem = MakeBowl();
  long evaluations = 0;
  for ([[maybe_unused]] auto step : state) evaluations += Minimise(problem).evaluations;
  state.SetItemsProcessed(evaluations);
}
BENCHMARK(MultistartPerEvaluation);

// Handing two empty blocks to a pool of as many threads as given.
void PoolHandOver(benchmark::State& state) {
  ParallelBatch pool(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto step : state) pool.Run(2, [](std::size_t, int) {});
}
BENCHMARK(PoolHandOver)->Arg(1)->Arg(2)->UseRealTime();

}  // namespace
}  // namespace kingpin::optimisation

BENCHMARK_MAIN();
