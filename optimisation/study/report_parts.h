#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/io/input_record.h"
#include "optimisation/report/study_report_data.h"
#include "optimisation/study/design_details.h"
#include "optimisation/study/study_result.h"

/// The sections of the report, one file each; MakeReport puts them together.
namespace kingpin::study {

/// Metres are shown as millimetres.
report::DisplayUnit GetShownUnit(const std::string& unit);

/// What a stage frees, in words.
std::string DescribeFree(const Stage& stage);

/// The rows of the kickback card (report_measures.cpp).
std::vector<report::Measure> MakeMeasures(const StudyResult& study);
std::vector<double> MakeMeasureValues(const DesignResult& design, const DesignDetails& details);

/// One design: histories, spectrum, responses, modes, curves, geometry (report_design.cpp).
/// `variables` are the case's.
const std::vector<report::Channel>& GetChannels();
report::Design MakeReportDesign(const DesignResult& design, const DesignDetails& details,
                                const Case& c, const std::vector<DesignVariable>& variables,
                                double sample_interval);

/// Rows of the stages, convergence, uniqueness, active limits (report_search.cpp).
void AddReportSearch(const Stage& stage, const DesignResult& design, const Case& c,
                     const DesignResult& initial, const std::vector<DesignVariable>& variables,
                     report::Case& shown);

/// One case (report_case.cpp).
report::Case MakeReportCase(const Case& c, const CaseResult& result,
                            const std::vector<DesignDetails>& details,
                            const std::array<double, 5>& weights, double sample_interval);

/// All variables that any search of the case freed, with the widest bounds of all of them.
std::vector<DesignVariable> CollectVariables(const CaseResult& result);

/// Sum of ratios to the initial design against road feel (report_pareto.cpp).
report::ParetoFront MakeFront(const CaseResult& result, const std::array<double, 5>& weights);

/// The stages marked `further` and the fronts of their cases (report_further.cpp).
report::Further MakeFurther(const StudyResult& study);

/// Every value read, each once, by section; and the derived ones (report_parameters.cpp).
std::vector<report::ParameterGroup> MakeParameterGroups(const StudyResult& study,
                                                        const io::InputRecord& inputs);

/// Options of the models in force, by case.
std::vector<report::NamedText> MakeOptions(const StudyResult& study, const io::InputRecord& inputs);

/// Files read, with size and SHA-256. A file that has gone since is listed without them.
std::vector<report::InputFile> MakeInputFiles(const io::InputRecord& inputs);

}  // namespace kingpin::study
