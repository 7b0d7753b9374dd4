#pragma once

#include <vector>

#include "core/io/csv.h"
#include "models/planar/linear_frequency_response.h"
#include "models/planar/linear_modes.h"
#include "models/planar/simulate.h"
#include "optimisation/measures/companions.h"
#include "optimisation/study/study_result.h"

/// What is computed for the designs that are shown, beside their measures.
namespace kingpin::study {

struct DesignDetails {
  std::vector<planar::History> histories;        ///< one per load case
  std::vector<measures::Companions> companions;  ///< one per load case
  std::vector<measures::Gammas<double>> gammas;  ///< one per load case
  planar::Modes modes;
  planar::FrequencyResponse
      response;  ///< road force F_T to tie-rod force, wheel angle, torsion torque
};

DesignDetails CalcDetails(const planar::Parameters<double>& design,
                          const std::vector<WeightedLoad>& loads, const measures::GammaPlan& plan,
                          double duration, double sample_interval);

/// All signals of a run under their path names, for `signals.csv`.
io::Signals MakeSignals(const planar::History& history);

}  // namespace kingpin::study
