#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "optimisation/algorithms/algorithm.h"
#include "optimisation/algorithms/result.h"
#include "optimisation/study/design_evaluator.h"
#include "optimisation/study/design_space.h"
#include "optimisation/study/stage_problem.h"

/// The search of one stage.
namespace kingpin::study {

struct StageSearch {
  const DesignSpace& space;
  const planar::Parameters<double>& reference;  ///< the design whose Γ_k divide
  const std::array<double, 5>& weights;
  const std::vector<QuantityLimit>& limits;
  optimisation::Algorithm algorithm = optimisation::Algorithm::kMultistart;
  std::vector<std::vector<double>> starts{};  ///< besides the space's own
  int random_starts = 0;
  long max_evaluations = 0;  ///< 0: the algorithm's own
  std::uint64_t seed = 1;
  std::function<bool()> cancelled{};
};

struct StageSearchResult {
  optimisation::Result result;
  double seconds = 0.0;  ///< of the search itself, without the repeats from random starts
};

/// Minimises the sum of ratios in the space, from its start, from the given starts and from a
/// sample of it.
///
/// A model with switching forces is searched in two passes: globally without them (in SIMD lanes,
/// with exact derivatives), then as it is, without derivatives: from the given starts, from the
/// best of the distinct minima of the first pass, from the best of a sample, and with an evolution
/// strategy. Restarts, minima and spread are those of the second pass, in the model as it is.
///
/// With `random_starts` the whole search is repeated from so many random points; then the result's
/// restarts are these repeats. With switching forces the repeats are of the first pass; the second
/// one is run once from the best of their distinct ends, and a repeat counts with what was found
/// from its end (or, if that was not among them, with its end's value in the model as it is).
///
/// The result lies exactly on the bounds it reaches to within the search's tolerance (unless that
/// would be worse), and `active` lists all limits met within that tolerance. Multipliers are those
/// of the model without switching forces.
StageSearchResult SearchStage(const StageSearch& search, DesignEvaluator& evaluator);

/// From `x` downhill in the model as it is, without derivatives: is it a local minimum?
optimisation::Result RefineFrom(const StageSearch& search, const std::vector<double>& x,
                                DesignEvaluator& evaluator);

}  // namespace kingpin::study
