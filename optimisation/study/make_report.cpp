#include "optimisation/study/make_report.h"

#include <cmath>

#include <fmt/format.h>

#include "core/io/version.h"
#include "optimisation/study/report_parts.h"

namespace kingpin::study {

StudyDetails CalcStudyDetails(const StudyResult& study) {
  StudyDetails details;
  for (const CaseResult& result : study.cases) {
    std::vector<DesignDetails>& of_case = details.emplace_back();
    const auto samples = static_cast<std::size_t>(
        std::llround(study.definition.duration / study.definition.sample_interval) + 1);
    const measures::GammaPlan plan(samples, study.definition.sample_interval, result.conventions);
    for (const DesignResult& design : result.designs) {
      of_case.push_back(CalcDetails(design.parameters, result.loads, plan,
                                    study.definition.duration, study.definition.sample_interval));
    }
  }
  return details;
}

report::StudyReportData MakeReport(const StudyResult& study, const StudyDetails& details,
                                   const io::InputRecord& inputs, const ReportContext& context) {
  report::StudyReportData data;
  data.title = "Steering kickback: " + study.definition.name;
  data.subtitle = study.definition.description;
  data.created = context.created;
  data.program = io::FormatVersion();
  data.command = context.command;
  data.run_seconds = study.seconds;
  data.measures = MakeMeasures(study);
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    data.cases.push_back(MakeReportCase(study.definition.cases[i], study.cases[i], details[i],
                                        study.definition.weights(),
                                        study.definition.sample_interval));
  }
  data.comparisons = MakeComparisons(study);
  data.further = MakeFurther(study);
  data.parameters = MakeParameterGroups(study, inputs);
  data.options = MakeOptions(study, inputs);
  data.inputs = MakeInputFiles(inputs);
  if (study.cancelled) data.warnings.emplace_back("The study was stopped before it was finished.");
  data.conventions.push_back(
      {"Γ over several load cases", "weighted mean of the load cases' values"});
  data.conventions.push_back(
      {"Axes and signs", "ISO 8855: x forward, y left, z up; angles counter-clockwise from above"});
  data.conventions.push_back(
      {"Samples", fmt::format("every {:g} ms over {:g} s", 1e3 * study.definition.sample_interval,
                              study.definition.duration)});
  for (const CaseResult& result : study.cases) {
    for (const WeightedLoad& load : result.loads) {
      data.conventions.push_back(
          {"Load case, " + result.name, fmt::format("{}, weight {:g}", load.name, load.weight)});
    }
  }
  data.solver.push_back({"simulations", std::to_string(study.simulations)});
  data.solver.push_back({"wall time", fmt::format("{:.2f} s", study.seconds)});
  data.solver.push_back({"threads", std::to_string(context.threads)});
  data.solver.push_back({"seed", std::to_string(study.definition.seed)});
  const io::Version version = io::GetVersion();
  data.versions = {{"program", io::FormatVersion()},
                   {"compiler", version.compiler},
                   {"instruction set", context.instruction_set}};
  return data;
}

}  // namespace kingpin::study
