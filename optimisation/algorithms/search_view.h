#pragma once

#include <limits>
#include <span>
#include <vector>

#include "optimisation/algorithms/evaluator.h"
#include "optimisation/algorithms/search_space.h"

namespace kingpin::optimisation {

/// One number of several objectives: sum of weight_k (f_k - ideal_k) / scale_k, or with `chebyshev`
/// the largest of these terms plus a thousandth of their sum (Steuer and Choo 1983: also reaches
/// the non-convex parts of a front). Empty weights mean the first objective as it is.
struct Scalarisation {
  std::vector<double> weights;
  std::vector<double> ideal;
  std::vector<double> scale;
  bool chebyshev = false;

  double Calc(std::span<const double> objectives) const;
  double CalcTerm(std::span<const double> objectives, std::size_t k) const {
    return weights[k] * (objectives[k] - ideal[k]) / scale[k];
  }
};

/// How good a point is. Feasible points come first, by value; the others by violation (Deb 2000).
/// No comparison involves a NaN: bad points have infinite violation.
struct Merit {
  double violation = std::numeric_limits<double>::infinity();
  double value = std::numeric_limits<double>::infinity();
  bool feasible() const { return violation == 0; }
};
bool IsBetter(const Merit& a, const Merit& b);

/// What one search sees of the problem: points in the unit box of the free variables, one value
/// each, and it remembers the best point it has been shown.
class SearchView {
 public:
  SearchView(Evaluator& evaluator, const SearchSpace& space, Scalarisation scalarisation = {});

  const SearchSpace& space() const { return space_; }
  const Problem& problem() const { return space_.problem(); }

  /// Evaluates the rows of `u`. With `project`, each row is first moved into the linear constraints
  /// (a row for which there is no such point is evaluated where it is, and is infeasible).
  void Evaluate(std::span<const double> u, bool gradients = false, bool project = false);

  std::size_t count() const { return batch_.count; }
  const Merit& merit(std::size_t index) const { return merits_[index]; }
  /// The row as evaluated: after clamping and projection.
  std::span<const double> u(std::size_t index) const;
  /// Value of inequality j, then gradients with respect to u. Entries that are not finite become 0.
  double inequality(std::size_t index, std::size_t j) const;
  double equality(std::size_t index, std::size_t j) const;
  /// With a scalarisation, of the sum of its terms.
  void GetGradient(std::size_t index, std::span<double> gradient) const;
  void GetInequalityGradient(std::size_t index, std::size_t j, std::span<double> gradient) const;
  void GetEqualityGradient(std::size_t index, std::size_t j, std::span<double> gradient) const;

  const Scalarisation& scalarisation() const { return scalarisation_; }
  /// Term k of the scalarisation, and its gradient.
  double CalcTerm(std::size_t index, std::size_t k) const;
  void GetTermGradient(std::size_t index, std::size_t k, std::span<double> gradient) const;

  const Merit& best() const { return best_; }
  const std::vector<double>& best_x() const { return best_x_; }
  const std::vector<double>& best_u() const { return best_u_; }
  const std::vector<double>& best_objectives() const { return best_objectives_; }
  /// Largest and smallest finite value seen.
  double highest() const { return highest_; }
  double lowest() const { return lowest_; }
  long evaluations() const { return evaluations_; }

 private:
  void Scatter(const double* full, std::span<double> gradient) const;

  Evaluator& evaluator_;
  const SearchSpace& space_;
  Scalarisation scalarisation_;
  Batch batch_;
  std::vector<double> u_;
  std::vector<Merit> merits_;
  Merit best_;
  std::vector<double> best_x_;
  std::vector<double> best_u_;
  std::vector<double> best_objectives_;
  double highest_ = -std::numeric_limits<double>::infinity();
  double lowest_ = std::numeric_limits<double>::infinity();
  long evaluations_ = 0;
};

}  // namespace kingpin::optimisation
