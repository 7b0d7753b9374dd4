#pragma once

#include <string>
#include <vector>

#include "core/io/input_record.h"
#include "optimisation/report/study_report_data.h"
#include "optimisation/study/design_details.h"
#include "optimisation/study/study_result.h"

/// From what a study found to what its report shows.
namespace kingpin::study {

/// Details of every design of every case, in the order of the results.
using StudyDetails = std::vector<std::vector<DesignDetails>>;

StudyDetails CalcStudyDetails(const StudyResult& study);

struct ReportContext {
  std::string command;
  std::string created;
  std::string instruction_set;
  int threads = 1;
};

report::StudyReportData MakeReport(const StudyResult& study, const StudyDetails& details,
                                   const io::InputRecord& inputs, const ReportContext& context);

/// The printed values beside ours, one table per `table` name with a column for each case that has
/// it; also printed on the terminal.
std::vector<report::Comparison> MakeComparisons(const StudyResult& study);

}  // namespace kingpin::study
