#include "optimisation/algorithms/search_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kingpin::optimisation {

double Scalarisation::Calc(std::span<const double> objectives) const {
  if (weights.empty()) return objectives[0];
  double sum = 0;
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double term = CalcTerm(objectives, k);
    sum += term;
    largest = std::max(largest, term);
  }
  return chebyshev ? largest + 1e-3 * sum : sum;
}

bool IsBetter(const Merit& a, const Merit& b) {
  if (a.violation != b.violation) return a.violation < b.violation;
  return a.value < b.value;
}

SearchView::SearchView(Evaluator& evaluator, const SearchSpace& space, Scalarisation scalarisation)
    : evaluator_(evaluator), space_(space), scalarisation_(std::move(scalarisation)) {}

void SearchView::Evaluate(std::span<const double> u, bool gradients, bool project) {
  const std::size_t dim = space_.size();
  const std::size_t n = problem().size();
  // Without free variables every call is about the one point there is.
  const std::size_t count = dim > 0 ? u.size() / dim : 1;
  batch_.Resize(problem(), count, gradients);
  u_.assign(u.begin(), u.end());
  for (std::size_t p = 0; p < count; ++p) {
    const std::span<double> row(u_.data() + p * dim, dim);
    for (double& value : row) {
      if (!std::isfinite(value)) value = 0.5;  // never let a NaN reach the caller's model
      value = std::clamp(value, 0.0, 1.0);
    }
    if (project) space_.Project(row);
    space_.CalcX(row, std::span<double>(batch_.points.data() + p * n, n));
  }
  evaluator_.Evaluate(batch_);
  evaluations_ += static_cast<long>(count);
  merits_.resize(count);
  const std::size_t objectives = problem().objective_names.size();
  for (std::size_t p = 0; p < count; ++p) {
    Merit& merit = merits_[p];
    merit.violation = CalcViolation(problem(), batch_, p);
    merit.value = scalarisation_.Calc({batch_.objectives.data() + p * objectives, objectives});
    if (!std::isfinite(merit.value)) merit = Merit{};
    if (std::isfinite(merit.value)) {
      highest_ = std::max(highest_, merit.value);
      lowest_ = std::min(lowest_, merit.value);
    }
    if (best_x_.empty() || IsBetter(merit, best_)) {
      best_ = merit;
      best_x_.assign(batch_.points.begin() + static_cast<std::ptrdiff_t>(p * n),
                     batch_.points.begin() + static_cast<std::ptrdiff_t>((p + 1) * n));
      const auto from = batch_.objectives.begin() + static_cast<std::ptrdiff_t>(p * objectives);
      best_objectives_.assign(from, from + static_cast<std::ptrdiff_t>(objectives));
      const auto row = this->u(p);
      best_u_.assign(row.begin(), row.end());
    }
  }
}

std::span<const double> SearchView::u(std::size_t index) const {
  return {u_.data() + index * space_.size(), space_.size()};
}

double SearchView::inequality(std::size_t index, std::size_t j) const {
  return batch_.inequalities[index * problem().inequalities.names.size() + j];
}

double SearchView::equality(std::size_t index, std::size_t j) const {
  return batch_.equalities[index * problem().equalities.names.size() + j];
}

void SearchView::Scatter(const double* full, std::span<double> gradient) const {
  for (std::size_t k = 0; k < space_.size(); ++k) {
    const double slope = full[space_.variable(k)] * space_.range(k);
    gradient[k] = std::isfinite(slope) ? slope : 0.0;
  }
}

double SearchView::CalcTerm(std::size_t index, std::size_t k) const {
  const std::size_t objectives = problem().objective_names.size();
  return scalarisation_.CalcTerm({batch_.objectives.data() + index * objectives, objectives}, k);
}

void SearchView::GetTermGradient(std::size_t index, std::size_t k,
                                 std::span<double> gradient) const {
  const std::size_t objectives = problem().objective_names.size();
  Scatter(batch_.objective_gradients.data() + (index * objectives + k) * problem().size(),
          gradient);
  const double factor = scalarisation_.weights[k] / scalarisation_.scale[k];
  for (double& value : gradient) value *= factor;
}

void SearchView::GetGradient(std::size_t index, std::span<double> gradient) const {
  if (scalarisation_.weights.empty()) {
    const std::size_t objectives = problem().objective_names.size();
    Scatter(batch_.objective_gradients.data() + index * objectives * problem().size(), gradient);
    return;
  }
  std::vector<double> part(gradient.size());
  std::fill(gradient.begin(), gradient.end(), 0.0);
  for (std::size_t k = 0; k < scalarisation_.weights.size(); ++k) {
    GetTermGradient(index, k, part);
    for (std::size_t i = 0; i < part.size(); ++i) gradient[i] += part[i];
  }
}

void SearchView::GetInequalityGradient(std::size_t index, std::size_t j,
                                       std::span<double> gradient) const {
  const std::size_t width = problem().inequalities.names.size();
  Scatter(batch_.inequality_gradients.data() + (index * width + j) * problem().size(), gradient);
}

void SearchView::GetEqualityGradient(std::size_t index, std::size_t j,
                                     std::span<double> gradient) const {
  const std::size_t width = problem().equalities.names.size();
  Scatter(batch_.equality_gradients.data() + (index * width + j) * problem().size(), gradient);
}

}  // namespace kingpin::optimisation
