#pragma once

#include <string>

#include "optimisation/algorithms/problem.h"

namespace kingpin::optimisation {

enum class Algorithm { kNelderMead, kSbplx, kBobyqa, kCobyla, kSlsqp, kCmaEs, kMultistart };

/// The names users write: nelder_mead, sbplx, bobyqa, cobyla, slsqp, cma_es, multistart.
std::string GetName(Algorithm algorithm);

/// Throws io::InputError when the algorithm cannot treat this problem's constraints. All treat
/// bounds and linear constraints; nonlinear inequalities need one that is not BOBYQA, nonlinear
/// equalities need COBYLA or SLSQP (also as the local search of the multistart).
void CheckSuitable(Algorithm algorithm, const Problem& problem);

}  // namespace kingpin::optimisation
