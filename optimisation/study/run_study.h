#pragma once

#include <functional>
#include <string>

#include "optimisation/study/study_definition.h"
#include "optimisation/study/study_result.h"

namespace kingpin::study {

struct RunOptions {
  int threads = 0;                  ///< 0: all cores
  std::string file;                 ///< named in messages
  std::function<bool()> cancelled;  ///< asked often; true ends the study with what is finished
  /// Called between and during searches: what is going on, and the part of the study that is done,
  /// 0 to 1.
  std::function<void(const std::string& what, double done)> progress;
};

/// Runs every case: the initial design, the stages, the sensitivities, the Pareto front.
/// Results are the same bit for bit for any number of threads.
/// Throws io::InputError when a case makes no model, a stage no search, or the initial design no
/// simulation.
StudyResult RunStudy(const StudyDefinition& definition, const RunOptions& options);

/// The stages of one case up to and including `last` (empty: all), without sensitivities and front.
CaseResult RunStages(const StudyDefinition& definition, const Case& c, const std::string& last,
                     const RunOptions& options);

}  // namespace kingpin::study
