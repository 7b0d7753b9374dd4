#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/study/report_parts.h"
#include "optimisation/study/stage_problem.h"

namespace kingpin::study {
namespace {

/// What loosening a limit by a step gains, to first order.
std::string DescribeEffect(const optimisation::ActiveConstraint& active, double step,
                           const std::string& what) {
  if (!active.multiplier || active.kind == "equality") return {};
  const double gain = *active.multiplier * step;
  if (gain <= 0.0) return "nothing to first order: loosening it alone would not help";
  return fmt::format("sum of ratios falls by {:.3g} per {} of loosening", gain, what);
}

/// A limit that holds the design, with what stands on both sides of it.
report::ActiveConstraint MakeActive(const optimisation::ActiveConstraint& active,
                                    const DesignResult& design, const Case& c,
                                    const DesignResult& initial) {
  report::ActiveConstraint row;
  row.design = design.name;
  row.name = active.name + (active.kind == "inequality" ? "" : ", " + active.kind);
  const auto& variables = design.space->variables();
  if (active.kind == "inequality") {
    for (const Constraint& constraint : c.constraints) {
      if (!active.name.starts_with(GetName(constraint.quantity))) continue;
      const bool minimum = active.name.ends_with("minimum");
      row.value = CalcQuantity(constraint.quantity, design.parameters) /
                  CalcQuantity(constraint.quantity, initial.parameters);
      row.limit = minimum ? *constraint.minimum_ratio : *constraint.maximum_ratio;
      row.effect = DescribeEffect(active, 0.01, "0.01");
    }
    return row;
  }
  if (active.kind == "linear") {
    const std::vector<double> x = design.space->Extract(design.parameters);
    for (const MonotoneCondition& condition : design.space->monotone()) {
      if (condition.name != active.name) continue;
      double room = condition.bound, largest = 0.0, scale = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double c = condition.coefficients[i];
        room -= c * x[i];
        largest = std::max(largest, std::abs(c * x[i]));
        scale += std::abs(c) * (variables[i].upper - variables[i].lower);
      }
      // Two conditions of a segment share a name: the tighter one is meant.
      if (std::isfinite(row.value) && room >= row.value) continue;
      row.name = active.name + ": room left";
      row.unit = GetShownUnit("N");
      // A search ends on the condition to rounding.
      row.value = std::abs(room) < 1e-9 * largest ? 0.0 : room;
      row.limit = 0.0;
      row.effect = DescribeEffect(active, 0.01 * scale, "1 % of the nodes' ranges");
    }
    return row;
  }
  for (const DesignVariable& v : variables) {
    if (v.name != active.name) continue;
    row.value = GetVariable(design.parameters, v);
    row.limit = active.kind == "lower bound" ? v.lower : v.upper;
    row.unit = GetShownUnit(v.unit);
    row.effect = DescribeEffect(active, 0.01 * (v.upper - v.lower), "1 % of the range");
  }
  return row;
}

}  // namespace

void AddReportSearch(const Stage& stage, const DesignResult& design, const Case& c,
                     const DesignResult& initial, const std::vector<DesignVariable>& variables,
                     report::Case& shown) {
  const optimisation::Result& search = *design.search;
  report::Stage row;
  row.name = design.name;
  row.algorithm = search.algorithm;
  row.free = DescribeFree(stage);
  row.evaluations = search.evaluations;
  row.seconds = design.seconds;
  row.start = search.start_value;
  row.end = search.value;
  row.status = search.status;
  for (const PrintedDesign& printed : c.printed) {
    if (printed.stage == design.name && printed.seconds) row.paper_seconds = *printed.seconds;
  }
  shown.stages.push_back(std::move(row));

  report::Convergence convergence;
  convergence.name = design.name;
  for (const auto& point : search.history) {
    convergence.evaluations.push_back(static_cast<double>(point.evaluations));
    convergence.best.push_back(point.value);
  }
  shown.convergence.push_back(std::move(convergence));

  if (!search.restarts.empty()) {
    report::Restarts restarts;
    restarts.name = design.name;
    if (HasSwitchingForces(design.parameters)) {
      restarts.note =
          "All runs are with dry friction, stops and play; the starts include the minima found "
          "without them.";
    }
    for (const auto& restart : search.restarts) {
      restarts.start_values.push_back(restart.start_value);
      restarts.end_values.push_back(restart.value);
      std::vector<double> end(variables.size(), report::kMissing);
      for (int i = 0; i < design.space->size() && i < static_cast<int>(restart.end.size()); ++i) {
        for (std::size_t j = 0; j < variables.size(); ++j) {
          if (variables[j].name == design.space->variables()[i].name) end[j] = restart.end[i];
        }
      }
      restarts.end_designs.push_back(std::move(end));
    }
    shown.restarts.push_back(std::move(restarts));
  }
  for (const auto& active : search.active)
    shown.active.push_back(MakeActive(active, design, c, initial));
}

}  // namespace kingpin::study
