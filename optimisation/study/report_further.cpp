#include "optimisation/study/report_parts.h"

namespace kingpin::study {
namespace {

/// The last search of the case that is not shown on this page.
const DesignResult* FindBefore(const Case& c, const CaseResult& result) {
  const DesignResult* before = nullptr;
  for (const Stage& stage : c.stages) {
    if (stage.further || stage.free.empty()) continue;
    for (const DesignResult& design : result.designs) {
      if (design.name == stage.name) before = &design;
    }
  }
  return before;
}

}  // namespace

report::Further MakeFurther(const StudyResult& study) {
  report::Further further;
  const auto& weights = study.definition.weights();
  for (int k = 0; k < measures::kMeasureCount; ++k) {
    further.ratio_symbols.push_back("Γ_" + std::to_string(k + 1));
  }
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    const CaseResult& result = study.cases[i];
    const DesignResult& initial = result.designs.front();
    for (const Stage& stage : study.definition.cases[i].stages) {
      if (!stage.further) continue;
      for (const DesignResult& design : result.designs) {
        if (design.name != stage.name) continue;
        report::FurtherRow row;
        row.name = result.name;
        row.freedom = stage.name + " (" + DescribeFree(stage) + ")";
        row.objective_start = measures::CalcObjective(initial.gammas, initial.gammas, weights);
        row.objective = measures::CalcObjective(design.gammas, initial.gammas, weights);
        if (const DesignResult* before = FindBefore(study.definition.cases[i], result)) {
          row.before = before->name;
          row.objective_before = measures::CalcObjective(before->gammas, initial.gammas, weights);
        }
        for (int k = 0; k < measures::kMeasureCount; ++k) {
          row.ratios.push_back(design.gammas[k] / initial.gammas[k]);
        }
        row.road_feel_ratio = design.road_feel_gain / initial.road_feel_gain;
        further.rows.push_back(std::move(row));
      }
    }
    if (!further.rows.empty() && !result.pareto.empty() &&
        further.rows.back().name == result.name) {
      further.pareto.push_back(MakeFront(result, weights));
    }
  }
  if (further.rows.empty()) return {};
  further.text =
      "How much lower the measures go when more is free than in the paper, and what that costs in "
      "road feel. Ratios are to the case's initial design; “without it” is the last design of the "
      "case with the paper's freedom.";
  return further;
}

}  // namespace kingpin::study
