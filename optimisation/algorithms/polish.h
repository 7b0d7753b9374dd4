#pragma once

#include <vector>

#include "optimisation/algorithms/search_view.h"

namespace kingpin::optimisation {

/// A point and how good it is.
struct Design {
  std::vector<double> x;
  Merit merit;
};

struct PolishOptions {
  bool enabled = true;
  double initial_step = 1e-3;      ///< of the model-based search, part of a variable's range
  double step_tolerance = 1e-9;    ///< part of a variable's range
  double value_tolerance = 1e-14;  ///< relative
  int max_evaluations = 1000;      ///< of each refinement
  /// A variable this near to a bound (part of its range) is tried on it.
  double snap_distance = 1e-3;
};

/// Drives designs that a search has left near a minimum into it.
///
/// Each is refined twice, side by side: by SLSQP (derivatives exact, or central differences whose
/// points are one batch), and by BOBYQA (COBYLA with constraints), which also gets along with
/// kinks. The better one is kept; none ever gets worse. Then every variable within snap_distance of
/// a bound is set exactly on it, all together and one by one, the others are refined, and the
/// result is kept if the objective did not rise. So an optimum on a bound is on it bit for bit. All
/// refinements run in lockstep (BatchGatherer).
std::vector<Design> Polish(Evaluator& evaluator, const Problem& problem,
                           std::vector<Design> designs, const PolishOptions& options,
                           const Scalarisation& scalarisation = {});

}  // namespace kingpin::optimisation
