#pragma once

#include <span>
#include <string>

#include "optimisation/algorithms/algorithm.h"
#include "optimisation/algorithms/search_view.h"

namespace kingpin::optimisation {

/// How one local search runs. Steps are parts of a variable's range.
struct LocalOptions {
  Algorithm algorithm = Algorithm::kNelderMead;  ///< not kCmaEs, not kMultistart
  int max_evaluations = 2000;      ///< calls by the algorithm (a gradient counts as one)
  double step_tolerance = 1e-7;    ///< ends when the step (or simplex) is smaller
  double value_tolerance = 1e-12;  ///< relative; SLSQP, BOBYQA and COBYLA
  double initial_step = 0.1;
  /// Nelder-Mead and Sbplx start again with a new simplex at what they found, as often as this
  /// while it helps: a simplex that has collapsed on a bound is no sign of a minimum.
  int fresh_simplexes = 3;
};

/// Runs an NLopt algorithm from `start` (in u); the result is view.best(). Returns in words why it
/// ended.
///
/// - Nelder-Mead (1965, bounds after Box 1965), Sbplx (Rowan 1990, Johnson): compare values only.
///   Linear constraints by projection, f(P(u)); inequalities by Deb's rule.
/// - BOBYQA (Powell 2009): quadratic models within bounds; linear constraints by projection. With
/// one
///   variable Nelder-Mead takes its place.
/// - COBYLA (Powell 1994), SLSQP (Kraft 1988): linear and nonlinear constraints as such. A
/// Chebyshev
///   scalarisation, which has kinks, is given to SLSQP in its smooth form: minimise t with every
///   term <= t.
///
/// Bad points get a finite barrier value above all seen so far, because differences of infinities
/// would be NaN inside the models; the library's own idea of the best is not used. None of these
/// draws random numbers. Lets SearchStopped and the objective's exceptions through.
std::string RunLocalSearch(SearchView& view, const LocalOptions& options,
                           std::span<const double> start);

}  // namespace kingpin::optimisation
