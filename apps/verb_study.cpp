#include <chrono>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/common_options.h"
#include "apps/interrupt.h"
#include "apps/run_support.h"
#include "core/io/json_text.h"
#include "core/io/progress.h"
#include "core/math/isa.h"
#include "optimisation/report/study_report.h"
#include "optimisation/study/make_report.h"
#include "optimisation/study/run_study.h"
#include "optimisation/study/study_schema.h"
#include "optimisation/study/study_summary.h"

namespace kingpin::apps {
namespace {

/// Folder names without blanks or characters that shells and web servers stumble over.
std::string FolderName(const std::string& name) {
  std::string folder;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.';
    folder += plain ? c : '_';
  }
  return folder;
}

void WriteSignals(const study::StudyResult& result, const study::StudyDetails& details,
                  io::ResultDirectory& results) {
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const study::CaseResult& c = result.cases[i];
    for (std::size_t j = 0; j < c.designs.size(); ++j) {
      for (std::size_t k = 0; k < c.loads.size(); ++k) {
        const std::filesystem::path folder =
            std::filesystem::path(FolderName(c.name)) / FolderName(c.designs[j].name);
        results.WriteText(folder / (FolderName(c.loads[k].name) + ".csv"),
                          io::FormatSignals(study::MakeSignals(details[i][j].histories[k])));
      }
    }
  }
}

void RunStudyVerb(const std::string& file, const CommonOptions& options) {
  const std::filesystem::path input =
      file.empty() ? SourceRoot() / "examples" / "c_segment" : std::filesystem::path(file);
  CatchInterrupt();
  io::InputRecord record;
  study::StudyDefinition definition = study::ReadStudy(input, MakeReadOptions(options), &record);
  if (options.seed) definition.seed = *options.seed;
  io::RunManifest manifest = MakeManifest(options, record);
  io::ResultDirectory results(ResultPath("study", options, input), "study");

  io::Progress progress(io::IsProgressWanted(options.quiet), 2);
  study::RunOptions run;
  run.threads = options.threads;
  run.file = record.files.front().string();
  run.cancelled = WasInterrupted;
  constexpr std::uint64_t kSteps = 1000;
  std::uint64_t shown = 0;
  progress.Start(definition.name, kSteps);
  run.progress = [&](const std::string& what, double done) {
    const auto step = static_cast<std::uint64_t>(done * kSteps);
    if (step > shown) progress.Advance(step - shown);
    shown = std::max(shown, step);
    progress.Note(what);
  };
  const study::StudyResult result = study::RunStudy(definition, run);
  progress.Note("report");
  const study::StudyDetails details = study::CalcStudyDetails(result);

  study::ReportContext context;
  context.command = fmt::format(
      "kingpin {}", fmt::join(options.command_line.begin() + 1, options.command_line.end(), " "));
  context.created = FormatNow();
  context.instruction_set = isa::ToString(isa::DetectLevel());
  context.threads =
      options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  const report::StudyReportData data = study::MakeReport(result, details, record, context);
  results.WriteText("report.html", report::MakeStudyReport(data));
  results.WriteJson("summary.json", study::MakeSummary(result));
  WriteSignals(result, details, results);
  manifest.seed = definition.seed;
  manifest.threads = context.threads;
  manifest.solver = {{"simulations", static_cast<double>(result.simulations)}};
  manifest.duration =
      std::chrono::duration<double>(std::chrono::system_clock::now() - manifest.start).count();
  io::WriteManifest(manifest, &results);
  results.Commit();
  progress.Finish();
  if (options.json) {
    io::WriteStandardOutput(io::FormatJson(study::MakeSummary(result)));
  } else if (!options.quiet) {
    io::WriteStandardOutput(study::FormatSummary(result, data.comparisons) +
                            "\nReport: " + (results.target() / "report.html").string() + "\n");
  }
  if (result.cancelled)
    throw io::RunError(FormatInterrupt() + "; what was finished is kept in " +
                       results.target().string());
}

}  // namespace

void AddVerbStudy(CLI::App& app, CommonOptions& options) {
  CLI::App* verb = app.add_subcommand(
      "study", "The main job: excite, optimise, report. Without FILE: the shipped C-segment car");
  const auto file = std::make_shared<std::string>();
  verb->add_option("FILE", *file, "A study file, or a folder with study.yaml");
  AddOutputOption(*verb, options, "Result folder (default: results/<name>)");
  AddSetOption(*verb, options);
  AddSearchOptions(*verb, options);
  AddPrintOptions(*verb, options);
  verb->callback([file, &options] { RunStudyVerb(*file, options); });
}

}  // namespace kingpin::apps
