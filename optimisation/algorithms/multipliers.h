#pragma once

#include <vector>

#include "optimisation/algorithms/evaluator.h"

namespace kingpin::optimisation {

/// The bounds and constraints that `x` touches, with Lagrange multipliers from least squares on
/// stationarity, grad f + sum lambda_j grad c_j = 0 over the active ones (Nocedal and Wright 2006,
/// section 12.3). Asks for one gradient; without one (search stopped, gradient not finite) the
/// multipliers stay empty. A bound counts as active within `tolerance` of the variable's range, a
/// constraint within `tolerance` in its own scale (CalcLinearViolation; the value of an
/// inequality).
std::vector<ActiveConstraint> FindActiveConstraints(Evaluator& evaluator, const Problem& problem,
                                                    const std::vector<double>& x,
                                                    double tolerance = 1e-6);

}  // namespace kingpin::optimisation
