#include "optimisation/algorithms/algorithm.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/io/error.h"

namespace kingpin::optimisation {
namespace {

const std::vector<std::pair<Algorithm, std::string>>& GetTable() {
  static const std::vector<std::pair<Algorithm, std::string>> table = {
      {Algorithm::kNelderMead, "nelder_mead"},
      {Algorithm::kSbplx, "sbplx"},
      {Algorithm::kBobyqa, "bobyqa"},
      {Algorithm::kCobyla, "cobyla"},
      {Algorithm::kSlsqp, "slsqp"},
      {Algorithm::kCmaEs, "cma_es"},
      {Algorithm::kMultistart, "multistart"}};
  return table;
}

}  // namespace

std::string GetName(Algorithm algorithm) {
  for (const auto& [value, name] : GetTable()) {
    if (value == algorithm) return name;
  }
  return "unknown";
}

void CheckSuitable(Algorithm algorithm, const Problem& problem) {
  const auto fail = [&](const std::string& name, const char* kind, const char* suggestion) {
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = name,
                          .found = fmt::format("{} with algorithm {}", kind, GetName(algorithm)),
                          .expected = "an algorithm that can treat it",
                          .suggestion = suggestion});
  };
  const bool own = algorithm == Algorithm::kCobyla || algorithm == Algorithm::kSlsqp ||
                   algorithm == Algorithm::kMultistart;
  if (!problem.equalities.names.empty() && !own) {
    fail(problem.equalities.names.front(), "nonlinear equality", "use slsqp, cobyla or multistart");
  }
  if (!problem.inequalities.names.empty() && algorithm == Algorithm::kBobyqa) {
    fail(problem.inequalities.names.front(), "nonlinear inequality",
         "use slsqp, cobyla, nelder_mead, sbplx, cma_es or multistart");
  }
}

}  // namespace kingpin::optimisation
