#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/input_kinds.h"
#include "core/io/schema.h"
#include "optimisation/study/scenario.h"
#include "optimisation/study/study_definition.h"
#include "optimisation/study/study_file.h"

/// Reading of study and scenario files.
namespace kingpin::study {

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
