#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/common_options.h"
#include "apps/input_kinds.h"
#include "apps/mechanism_report.h"
#include "apps/run_support.h"
#include "core/io/error.h"
#include "core/io/json_text.h"
#include "joints/mechanism_run.h"
#include "optimisation/study/scenario_modes.h"
#include "optimisation/study/study_schema.h"

namespace kingpin::apps {
namespace {

template <class Result>
void Print(const Result& result, const CommonOptions& options) {
  const std::string json = io::FormatJson(result.json);
  if (!options.output.empty()) io::WriteFileAtomically(options.output, json);
  if (options.json) {
    io::WriteStandardOutput(json);
  } else if (!options.quiet) {
    io::WriteStandardOutput(result.text);
  }
}

joints::MechanismModes CalcModes(const std::string& file, const joints::MechanismFile& mechanism) {
  try {
    return joints::CalcMechanismModes(mechanism);
  } catch (const io::RunError& error) {
    throw io::RunError(fmt::format("{}: {}", file, error.what()));
  }
}

void RunModesVerb(const std::string& file, bool held, const CommonOptions& options) {
  io::InputRecord record;
  if (IsMechanismFile(file)) {
    const joints::MechanismFile mechanism =
        joints::ReadMechanismFile(file, MakeReadOptions(options), &record);
    CheckOutputFile(options, record.files);
    const joints::MechanismModes modes = CalcModes(file, mechanism);
    if (options.output.ends_with(".html")) {
      io::WriteFileAtomically(options.output, MakeModesReport(modes));
      CommonOptions rest = options;
      rest.output.clear();
      Print(modes, rest);
    } else {
      Print(modes, options);
    }
  } else {
    const study::Scenario scenario = study::ReadScenario(file, MakeReadOptions(options), &record);
    CheckOutputFile(options, record.files);
    Print(study::CalcScenarioModes(scenario, held), options);
  }
}

}  // namespace

void AddVerbModes(CLI::App& app, CommonOptions& options) {
  CLI::App* verb = app.add_subcommand(
      "modes", "Eigenvalues, mode shapes, A B C D and frequency responses; -o writes JSON");
  const auto file = std::make_shared<std::string>();
  const auto held = std::make_shared<bool>(false);
  verb->add_option("FILE", *file, "A scenario or mechanism file, or a folder with scenario.yaml")
      ->required();
  verb->add_flag("--held", *held, "The table with the steering wheel held; JSON has free and held");
  AddOutputOption(*verb, options,
                  "File for everything as JSON; of a mechanism, with the ending .html, a page with "
                  "Bode plots");
  AddSetOption(*verb, options);
  AddPrintOptions(*verb, options);
  verb->callback([=, &options] { RunModesVerb(*file, *held, options); });
}

}  // namespace kingpin::apps
