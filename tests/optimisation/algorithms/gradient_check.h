#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "optimisation/algorithms/problem.h"

namespace kingpin::optimisation {

/// How far the gradients of a problem are from differences of its values.
struct GradientCheck {
  double largest_error =
      0;  ///< |exact - difference| / (|difference| + the largest in its row), scaled by ranges
  std::string worst;  ///< e.g. `objective by r_L: exact 1.2, difference 1.3`
};

inline void CheckGroup(const Problem& problem, const BatchFunction& values,
                       const BatchGradient& gradients, const std::vector<std::string>& names,
                       const std::vector<double>& x, const std::vector<double>& steps,
                       GradientCheck& check) {
  if (!gradients || names.empty()) return;
  const std::size_t n = problem.size();
  const std::size_t outputs = names.size();
  std::vector<double> value(outputs);
  std::vector<double> exact(outputs * n);
  gradients(x, value, exact);
  constexpr std::array<double, 4> kOffsets = {-2, -1, 1, 2};
  constexpr std::array<double, 4> kWeights = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
  std::vector<double> points;
  for (std::size_t i = 0; i < n; ++i) {
    for (const double offset : kOffsets) {
      points.insert(points.end(), x.begin(), x.end());
      points[points.size() - n + i] += offset * steps[i];
    }
  }
  std::vector<double> around(4 * n * outputs);
  values(points, around);
  for (std::size_t o = 0; o < outputs; ++o) {
    std::vector<double> difference(n, 0.0);
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (steps[i] == 0) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        difference[i] += kWeights[k] * around[(4 * i + k) * outputs + o] / steps[i];
      }
      largest = std::max(largest, std::abs(difference[i] * steps[i]));
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (steps[i] == 0) continue;
      const double size = std::abs(difference[i] * steps[i]) + largest;
      const double distance = std::abs(exact[o * n + i] - difference[i]) * steps[i];
      // Not finite is the worst there is.
      const double error = std::isfinite(distance) && std::isfinite(size)
                               ? (distance == 0 ? 0 : distance / std::max(size, 1e-300))
                               : std::numeric_limits<double>::infinity();
      if (error <= check.largest_error) continue;
      check.largest_error = error;
      check.worst = fmt::format("{} by {}: exact {:.10g}, difference {:.10g}", names[o],
                                problem.variables[i].name, exact[o * n + i], difference[i]);
    }
  }
}

/// Compares every exact derivative of the objective and constraints at `x` with a difference of
/// order four (step `relative_step` of the variable's range; x is moved inwards by two steps where
/// a bound is in the way). Problems without gradients give zero. For smooth functions expect 1e-8
/// or less.
inline GradientCheck CheckGradients(const Problem& problem, std::span<const double> x,
                                    double relative_step = 1e-3) {
  std::vector<double> inside(x.begin(), x.end());
  std::vector<double> steps;
  for (std::size_t i = 0; i < problem.size(); ++i) {
    const Variable& variable = problem.variables[i];
    const double h = relative_step * (variable.upper - variable.lower);
    inside[i] = std::clamp(inside[i], variable.lower + 2 * h, variable.upper - 2 * h);
    steps.push_back(h);
  }
  GradientCheck check;
  CheckGroup(problem, problem.objective, problem.gradient, problem.objective_names, inside, steps,
             check);
  CheckGroup(problem, problem.inequalities.values, problem.inequalities.gradients,
             problem.inequalities.names, inside, steps, check);
  CheckGroup(problem, problem.equalities.values, problem.equalities.gradients,
             problem.equalities.names, inside, steps, check);
  return check;
}

}  // namespace kingpin::optimisation
