#pragma once

#include <string>

#include "optimisation/report/study_report_data.h"

namespace kingpin::report {

/// The report of a study as one HTML file that needs nothing else: styles, drawings (inline SVG)
/// and the little script (read-out under the pointer, animation) are inside; a content security
/// policy in the file forbids the browser to fetch anything. It reads the same printed and without
/// script. The same data give the same bytes.
///
/// Inconsistent data do not stop a report (a study took long to compute): a vector shorter than the
/// one it is parallel to shows as missing values.
std::string MakeStudyReport(const StudyReportData& data);

}  // namespace kingpin::report
