#include <cstdint>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/common_options.h"
#include "apps/input_kinds.h"
#include "apps/interrupt.h"
#include "apps/mechanism_report.h"
#include "apps/run_support.h"
#include "core/io/error.h"
#include "core/io/json_text.h"
#include "core/io/progress.h"
#include "joints/mechanism_run.h"
#include "optimisation/study/run_scenario.h"
#include "optimisation/study/study_schema.h"

namespace kingpin::apps {
namespace {

// Reads with `read`, runs with `run` and writes what came out: scenarios of the planar model and
// mechanisms alike.
template <class Read, class Run, class Further>
void RunAndWrite(const std::string& file, const CommonOptions& options, const Read& read,
                 const Run& run, const Further& add_further) {
  io::InputRecord record;
  const auto input = read(file, MakeReadOptions(options), &record);
  io::RunManifest manifest = MakeManifest(options, record);
  io::ResultDirectory results(ResultPath("simulate", options, file), "simulate");
  const auto result = run(input);
  results.WriteText("signals.csv", io::FormatSignals(result.signals));
  results.WriteJson("summary.json", result.summary);
  add_further(result, results);
  manifest.solver = result.statistics;
  manifest.duration =
      std::chrono::duration<double>(std::chrono::system_clock::now() - manifest.start).count();
  io::WriteManifest(manifest, &results);
  results.Commit();
  if (options.json) {
    io::WriteStandardOutput(io::FormatJson(result.summary));
  } else if (!options.quiet) {
    io::WriteStandardOutput(result.text + "\nResults: " + results.target().string() + "\n");
  }
}

// With progress, and stopped by Ctrl-C at a sample.
joints::MechanismRun RunWatched(const std::string& file, const joints::MechanismFile& mechanism,
                                const CommonOptions& options) {
  constexpr double kSteps = 1000;
  const double duration = mechanism.simulation.duration;
  io::Progress progress(io::IsProgressWanted(options.quiet), 2);
  progress.Start(mechanism.description.name, static_cast<std::uint64_t>(kSteps));
  std::uint64_t shown = 0;
  const auto proceed = [&](double time) {
    const auto step = static_cast<std::uint64_t>(kSteps * time / duration);
    if (step > shown) {
      progress.Note(fmt::format("{:.4g} s of {:g} s", time, duration));
      progress.Advance(step - shown);
      shown = step;
    }
    return !WasInterrupted();
  };
  try {
    return joints::RunMechanism(mechanism, proceed);
  } catch (const io::RunError& error) {
    throw io::RunError(fmt::format("{}: {}", file, error.what()));
  }
}

void SimulateMechanism(const std::string& file, const CommonOptions& options) {
  CatchInterrupt();
  std::string ended;  // why, if early
  const auto run = [&](const joints::MechanismFile& mechanism) {
    return RunWatched(file, mechanism, options);
  };
  const auto add_report = [&](const joints::MechanismRun& result, io::ResultDirectory& results) {
    results.WriteText("report.html", MakeMechanismReport(result));
    if (result.finished) return;
    const double time = result.signals.time.back();
    ended = fmt::format("{}: {}; what was finished is kept in {}", file,
                        result.failure.empty()
                            ? fmt::format("{} at t = {:g} s", FormatInterrupt(), time)
                            : fmt::format("failed after t = {:g} s: {}", time, result.failure),
                        results.target().string());
  };
  RunAndWrite(file, options, joints::ReadMechanismFile, run, add_report);
  if (!ended.empty()) throw io::RunError(ended);
}

void RunSimulateVerb(const std::string& file, const CommonOptions& options) {
  if (IsMechanismFile(file)) {
    SimulateMechanism(file, options);
  } else {
    RunAndWrite(file, options, study::ReadScenario, study::RunScenario,
                [](const auto&, io::ResultDirectory&) {});
  }
}

}  // namespace

void AddVerbSimulate(CLI::App& app, CommonOptions& options) {
  CLI::App* verb = app.add_subcommand(
      "simulate",
      "One scenario or mechanism: signals.csv, summary.json, manifest.json, of a mechanism "
      "report.html, too");
  const auto file = std::make_shared<std::string>();
  verb->add_option("FILE", *file, "A scenario or mechanism file, or a folder with scenario.yaml")
      ->required();
  AddOutputOption(*verb, options, "Result folder (default: results/<name>_simulate)");
  AddSetOption(*verb, options);
  AddPrintOptions(*verb, options);
  verb->callback([file, &options] { RunSimulateVerb(*file, options); });
}

}  // namespace kingpin::apps
