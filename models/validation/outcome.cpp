#include "models/validation/outcome.h"

#include <chrono>
#include <exception>

#include <fmt/format.h>

namespace kingpin::validation {

int Outcome::CountFailures() const {
  int count = failure.empty() ? 0 : 1;
  for (const Check& check : checks) count += !check.passes();
  return count;
}

Outcome RunCase(const Case& each) {
  Outcome outcome;
  outcome.name = each.name;
  outcome.title = each.title;
  outcome.source = each.source;
  const auto start = std::chrono::steady_clock::now();
  try {
    outcome.checks = each.run();
  } catch (const std::exception& error) {
    outcome.failure = error.what();
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

std::string FormatOutcome(const Outcome& outcome) {
  std::string text =
      fmt::format("{}: {} ({:.1f} s)\n", outcome.name, outcome.title, outcome.seconds);
  text += fmt::format("  {:<4} {:<74} {:>18} {:>18} {:>9} {:>9}  pass\n", "case", "quantity",
                      "reference", "ours", "error", "allowed");
  for (const Check& check : outcome.checks) {
    text += fmt::format("  {:<4} {:<74} {:>18.12g} {:>18.12g} {:>9.2e} {:>9.1e}  {}\n",
                        outcome.name, check.quantity, check.reference, check.ours, check.error,
                        check.allowed, check.passes() ? "yes" : "NO");
  }
  if (!outcome.failure.empty()) text += fmt::format("  stopped: {}\n", outcome.failure);
  return text;
}

}  // namespace kingpin::validation
