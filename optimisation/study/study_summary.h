#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "optimisation/report/study_report_data.h"
#include "optimisation/study/study_result.h"

namespace kingpin::study {

/// A few lines for the terminal: per case and design the measures as ratios, the sum, the variables
/// on their limits, then printed values beside ours where there are some.
std::string FormatSummary(const StudyResult& study,
                          const std::vector<report::Comparison>& comparisons);

/// `summary.json`.
nlohmann::ordered_json MakeSummary(const StudyResult& study);

/// One printed table beside ours as text, with the difference of every column.
std::string FormatComparison(const report::Comparison& comparison);

}  // namespace kingpin::study
