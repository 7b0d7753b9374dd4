#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "optimisation/algorithms/problem.h"

namespace kingpin::optimisation {

/// How far the gradients of a problem are from differences of its values.
struct GradientCheck {
  double largest_error =
      0;  ///< |exact - difference| / (|difference| + the largest in its row), scaled by ranges
  std::string worst;  ///< e.g. `objective by r_L: exact 1.2, difference 1.3`
};

/// Compares every exact derivative of the objective and constraints at `x` with a difference of
/// order four (step `relative_step` of the variable's range; x is moved inwards by two steps where
/// a bound is in the way). Problems without gradients give zero. For smooth functions expect 1e-8
/// or less.
GradientCheck CheckGradients(const Problem& problem, std::span<const double> x,
                             double relative_step = 1e-3);

}  // namespace kingpin::optimisation
