#include "apps/common_options.h"

#include <algorithm>
#include <limits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace kingpin::apps {
namespace {

/// The parser itself takes -1 for 2^64 - 1.
std::string CheckSeed(const std::string& text) {
  const bool digits = !text.empty() && std::all_of(text.begin(), text.end(),
                                                   [](char c) { return c >= '0' && c <= '9'; });
  constexpr auto kLongest = std::numeric_limits<std::uint64_t>::digits10;
  if (digits && text.size() <= static_cast<std::size_t>(kLongest)) return {};
  return fmt::format("found '{}', expected a whole number of 0 or more, at most {} digits", text,
                     kLongest);
}

std::string CheckThreads(const std::string& text) {
  const bool digits =
      !text.empty() && text.size() <= 4 &&
      std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (digits && std::stoi(text) >= 1 && std::stoi(text) <= 1024) return {};
  return fmt::format(
      "found '{}', expected a whole number from 1 to 1024; without it, all cores are used", text);
}

}  // namespace

void AddOutputOption(CLI::App& verb, CommonOptions& options, const std::string& description) {
  verb.add_option("-o,--output", options.output, description)->type_name("PATH");
}

void AddSetOption(CLI::App& verb, CommonOptions& options) {
  verb.add_option("--set", options.sets, "Override a value of the input, e.g. --set duration='2 s'")
      ->type_name("PATH=VALUE")
      ->expected(1)
      ->take_all();
}

void AddSearchOptions(CLI::App& verb, CommonOptions& options) {
  verb.add_option("--threads", options.threads, "Threads to use (default: all cores)")
      ->check(CLI::Validator(CheckThreads, "", "threads"));
  verb.add_option("--seed", options.seed, "Seed of every random choice, instead of the file's")
      ->check(CLI::Validator(CheckSeed, "", "seed"));
}

void AddPrintOptions(CLI::App& verb, CommonOptions& options) {
  verb.add_flag("--quiet", options.quiet, "No progress, no summary");
  verb.add_flag("--json", options.json, "Print the summary as JSON");
}

}  // namespace kingpin::apps
