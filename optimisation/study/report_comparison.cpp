#include <algorithm>

#include "optimisation/measures/conventions.h"
#include "optimisation/study/make_report.h"
#include "optimisation/study/report_parts.h"
#include "optimisation/study/scalar_fields.h"

namespace kingpin::study {

namespace {

std::vector<report::Comparison> MakeCaseComparisons(const Case& c, const CaseResult& result) {
  std::vector<report::Comparison> tables;
  const auto fields = ScalarFields<double>();
  const auto units = measures::DescribeUnits(result.conventions);
  const std::string column = result.paper_set.empty() ? result.name : "set " + result.paper_set;
  for (const PrintedDesign& printed : c.printed) {
    const auto found =
        std::find_if(result.designs.begin(), result.designs.end(),
                     [&](const DesignResult& design) { return design.name == printed.stage; });
    if (found == result.designs.end()) continue;  // a study that was stopped lacks stages
    const DesignResult& ours = *found;
    report::Comparison table;
    table.title = printed.table;
    table.columns = {column};
    const auto add = [&](const std::string& symbol, const std::string& name,
                         const report::DisplayUnit& unit, std::optional<double> paper,
                         double value) {
      if (paper) table.rows.push_back({symbol, name, unit, *paper, {value}, ""});
    };
    for (int k = 0; k < measures::kMeasureCount; ++k) {
      const bool scaled_only = k == 2;  // the paper's scale of Γ_3 is unknown
      add("Γ_" + std::to_string(k + 1), "", {scaled_only ? "" : units[k]}, printed.gamma[k],
          ours.gammas[k]);
    }
    add("I_V", "sum of ratios to " + ours.relative_to, {}, printed.sum_of_ratios,
        ours.sum_of_ratios);
    for (int i = 0; i < kScalarFieldCount; ++i) {
      add(fields[i].name, fields[i].description, GetShownUnit(fields[i].unit), printed.design[i],
          ours.parameters.*(fields[i].member));
    }
    if (ours.search) add("", "computing time", {"s"}, printed.seconds, ours.seconds);
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace

std::vector<report::Comparison> MakeComparisons(const StudyResult& study) {
  std::vector<report::Comparison> merged;
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    for (report::Comparison& table :
         MakeCaseComparisons(study.definition.cases[i], study.cases[i])) {
      const auto same = std::find_if(merged.begin(), merged.end(), [&](const auto& other) {
        return other.title == table.title && other.rows.size() == table.rows.size();
      });
      if (same == merged.end()) {
        merged.push_back(std::move(table));
        continue;
      }
      same->columns.push_back(table.columns.front());
      for (std::size_t r = 0; r < table.rows.size(); ++r) {
        same->rows[r].ours.push_back(table.rows[r].ours.front());
      }
    }
  }
  return merged;
}

}  // namespace kingpin::study
