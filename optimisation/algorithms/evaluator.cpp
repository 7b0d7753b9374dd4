#include "optimisation/algorithms/evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kingpin::optimisation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLinearTolerance = 1e-9;
// Cube root of the rounding error: the best step of a central difference of a smooth function.
constexpr double kDifferenceStep = 6e-6;

void MakeBadInfinite(std::vector<double>& values) {
  for (double& value : values) {
    if (!std::isfinite(value)) value = kInfinity;
  }
}

}  // namespace

void Batch::Resize(const Problem& problem, std::size_t points_count, bool gradients) {
  const std::size_t n = problem.size();
  count = points_count;
  with_gradients = gradients;
  points.resize(count * n);
  objectives.resize(count * problem.objective_names.size());
  inequalities.resize(count * problem.inequalities.names.size());
  equalities.resize(count * problem.equalities.names.size());
  const std::size_t width = gradients ? n : 0;
  objective_gradients.resize(objectives.size() * width);
  inequality_gradients.resize(inequalities.size() * width);
  equality_gradients.resize(equalities.size() * width);
}

DirectEvaluator::DirectEvaluator(const Problem& problem, Control control)
    : problem_(problem), control_(std::move(control)), best_(kInfinity) {}

void DirectEvaluator::Evaluate(Batch& batch) {
  if (control_.cancelled && control_.cancelled()) cancelled_ = true;
  if (control_.max_evaluations > 0 && evaluations_ >= control_.max_evaluations) exhausted_ = true;
  if (cancelled_ || exhausted_) throw SearchStopped{};
  if (batch.count == 0) return;
  if (!batch.with_gradients) {
    EvaluateValues(batch);
  } else if (!problem_.HasExactGradients()) {
    EvaluateDifferences(batch);
  } else {
    problem_.gradient(batch.points, batch.objectives, batch.objective_gradients);
    if (!batch.inequalities.empty()) {
      problem_.inequalities.gradients(batch.points, batch.inequalities, batch.inequality_gradients);
    }
    if (!batch.equalities.empty()) {
      problem_.equalities.gradients(batch.points, batch.equalities, batch.equality_gradients);
    }
    evaluations_ += static_cast<long>(batch.count);
    gradient_evaluations_ += static_cast<long>(batch.count);
    MakeBadInfinite(batch.objectives);
    MakeBadInfinite(batch.inequalities);
    MakeBadInfinite(batch.equalities);
  }
  Record(batch);
  if (control_.progress) control_.progress(evaluations_, best_);
}

void DirectEvaluator::EvaluateValues(Batch& batch) {
  problem_.objective(batch.points, batch.objectives);
  if (!batch.inequalities.empty()) {
    problem_.inequalities.values(batch.points, batch.inequalities);
  }
  if (!batch.equalities.empty()) problem_.equalities.values(batch.points, batch.equalities);
  evaluations_ += static_cast<long>(batch.count);
  MakeBadInfinite(batch.objectives);
  MakeBadInfinite(batch.inequalities);
  MakeBadInfinite(batch.equalities);
}

