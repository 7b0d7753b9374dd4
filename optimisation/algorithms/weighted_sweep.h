#pragma once

#include <cstdint>
#include <vector>

#include "optimisation/algorithms/pareto.h"
#include "optimisation/algorithms/problem.h"
#include "optimisation/algorithms/result.h"

namespace kingpin::optimisation {

struct SweepOptions {
  std::uint64_t seed = 1;
  int weights = 16;  ///< points of the front aimed at (two objectives)
  /// Largest weighted distance from the ideal point instead of the weighted sum: reaches non-convex
  /// parts too.
  bool chebyshev = true;
  int samples = 0;  ///< of the screening; 0: 32 per free variable, 128 to 1024
  int searches_per_weight = 2;
  int max_evaluations = 1000;  ///< of each search
  double step_tolerance = 1e-5;
  int rounds = 2;  ///< after the first, each weight also tries what its neighbours found
  std::vector<std::vector<double>> starts;  ///< known good designs, within the bounds
};

/// Pareto front of two objectives by minimising scalarisations (Miettinen 1999, chapters 3.1 and
/// 3.4). One screening batch serves all weights; each weight starts from the designs best for it;
/// all searches of a round run in lockstep (BatchGatherer): from each start SLSQP (exact
/// derivatives or differences; Chebyshev in its smooth form) and one that compares values, for
/// objectives with kinks (Nelder-Mead, Sbplx above 8 variables, COBYLA with nonlinear constraints).
/// The ends of the front (each objective almost alone) come first, because objectives are scaled by
/// their ranges over the non-dominated designs known by then. The front holds the non-dominated of
/// all designs that ended a search or were screened, without repetitions. Throws io::InputError as
/// Minimise() does.
Front RunWeightedSweep(const Problem& problem, const SweepOptions& options = {},
                       const Control& control = {});

}  // namespace kingpin::optimisation
