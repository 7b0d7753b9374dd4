#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/common_options.h"
#include "core/io/error.h"
#include "core/io/json_text.h"
#include "core/io/nearest_name.h"
#include "core/io/output_file.h"
#include "models/validation/cases.h"
#include "models/validation/outcome.h"

namespace kingpin::apps {
namespace {

std::vector<validation::Case> SelectCases(const std::vector<std::string>& names) {
  std::vector<validation::Case> all = validation::ListCases();
  if (names.empty()) return all;
  std::vector<std::string> known;
  for (const validation::Case& each : all) known.push_back(each.name);
  std::vector<validation::Case> chosen;
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw io::InputError({"command line", 0, "--case", fmt::format("'{}'", name),
                            "the name of a case", io::SuggestName(name, known, "cases")});
    }
    chosen.push_back(all[found - known.begin()]);
  }
  return chosen;
}

nlohmann::ordered_json MakeJson(const validation::Outcome& outcome) {
  auto checks = nlohmann::ordered_json::array();
  for (const validation::Check& check : outcome.checks) {
    checks.push_back({{"quantity", check.quantity},
                      {"reference", check.reference},
                      {"ours", check.ours},
                      {"error", check.error},
                      {"allowed", check.allowed},
                      {"pass", check.passes()}});
  }
  nlohmann::ordered_json json = {{"case", outcome.name},     {"title", outcome.title},
                                 {"source", outcome.source}, {"seconds", outcome.seconds},
                                 {"pass", outcome.passes()}, {"checks", checks}};
  if (!outcome.failure.empty()) json["failure"] = outcome.failure;
  return json;
}

void PrintList() {
  std::string text;
  for (const validation::Case& each : validation::ListCases()) {
    text += fmt::format("{}  {}\n     {}\n", each.name, each.title, each.source);
  }
  io::WriteStandardOutput(text);
}

void RunValidateVerb(const std::vector<std::string>& names, const CommonOptions& options) {
  auto list = nlohmann::ordered_json::array();
  std::string failed;
  int checks = 0, failures = 0, cases = 0;
  for (const validation::Case& each : SelectCases(names)) {
    const validation::Outcome outcome = validation::RunCase(each);
    if (options.json) {
      list.push_back(MakeJson(outcome));
    } else if (!options.quiet) {
      io::WriteStandardOutput(validation::FormatOutcome(outcome));
    }
    ++cases;
    checks += static_cast<int>(outcome.checks.size());
    failures += outcome.CountFailures();
    if (!outcome.passes()) failed += (failed.empty() ? "" : ", ") + outcome.name;
  }
  if (options.json) io::WriteStandardOutput(io::FormatJson(list));
  if (!failed.empty()) {
    throw io::RunError(fmt::format("{} of {} checks fail: {}", failures, checks, failed));
  }
  if (!options.json && !options.quiet) {
    io::WriteStandardOutput(fmt::format("{} checks of {} cases pass\n", checks, cases));
  }
}

}  // namespace

void AddVerbValidate(CLI::App& app, CommonOptions& options) {
  CLI::App* verb = app.add_subcommand(
      "validate", "Runs all analytic and published cases and holds them against the truth");
  const auto names = std::make_shared<std::vector<std::string>>();
  const auto list = std::make_shared<bool>(false);
  verb->add_option("--case", *names, "Only this case; may be given several times");
  verb->add_flag("--list", *list, "Names the cases and their sources, runs nothing");
  AddPrintOptions(*verb, options);
  verb->callback([names, list, &options] {
    if (*list) return PrintList();
    RunValidateVerb(*names, options);
  });
}

}  // namespace kingpin::apps
