#pragma once

#include <cstdint>
#include <vector>

#include "optimisation/algorithms/algorithm.h"
#include "optimisation/algorithms/cma_es.h"
#include "optimisation/algorithms/local_search.h"
#include "optimisation/algorithms/polish.h"
#include "optimisation/algorithms/problem.h"
#include "optimisation/algorithms/result.h"

namespace kingpin::optimisation {

struct MultistartOptions {
  int samples = 0;   ///< points of the first screening; 0: 32 per free variable, 128 to 1024
  int searches = 0;  ///< local searches; 0: 16 (two cores of eight lanes)
  /// Candidates are taken best first, but no two nearer than this (root mean square part of the
  /// ranges) while there are others.
  double least_distance = 0.1;
  /// One CMA-ES search beside the local ones (not with nonlinear equalities): it sees past small
  /// ripples.
  bool cma_es = true;
  long cma_es_evaluations = 3000;
  int polished = 4;  ///< of the distinct minima found, how many are polished
};

struct MinimiseOptions {
  Algorithm algorithm = Algorithm::kMultistart;
  std::uint64_t seed = 1;  ///< of sampling and CMA-ES; nothing else is random
  /// For the single algorithms, and as the local search of the multistart when `choose_local`
  /// is false. `local.algorithm` is overwritten unless the algorithm is kMultistart.
  LocalOptions local;
  /// The multistart chooses its local search and its tolerances (1e-4: polishing does the rest)
  /// itself: SLSQP with exact derivatives, COBYLA with nonlinear equalities, Nelder-Mead up to 8
  /// variables, else Sbplx.
  bool choose_local = true;
  CmaEsOptions cma_es;
  MultistartOptions multistart;
  PolishOptions polish;
  /// Further starts beside that of the problem, e.g. the result of an earlier stage: the result is
  /// never worse than any of them. Within the bounds.
  std::vector<std::vector<double>> starts;
  /// Single algorithms: so many further random starts, to see how unique the optimum is.
  int random_starts = 0;
  std::size_t concurrency = 0;     ///< searches side by side; 0: all. Does not change the result
  double cluster_distance = 0.02;  ///< of distinct minima: largest difference of a variable / range
};

/// Minimises the problem's (single) objective. The result is never worse than the start or any of
/// options.starts (by more than 1e-12 of its value), has variables exactly on their bounds where
/// the optimum lies there, and is the same bit for bit for any number of threads and any
/// concurrency (unless it was stopped from outside or by control.max_evaluations).
///
/// Throws io::InputError for an unusable problem or an algorithm that cannot treat its constraints,
/// and whatever the objective throws. A design without a finite value is a bad one, not an error;
/// result.feasible is false when there was no other.
Result Minimise(const Problem& problem, const MinimiseOptions& options = {},
                const Control& control = {});

}  // namespace kingpin::optimisation
