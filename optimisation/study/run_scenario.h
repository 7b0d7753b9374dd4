#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/io/csv.h"
#include "optimisation/study/scenario.h"

namespace kingpin::study {

struct ScenarioResult {
  io::Signals signals;
  nlohmann::ordered_json summary;
  std::string text;                                        ///< for the terminal
  std::vector<std::pair<std::string, double>> statistics;  ///< of the integrator
};

/// Simulates the scenario's (first) load case and evaluates its measures.
/// Throws io::InputError for a scenario that makes no run, io::RunError when the run diverges.
ScenarioResult RunScenario(const Scenario& scenario);

}  // namespace kingpin::study
