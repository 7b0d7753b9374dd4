#include "optimisation/algorithms/problem.h"

#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"

namespace kingpin::optimisation {
namespace {

[[noreturn]] void Fail(std::string key, std::string found, std::string expected,
                       std::string suggestion = {}) {
  throw io::InputError({.file = {},
                        .line = 0,
                        .key = std::move(key),
                        .found = std::move(found),
                        .expected = std::move(expected),
                        .suggestion = std::move(suggestion)});
}

std::string WithUnit(double value, const Variable& variable) {
  return variable.unit.empty() ? fmt::format("{:.10g}", value)
                               : fmt::format("{:.10g} {}", value, variable.unit);
}

void CheckWithin(const Variable& variable, double value, const std::string& what) {
  if (value >= variable.lower && value <= variable.upper) return;  // false for NaN
  Fail(variable.name, fmt::format("{} {}", what, WithUnit(value, variable)),
       fmt::format("a value from {} to {}", WithUnit(variable.lower, variable),
                   WithUnit(variable.upper, variable)),
       "move the start or widen the bounds");
}

void CheckConstraintGroup(const ConstraintGroup& group, const char* kind) {
  if (!group.names.empty() && !group.values) {
    Fail(group.names.front(), "no function", fmt::format("a function for the {}", kind));
  }
}

}  // namespace

std::vector<double> Problem::GetStart() const {
  std::vector<double> start;
  for (const Variable& variable : variables) start.push_back(variable.start);
  return start;
}

bool Problem::HasConstraints() const {
  return !linear.empty() || !inequalities.names.empty() || !equalities.names.empty();
}

bool Problem::HasExactGradients() const {
  return gradient && (inequalities.names.empty() || inequalities.gradients) &&
         (equalities.names.empty() || equalities.gradients);
}

void CheckProblem(const Problem& problem) {
  if (problem.variables.empty()) {
    Fail("variables", "none", "at least one design variable");
  }
  if (!problem.objective || problem.objective_names.empty()) {
    Fail("objective", "none", "a function to minimise");
  }
  std::set<std::string> names;
  for (const Variable& variable : problem.variables) {
    if (variable.name.empty()) Fail("variables", "a variable without a name", "a name");
    if (!names.insert(variable.name).second) {
      Fail(variable.name, "the name twice", "each variable once");
    }
    for (const auto& [bound, which] :
         {std::pair{variable.lower, "lower"}, {variable.upper, "upper"}}) {
      if (!std::isfinite(bound)) {
        Fail(variable.name, fmt::format("{} bound {}", which, bound), "a finite bound");
      }
    }
    if (variable.lower > variable.upper) {
      Fail(variable.name,
           fmt::format("lower bound {} above upper bound {}", WithUnit(variable.lower, variable),
                       WithUnit(variable.upper, variable)),
           "lower <= upper", "exchange the two");
    }
    CheckWithin(variable, variable.start, "start");
  }
  for (const LinearConstraint& row : problem.linear) {
    if (row.coefficients.size() != problem.size()) {
      Fail(row.name, fmt::format("{} coefficients", row.coefficients.size()),
           fmt::format("{}, one per variable", problem.size()));
    }
    bool finite = std::isfinite(row.bound);
    for (const double a : row.coefficients) finite = finite && std::isfinite(a);
    if (!finite) Fail(row.name, "a coefficient or bound that is not finite", "finite numbers");
  }
  CheckConstraintGroup(problem.inequalities, "inequalities");
  CheckConstraintGroup(problem.equalities, "equalities");
}

void CheckPoint(const Problem& problem, std::span<const double> x, const std::string& what) {
  if (x.size() != problem.size()) {
    Fail(what, fmt::format("{} values", x.size()),
         fmt::format("{}, one per variable", problem.size()));
  }
  for (std::size_t i = 0; i < x.size(); ++i) CheckWithin(problem.variables[i], x[i], what);
}

BatchFunction MakeBatch(std::size_t variables,
                        std::function<double(std::span<const double> x)> function) {
  return [variables, function = std::move(function)](std::span<const double> points,
                                                     std::span<double> values) {
    for (std::size_t p = 0; p < values.size(); ++p) {
      values[p] = function(points.subspan(p * variables, variables));
    }
  };
}

BatchGradient MakeBatchGradient(
    std::size_t variables,
    std::function<double(std::span<const double> x, std::span<double> gradient)> function) {
  return
      [variables, function = std::move(function)](
          std::span<const double> points, std::span<double> values, std::span<double> gradients) {
        for (std::size_t p = 0; p < values.size(); ++p) {
          values[p] = function(points.subspan(p * variables, variables),
                               gradients.subspan(p * variables, variables));
        }
      };
}

}  // namespace kingpin::optimisation
