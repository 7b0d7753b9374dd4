#include "core/io/error.h"

#include <utility>

#include <fmt/format.h>

namespace kingpin::io {
namespace {

std::string FormatProblems(const std::vector<InputProblem>& problems) {
  std::string text;
  for (const InputProblem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += FormatProblem(problem);
  }
  return text;
}

}  // namespace

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
    : InputError(std::vector<InputProblem>{std::move(problem)}) {}

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(FormatProblems(problems)), problems_(std::move(problems)) {}

}  // namespace kingpin::io
