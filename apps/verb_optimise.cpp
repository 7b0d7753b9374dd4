#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/common_options.h"
#include "apps/interrupt.h"
#include "apps/run_support.h"
#include "core/io/error.h"
#include "core/io/json_text.h"
#include "core/io/nearest_name.h"
#include "core/io/progress.h"
#include "optimisation/study/run_study.h"
#include "optimisation/study/study_schema.h"
#include "optimisation/study/study_summary.h"

namespace kingpin::apps {
namespace {

const study::Case& FindCase(const study::StudyDefinition& definition, const std::string& name,
                            const std::string& file) {
  std::vector<std::string> names;
  for (const study::Case& c : definition.cases) {
    if (name.empty() || c.name == name) return c;
    names.push_back(c.name);
  }
  throw io::InputError({file, 0, "--case", "'" + name + "'", "a case of the study",
                        io::SuggestName(name, names, "cases")});
}

void CheckStage(const study::Case& c, const std::string& name, const std::string& file) {
  std::vector<std::string> names;
  for (const study::Stage& stage : c.stages) names.push_back(stage.name);
  if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) return;
  throw io::InputError({file, 0, "--stage", "'" + name + "'", "a stage of case '" + c.name + "'",
                        io::SuggestName(name, names, "stages")});
}

void RunOptimiseVerb(const std::string& file, const std::string& case_name,
                     const std::string& stage, const CommonOptions& options) {
  CatchInterrupt();
  io::InputRecord record;
  study::StudyDefinition definition = study::ReadStudy(file, MakeReadOptions(options), &record);
  CheckOutputFile(options, record.files);
  if (options.seed) definition.seed = *options.seed;
  const study::Case& c = FindCase(definition, case_name, file);
  CheckStage(c, stage, file);
  io::Progress progress(io::IsProgressWanted(options.quiet), 2);
  progress.Start(c.name, 0);
  study::RunOptions run;
  run.threads = options.threads;
  run.file = file;
  run.cancelled = WasInterrupted;
  run.progress = [&](const std::string& what, double) { progress.Note(what); };
  study::StudyResult result;
  result.definition = definition;
  result.cases.push_back(study::RunStages(definition, c, stage, run));
  progress.Finish();
  for (const auto& design : result.cases.front().designs) {
    result.seconds += design.seconds;
    result.simulations += design.simulations;
  }
  result.cancelled = WasInterrupted();
  const std::string json = io::FormatJson(study::MakeSummary(result));
  if (!options.output.empty()) io::WriteFileAtomically(options.output, json);
  if (options.json) {
    io::WriteStandardOutput(json);
  } else if (!options.quiet) {
    io::WriteStandardOutput(study::FormatSummary(result, {}));
  }
  if (result.cancelled) {
    throw io::RunError(FormatInterrupt() +
                       (options.output.empty()
                            ? std::string()
                            : "; what was finished is kept in " + options.output));
  }
}

}  // namespace

void AddVerbOptimise(CLI::App& app, CommonOptions& options) {
  CLI::App* verb =
      app.add_subcommand("optimise", "One optimisation of a study; -o writes its JSON summary");
  const auto file = std::make_shared<std::string>();
  const auto case_name = std::make_shared<std::string>();
  const auto stage = std::make_shared<std::string>();
  verb->add_option("FILE", *file, "A study file, or a folder with study.yaml")->required();
  verb->add_option("--case", *case_name, "Name of the case (default: the first)");
  verb->add_option("--stage", *stage, "Stop after this stage (default: all)");
  AddOutputOption(*verb, options, "File for the summary as JSON");
  AddSetOption(*verb, options);
  AddSearchOptions(*verb, options);
  AddPrintOptions(*verb, options);
  verb->callback([=, &options] { RunOptimiseVerb(*file, *case_name, *stage, options); });
}

}  // namespace kingpin::apps
