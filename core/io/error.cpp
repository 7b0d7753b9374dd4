#include "core/io/error.h"

#include <utility>

#include <fmt/format.h>

namespace kingpin::io {

std::string FormatProblem(const InputProblem& problem) {
  std::string text;
  if (!problem.file.empty()) {
    text += problem.line > 0 ? fmt::format("{}:{}: ", problem.file, problem.line)
                             : fmt::format("{}: ", problem.file);
  }
  if (!problem.key.empty()) text += problem.key + ": ";
  if (!problem.found.empty()) text += "found " + problem.found;
  if (!problem.expected.empty()) {
    text += (problem.found.empty() ? "expected " : ", expected ") + problem.expected;
  }
  if (!problem.suggestion.empty()) text += "; " + problem.suggestion;
  return text;
}

InputError::InputError(InputProblem problem)
    : std::runtime_error(FormatProblem(problem)), problem_(std::move(problem)) {}

}  // namespace kingpin::io
