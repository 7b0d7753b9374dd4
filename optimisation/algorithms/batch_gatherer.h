#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "optimisation/algorithms/evaluator.h"

namespace kingpin::optimisation {

/// Runs many searches in lockstep. Every search is written (or called back by a library) as if it
/// were alone; each lives on a fibre. When all of them wait for a value, their points go out as one
/// batch, which the objective spreads over SIMD lanes and cores. A sequential Nelder-Mead then
/// costs one lane instead of a whole machine.
///
/// A search sees its own values only, so what it does depends neither on the number of threads nor
/// on which other searches run beside it. Searches that end drop out and make room for waiting
/// ones.
///
/// An exception from the objective or from a search ends all searches (each gets SearchStopped, so
/// that it unwinds in good order) and comes out of Run(). SearchStopped from the evaluator
/// (cancellation, limit) ends all searches in the same way, but Run() then returns normally.
class BatchGatherer {
 public:
  /// At most `concurrency` searches at a time; 0 is all at once.
  BatchGatherer(const Problem& problem, Evaluator& evaluator, std::size_t concurrency = 0);
  ~BatchGatherer();

  /// `search` runs in Run(), with an evaluator of its own. It has to let SearchStopped through or
  /// return soon after it.
  void Add(std::function<void(Evaluator&)> search);

  /// Returns when all searches have ended.
  void Run();

 private:
  struct Search;
  void EvaluatePending(bool gradients);

  const Problem& problem_;
  Evaluator& evaluator_;
  std::size_t concurrency_;
  std::vector<std::unique_ptr<Search>> searches_;
  std::vector<Search*> active_;
  Batch merged_;
};

}  // namespace kingpin::optimisation
