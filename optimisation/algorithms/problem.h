#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace kingpin::optimisation {

/// One design variable. `lower == upper` locks it.
struct Variable {
  std::string name;
  std::string unit;
  double lower = 0;
  double upper = 1;
  double start = 0.5;
};

/// Values at many points at once. `points` holds n points row by row (n x variables), `values`
/// takes n rows of outputs (n x outputs). The caller spreads the points over SIMD lanes and cores;
/// the value of a point must not depend on which other points are in the batch. It is called on the
/// thread that called the algorithm, never by two at once. A point that is no design (diverged, not
/// finite) gets NaN or an infinity; an exception ends the whole optimisation and comes out of it.
using BatchFunction = std::function<void(std::span<const double> points, std::span<double> values)>;

/// As BatchFunction, with derivatives: `gradients` is n x outputs x variables, row-major.
using BatchGradient = std::function<void(std::span<const double> points, std::span<double> values,
                                         std::span<double> gradients)>;

/// a . x <= bound, or a . x = bound.
struct LinearConstraint {
  std::string name;
  std::vector<double> coefficients;  ///< one per variable
  double bound = 0;
  bool equality = false;
};

/// A group of nonlinear constraints evaluated together: c_j(x) <= 0, or h_j(x) = 0. Scale them so
/// that 1 is a gross violation: what counts as fulfilled is an absolute tolerance.
struct ConstraintGroup {
  std::vector<std::string> names;
  BatchFunction values;     ///< n x names
  BatchGradient gradients;  ///< optional; differences otherwise
};

/// What is minimised: objective(x) with lower <= x <= upper and the constraints. It knows nothing
/// of cars. A value of NaN or +-infinity is a bad design and counts as +infinity.
struct Problem {
  std::vector<Variable> variables;
  std::vector<std::string> objective_names = {"objective"};  ///< more than one for a Pareto front
  BatchFunction objective;                                   ///< n x objectives
  BatchGradient gradient;                                    ///< optional; differences otherwise
  std::vector<LinearConstraint> linear;
  ConstraintGroup inequalities;
  ConstraintGroup equalities;

  std::size_t size() const { return variables.size(); }
  std::vector<double> GetStart() const;
  bool HasConstraints() const;
  /// True when every value comes with an exact derivative.
  bool HasExactGradients() const;
};

/// Throws io::InputError whose key is the variable's (or constraint's) name when a bound is not
/// finite, lower exceeds upper, a start is outside its bounds, a name is missing or used twice,
/// there is no variable or no objective, or a linear constraint has the wrong number of
/// coefficients.
void CheckProblem(const Problem& problem);

/// As above for one further point, e.g. a second start. `what` names it in the message.
void CheckPoint(const Problem& problem, std::span<const double> x, const std::string& what);

/// Wraps functions of one point, for problems that have no batch form.
BatchFunction MakeBatch(std::size_t variables,
                        std::function<double(std::span<const double> x)> function);
BatchGradient MakeBatchGradient(
    std::size_t variables,
    std::function<double(std::span<const double> x, std::span<double> gradient)> function);

}  // namespace kingpin::optimisation
