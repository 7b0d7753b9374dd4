#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "optimisation/algorithms/search_view.h"

namespace kingpin::optimisation {

/// One design of a Pareto front.
struct FrontPoint {
  std::vector<double> x;
  std::vector<double> objectives;
};

/// Designs none of which is beaten in all objectives by another, sorted by the first objective.
struct Front {
  std::vector<FrontPoint> points;
  long evaluations = 0;
  bool cancelled = false;
  std::string status;  ///< in words, why it ended
};

/// a is nowhere worse than b and somewhere better.
bool Dominates(std::span<const double> a, std::span<const double> b);

/// Keeps the points that no other one dominates (of equal ones the first), sorted by the first
/// objective.
std::vector<FrontPoint> FilterFront(std::vector<FrontPoint> points);

}  // namespace kingpin::optimisation