void DirectEvaluator::EvaluateDifferences(Batch& batch) {
  const std::size_t n = problem_.size();
  // Of each point: itself, then two neighbours per variable. At a bound both lie on the inner side
  // (h and 2h), for a one-sided difference of the same order.
  const std::size_t per_point = 1 + 2 * n;
  stencil_.Resize(problem_, batch.count * per_point, false);
  std::vector<double> first(batch.count * n);
  std::vector<double> second(batch.count * n);
  for (std::size_t p = 0; p < batch.count; ++p) {
    const double* x = batch.points.data() + p * n;
    double* row = stencil_.points.data() + p * per_point * n;
    for (std::size_t k = 0; k < per_point; ++k) std::copy_n(x, n, row + k * n);
    for (std::size_t i = 0; i < n; ++i) {
      const Variable& variable = problem_.variables[i];
      const double h = kDifferenceStep * (variable.upper - variable.lower);
      double& a = row[(1 + 2 * i) * n + i];
      double& b = row[(2 + 2 * i) * n + i];
      if (x[i] + h > variable.upper) {
        a = x[i] - h;
        b = x[i] - 2 * h;
      } else if (x[i] - h < variable.lower) {
        a = x[i] + h;
        b = x[i] + 2 * h;
      } else {
        a = x[i] + h;
        b = x[i] - h;
      }
      first[p * n + i] = a - x[i];  // as stored, so that rounding of x drops out
      second[p * n + i] = b - x[i];
    }
  }
  EvaluateValues(stencil_);
  const auto differentiate = [&](const std::vector<double>& values, std::vector<double>& out_values,
                                 std::vector<double>& gradients, std::size_t outputs) {
    for (std::size_t p = 0; p < batch.count; ++p) {
      for (std::size_t o = 0; o < outputs; ++o) {
        const auto at = [&](std::size_t k) { return values[(p * per_point + k) * outputs + o]; };
        const double f = at(0);
        out_values[p * outputs + o] = f;
        for (std::size_t i = 0; i < n; ++i) {
          const double s = first[p * n + i];
          const double t = second[p * n + i];
          const double fs = at(1 + 2 * i) - f;
          const double ft = at(2 + 2 * i) - f;
          double slope = 0;
          if (s != 0 && std::isfinite(f)) {  // s is zero for a locked variable
            if (std::isfinite(fs) && std::isfinite(ft)) {
              slope = (fs * t / s - ft * s / t) / (t - s);  // of the parabola through the three
            } else if (std::isfinite(fs)) {
              slope = fs / s;
            } else if (std::isfinite(ft)) {
              slope = ft / t;
            }
          }
          gradients[(p * outputs + o) * n + i] = slope;
        }
      }
    }
  };
  differentiate(stencil_.objectives, batch.objectives, batch.objective_gradients,
                problem_.objective_names.size());
  differentiate(stencil_.inequalities, batch.inequalities, batch.inequality_gradients,
                problem_.inequalities.names.size());
  differentiate(stencil_.equalities, batch.equalities, batch.equality_gradients,
                problem_.equalities.names.size());
}

void DirectEvaluator::Record(const Batch& batch) {
  const std::size_t objectives = problem_.objective_names.size();
  bool better = false;
  for (std::size_t p = 0; p < batch.count; ++p) {
    const double value = batch.objectives[p * objectives];
    if (value < best_ && CalcViolation(problem_, batch, p) == 0) {
      best_ = value;
      better = true;
    }
  }
  if (better) history_.push_back({evaluations_, best_});
}

double CalcLinearViolation(const Problem& problem, const LinearConstraint& row,
                           std::span<const double> x) {
  double sum = 0;
  double norm = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double range = problem.variables[i].upper - problem.variables[i].lower;
    sum += row.coefficients[i] * x[i];
    norm += row.coefficients[i] * row.coefficients[i] * range * range;
  }
  const double excess = sum - row.bound;
  const double scaled = norm > 0 ? excess / std::sqrt(norm) : excess;
  return row.equality ? std::abs(scaled) : scaled;
}

double CalcViolation(const Problem& problem, const Batch& batch, std::size_t index,
                     double tolerance) {
  const std::size_t objectives = problem.objective_names.size();
  for (std::size_t o = 0; o < objectives; ++o) {
    if (!std::isfinite(batch.objectives[index * objectives + o])) return kInfinity;
  }
  double total = 0;
  const std::size_t n = problem.size();
  const std::span<const double> x(batch.points.data() + index * n, n);
  for (const LinearConstraint& row : problem.linear) {
    total += std::max(0.0, CalcLinearViolation(problem, row, x) - kLinearTolerance);
  }
  const std::size_t inequalities = problem.inequalities.names.size();
  for (std::size_t j = 0; j < inequalities; ++j) {
    total += std::max(0.0, batch.inequalities[index * inequalities + j] - tolerance);
  }
  const std::size_t equalities = problem.equalities.names.size();
  for (std::size_t j = 0; j < equalities; ++j) {
    total += std::max(0.0, std::abs(batch.equalities[index * equalities + j]) - tolerance);
  }
  return total;
}

}  // namespace kingpin::optimisation
