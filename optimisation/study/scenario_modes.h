#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "optimisation/study/scenario.h"

namespace kingpin::study {

struct ModesResult {
  nlohmann::ordered_json json;  ///< planar::MakeJson(LinearAnalysis): wheel free and held
  std::string text;             ///< table for the terminal, of one of them
};

/// Linearises the scenario's model at rest. `held`: the table is that with the steering wheel held
/// by the driver.
ModesResult CalcScenarioModes(const Scenario& scenario, bool held);

}  // namespace kingpin::study
