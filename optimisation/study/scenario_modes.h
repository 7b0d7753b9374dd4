#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "optimisation/study/scenario.h"

namespace kingpin::study {

struct ModesResult {
  nlohmann::ordered_json json;  ///< modes, state space, frequency responses
  std::string text;             ///< table for the terminal
};

/// Linearises the scenario's model at rest. `held`: with the steering wheel held by the driver.
ModesResult CalcScenarioModes(const Scenario& scenario, bool held);

}  // namespace kingpin::study
