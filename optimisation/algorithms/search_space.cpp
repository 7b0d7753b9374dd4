#include "optimisation/algorithms/search_space.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kingpin::optimisation {
namespace {

// Nearer to a bound than this part of the range is on it: rounding inside the algorithms leaves
// such distances, and no model of ours can tell them apart.
constexpr double kOnBound = 1e-14;

}  // namespace

SearchSpace::SearchSpace(const Problem& problem, std::vector<double> base,
                         const std::vector<bool>& fixed)
    : problem_(&problem), base_(std::move(base)) {
  for (std::size_t i = 0; i < problem.size(); ++i) {
    const Variable& variable = problem.variables[i];
    if (variable.lower == variable.upper || (!fixed.empty() && fixed[i])) continue;
    free_.push_back(i);
    lower_.push_back(variable.lower);
    upper_.push_back(variable.upper);
    range_.push_back(variable.upper - variable.lower);
  }
  for (const LinearConstraint& linear : problem.linear) {
    Row row;
    row.equality = linear.equality;
    row.b = linear.bound;
    for (std::size_t i = 0; i < problem.size(); ++i) row.b -= linear.coefficients[i] * base_[i];
    double norm = 0;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const double coefficient = linear.coefficients[free_[k]];
      row.b += coefficient * (base_[free_[k]] - lower_[k]);
      row.a.push_back(coefficient * range_[k]);
      norm += row.a.back() * row.a.back();
    }
    norm = std::sqrt(norm);
    if (norm == 0) continue;  // no free variable in it: nothing a search could do
    for (double& a : row.a) a /= norm;
    row.b /= norm;
    rows_.push_back(std::move(row));
  }
}

void SearchSpace::CalcX(std::span<const double> u, std::span<double> x) const {
  std::copy(base_.begin(), base_.end(), x.begin());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    double& value = x[free_[k]];
    if (u[k] <= kOnBound) {
      value = lower_[k];
    } else if (u[k] >= 1 - kOnBound) {
      value = upper_[k];
    } else {
      value = std::clamp(lower_[k] + u[k] * range_[k], lower_[k], upper_[k]);
    }
  }
}

std::vector<double> SearchSpace::CalcU(std::span<const double> x) const {
  std::vector<double> u(free_.size());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const double value = x[free_[k]];
    if (value >= upper_[k]) {
      u[k] = 1;
    } else {
      u[k] = std::clamp((value - lower_[k]) / range_[k], 0.0, 1.0);
    }
  }
  return u;
}

bool SearchSpace::Project(std::span<double> u) const {
  const std::size_t n = u.size();
  for (double& value : u) {
    if (std::isnan(value)) return false;
  }
  const auto clamp = [&] {
    for (double& value : u) value = std::clamp(value, 0.0, 1.0);
  };
  const auto excess = [&](const Row& row) {
    double sum = -row.b;
    for (std::size_t k = 0; k < n; ++k) sum += row.a[k] * u[k];
    return sum;
  };
  const auto largest = [&] {
    double worst = 0;
    for (const Row& row : rows_) {
      const double e = excess(row);
      worst = std::max(worst, row.equality ? std::abs(e) : e);
    }
    return worst;
  };
  clamp();
  if (rows_.empty() || largest() <= 0) return true;
  std::vector<double> box_correction(n, 0.0);
  std::vector<double> row_correction(rows_.size(), 0.0);  // along the row's normal
  constexpr int kSweeps = 2000;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Row& row = rows_[r];
      const double e = excess(row) + row_correction[r];
      const double next = row.equality ? e : std::max(0.0, e);
      const double step = row_correction[r] - next;
      for (std::size_t k = 0; k < n; ++k) u[k] += step * row.a[k];
      row_correction[r] = next;
      moved = std::max(moved, std::abs(step));
    }
    for (std::size_t k = 0; k < n; ++k) {
      const double wanted = u[k] + box_correction[k];
      const double inside = std::clamp(wanted, 0.0, 1.0);
      moved = std::max(moved, std::abs(inside - u[k]));
      box_correction[k] = wanted - inside;
      u[k] = inside;
    }
    if (moved < 1e-15) break;
  }
  return largest() <= 1e-9;
}

}  // namespace kingpin::optimisation
