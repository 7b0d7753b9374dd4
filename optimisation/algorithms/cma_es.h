#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "optimisation/algorithms/search_view.h"

namespace kingpin::optimisation {

/// Covariance matrix adaptation evolution strategy (Hansen and Ostermeier 2001; formulas and
/// default constants of Hansen, The CMA evolution strategy: a tutorial, 2016, with negative
/// weights), with restarts BIPOP (Hansen 2009) or IPOP (Auger and Hansen 2005). The population is
/// one batch.
///
/// Bounds by a smooth folding of the variables (as in Hansen's own programs): in the folded
/// variable an optimum on a bound is an ordinary minimum. Linear constraints by projection,
/// f(P(u)); nonlinear inequalities by Deb's rule. Steps are parts of a variable's range.
struct CmaEsOptions {
  enum class Restarts { kNone, kIpop, kBipop };
  std::uint64_t seed = 1;
  double initial_step = 0.3;
  int population = 0;  ///< 0: 4 + 3 ln n, rounded up to a multiple of 8 (the SIMD lanes)
  long max_evaluations = 20000;
  double step_tolerance = 1e-9;
  double value_tolerance = 1e-12;  ///< relative, over the last generations
  Restarts restarts = Restarts::kBipop;
  int max_restarts = 9;  ///< with doubled populations; the short ones between them do not count
};

/// The result is view.best(); returns in words why it ended. Lets SearchStopped and the objective's
/// exceptions through.
std::string RunCmaEs(SearchView& view, const CmaEsOptions& options, std::span<const double> start);

}  // namespace kingpin::optimisation
