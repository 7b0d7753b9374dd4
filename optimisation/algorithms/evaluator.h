#pragma once

#include <cstddef>
#include <exception>
#include <vector>

#include "optimisation/algorithms/problem.h"
#include "optimisation/algorithms/result.h"

namespace kingpin::optimisation {

/// Points and what became of them. All row-major, sizes as in Problem. Bad values have been made
/// +inf.
struct Batch {
  std::size_t count = 0;
  bool with_gradients = false;
  std::vector<double> points;
  std::vector<double> objectives;
  std::vector<double> inequalities;
  std::vector<double> equalities;
  std::vector<double> objective_gradients;
  std::vector<double> inequality_gradients;
  std::vector<double> equality_gradients;

  /// Sizes every array for `count` points of `problem`.
  void Resize(const Problem& problem, std::size_t points_count, bool gradients);
};

/// Thrown out of Evaluator::Evaluate when the optimisation has to end with what it has. Algorithms
/// catch it; it never reaches the user.
struct SearchStopped {};

/// How algorithms get values. Points are clamped to the bounds before they get here.
class Evaluator {
 public:
  virtual ~Evaluator() = default;
  /// Fills in the values at batch.points. Throws SearchStopped, or what the objective throws.
  virtual void Evaluate(Batch& batch) = 0;
};

/// Asks the problem itself. Replaces bad values by +inf, works out missing gradients by central
/// differences (all their points in the same batch), counts, keeps the history, watches the limit
/// and the cancellation.
class DirectEvaluator : public Evaluator {
 public:
  /// Keeps a reference to `problem`, which has to outlive it, and a copy of `control`.
  DirectEvaluator(const Problem& problem, Control control);
  void Evaluate(Batch& batch) override;

  long evaluations() const { return evaluations_; }
  long gradient_evaluations() const { return gradient_evaluations_; }
  bool cancelled() const { return cancelled_; }
  bool exhausted() const { return exhausted_; }
  const std::vector<HistoryPoint>& history() const { return history_; }
  /// Best value of the first objective at a point whose constraints hold.
  double best() const { return best_; }

 private:
  void EvaluateValues(Batch& batch);
  void EvaluateDifferences(Batch& batch);
  void Record(const Batch& batch);

  const Problem& problem_;
  const Control control_;
  Batch stencil_;
  long evaluations_ = 0;
  long gradient_evaluations_ = 0;
  bool cancelled_ = false;
  bool exhausted_ = false;
  double best_;
  std::vector<HistoryPoint> history_;
};

/// Sum of all violations beyond the tolerance at point `index` of a batch; +inf for a bad point.
/// Linear constraints are measured as distance in variables scaled by their ranges (tolerance
/// 1e-9), nonlinear ones in their own unit (`tolerance`).
double CalcViolation(const Problem& problem, const Batch& batch, std::size_t index,
                     double tolerance = 1e-8);

/// The violation of one linear constraint, as above but signed for inequalities (negative: room
/// left).
double CalcLinearViolation(const Problem& problem, const LinearConstraint& row,
                           std::span<const double> x);

}  // namespace kingpin::optimisation
