#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/input_kinds.h"
#include "core/io/schema.h"
#include "optimisation/study/scenario.h"
#include "optimisation/study/study_definition.h"

/// Reading of study and scenario files.
namespace kingpin::study {

/// A study file as written: what the cases leave out stands at its top.
struct StudyFile {
  StudyDefinition definition;
  Case
      defaults;  ///< load cases, variables, curves, constraints, stages, Pareto front for all cases
};

const io::Schema<StudyFile>& StudySchema();
const io::Schema<Scenario>& ScenarioSchema();

/// Reads a study file, or `study.yaml` in a folder. Throws io::InputError.
StudyDefinition ReadStudy(const std::filesystem::path& path, const io::ReadOptions& options = {},
                          io::InputRecord* record = nullptr);

/// Reads a scenario file, or `scenario.yaml` in a folder. Throws io::InputError.
Scenario ReadScenario(const std::filesystem::path& path, const io::ReadOptions& options = {},
                      io::InputRecord* record = nullptr);

/// For `kingpin check` and `kingpin schema`.
void AddInputKinds(io::InputKinds* kinds);

}  // namespace kingpin::study
