#include "optimisation/algorithms/pareto.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace kingpin::optimisation {

bool Dominates(std::span<const double> a, std::span<const double> b) {
  bool better = false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (!(a[k] <= b[k])) return false;
    better = better || a[k] < b[k];
  }
  return better;
}

std::vector<FrontPoint> FilterFront(std::vector<FrontPoint> points) {
  std::stable_sort(points.begin(), points.end(), [](const FrontPoint& a, const FrontPoint& b) {
    return a.objectives < b.objectives;
  });
  // Sorted like this, a point can only be dominated by one before it.
  std::vector<FrontPoint> front;
  for (FrontPoint& point : points) {
    const bool beaten = std::any_of(front.begin(), front.end(), [&](const FrontPoint& other) {
      return Dominates(other.objectives, point.objectives) || other.objectives == point.objectives;
    });
    if (!beaten) front.push_back(std::move(point));
  }
  return front;
}

}  // namespace kingpin::optimisation
