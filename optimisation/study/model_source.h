#pragma once

#include <string>
#include <vector>

#include "models/parameters/derived_quantity.h"
#include "models/planar/parameters.h"
#include "optimisation/study/design_evaluator.h"
#include "optimisation/study/study_definition.h"

namespace kingpin::study {

/// A planar model with the road forces that excite it.
struct LoadedModel {
  planar::Parameters<double> parameters;
  std::vector<WeightedLoad> loads;
  std::string paper_set;                  ///< name of the set in paper mode
  double gamma_3_scale = 1.0;             ///< the paper set's c_3
  parameters::DerivedQuantities derived;  ///< of car mode
};

/// Reads the paper set or reduces the car. Without load cases a paper set's own pulses are taken.
/// Throws io::InputError.
LoadedModel LoadModel(const ModelSource& source, const std::vector<LoadCase>& load_cases);

/// The design that a case begins with: the model with the starts of its variables.
planar::Parameters<double> MakeInitialDesign(const Case& c, const LoadedModel& model);

}  // namespace kingpin::study
