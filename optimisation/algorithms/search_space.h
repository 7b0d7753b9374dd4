#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "optimisation/algorithms/problem.h"

namespace kingpin::optimisation {

/// The free variables of a problem, each scaled to u = (x - lower) / (upper - lower) in [0, 1], so
/// that steps and tolerances mean the same for every variable. u = 0 and u = 1 give the bounds bit
/// for bit. Locked variables (lower == upper) and those in `fixed` keep the value of `base`.
class SearchSpace {
 public:
  /// A linear constraint on the free variables, a . u <= b (or = b) with |a| = 1.
  struct Row {
    std::vector<double> a;
    double b = 0;
    bool equality = false;
  };

  SearchSpace(const Problem& problem, std::vector<double> base,
              const std::vector<bool>& fixed = {});

  std::size_t size() const { return free_.size(); }
  std::size_t variable(std::size_t k) const { return free_[k]; }
  double range(std::size_t k) const { return range_[k]; }
  const std::vector<Row>& rows() const { return rows_; }
  const Problem& problem() const { return *problem_; }

  /// x of u; values outside [0, 1] are clamped, and so are those within 1e-14 of an end.
  void CalcX(std::span<const double> u, std::span<double> x) const;
  std::vector<double> CalcU(std::span<const double> x) const;

  /// Moves u to the nearest point (in scaled variables) within the bounds and the linear
  /// constraints: Dykstra's alternating projections (Boyle and Dykstra 1986). Returns false when
  /// there is none.
  bool Project(std::span<double> u) const;

 private:
  const Problem* problem_;
  std::vector<double> base_;
  std::vector<std::size_t> free_;
  std::vector<double> lower_;
  std::vector<double> upper_;
  std::vector<double> range_;
  std::vector<Row> rows_;
};

}  // namespace kingpin::optimisation
