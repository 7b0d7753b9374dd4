#pragma once

#include <string>

#include "optimisation/study/study_definition.h"

namespace kingpin::study {

/// A study file as written: what the cases leave out stands at its top.
struct StudyFile {
  StudyDefinition definition;
  /// Load cases, variables, curves, constraints, stages, Pareto front for all cases.
  Case defaults;
};

/// A case with what it leaves out, and where each part stands in the file.
struct InheritedCase {
  Case c;
  std::string key;         ///< `cases[2]`
  std::string load_cases;  ///< `cases[2].load_cases`, or `load_cases` where it was inherited
  std::string stages;      ///< likewise
  std::string pareto;      ///< likewise
  bool own_variables[kScalarFieldCount] = {};
  bool own_assistance = false;
  bool own_longitudinal = false;
};

InheritedCase MakeInheritedCase(const StudyFile& file, std::size_t number);

/// The study with every case complete.
StudyDefinition MakeDefinition(StudyFile file);

}  // namespace kingpin::study
