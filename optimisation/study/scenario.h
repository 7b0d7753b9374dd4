#pragma once

#include <string>

#include "optimisation/study/study_definition.h"

namespace kingpin::study {

enum class ScenarioMethod { kFast, kRungeKutta4, kCvode };

/// One simulation of the planar model, as a scenario file says it. SI units.
struct Scenario {
  std::string name;
  std::string description;
  ModelSource model;
  DesignValues design{};
  std::vector<LoadCase> load_cases;  ///< one, or none in paper mode
  double duration = 1.0;
  double sample_interval = 1e-3;
  ScenarioMethod method = ScenarioMethod::kFast;
  double step = 0.0;  ///< of a fixed-step method [s]; 0: the method's own
  MeasureOptions measures;
};

}  // namespace kingpin::study
