#include "optimisation/study/report_parts.h"

namespace kingpin::study {

report::ParetoFront MakeFront(const CaseResult& result, const std::array<double, 5>& weights) {
  report::ParetoFront front;
  front.name = result.name + ": kickback against road feel";
  front.x_name = "Road-feel gain";
  front.x_unit = {"N*m/(N*m)"};
  front.y_name = "Sum of ratios to the initial design";
  for (const ParetoPointResult& point : result.pareto) {
    front.front.push_back({point.road_feel_gain, point.sum_of_ratios, ""});
  }
  const auto& initial = result.designs.front();
  for (const DesignResult& design : result.designs) {
    const double sum = measures::CalcObjective(design.gammas, initial.gammas, weights);
    front.marked.push_back({design.road_feel_gain, sum, design.name});
  }
  front.note =
      "Better is to the right (more road feel) and below (less kickback): no design was found to "
      "the right of and below a point of the front. Named designs with more freedom than the "
      "front's own, or fixed values outside it, may lie beyond it.";
  return front;
}

}  // namespace kingpin::study
