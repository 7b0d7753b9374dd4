#pragma once

#include "core/io/schema_core.h"
#include "optimisation/study/scenario.h"
#include "optimisation/study/study_file.h"

/// What involves more than one key of a study or scenario file, so that a mistake is found before
/// any work and with its line: the schemas run these after reading.
namespace kingpin::study {

/// Names that are unique or refer to something, sample grid, conventions, road forces that act
/// within the duration, and for every case: that its model can be made, and that every stage, the
/// sensitivities and the Pareto front make a design space.
void CheckStudy(const StudyFile& file, io::Check& check);

/// The same for a scenario: sample grid, conventions, road force, model.
void CheckScenario(const Scenario& scenario, io::Check& check);

}  // namespace kingpin::study
