#pragma once

#include "optimisation/report/page.h"
#include "optimisation/report/study_report_data.h"

namespace kingpin::report {

/// Each adds one part of the report, or nothing when its data are missing.

void AddSummary(const StudyReportData& data, Page& page);

void AddKickbackCard(const std::vector<Measure>& measures, const Case& c, Page& page);
void AddDesignVariables(const Case& c, Page& page);
void AddHistories(const Case& c, Page& page);
void AddSpectra(const Case& c, Page& page);
void AddFrequencyResponses(const Case& c, Page& page);
void AddModes(const std::vector<Measure>& measures, const Case& c, Page& page);
void AddCharacteristics(const Case& c, Page& page);
void AddGeometry(const std::vector<Measure>& measures, const Case& c, Page& page);
void AddSensitivities(const Case& c, Page& page);
void AddSearch(const Case& c, Page& page);
void AddParetoFronts(const Case& c, Page& page);
/// What the fronts mean; each text once.
void AddParetoNotes(const std::vector<ParetoFront>& fronts, Page& page);
void AddComparisons(const std::vector<Comparison>& comparisons, int level, Page& page);

void AddFurther(const Further& further, Page& page);
void AddParameters(const StudyReportData& data, Page& page);
void AddConventions(const StudyReportData& data, Page& page);
void AddRecord(const StudyReportData& data, Page& page);

}  // namespace kingpin::report
