#include "optimisation/study/study_file.h"

#include <utility>

namespace kingpin::study {

InheritedCase MakeInheritedCase(const StudyFile& file, std::size_t number) {
  const Case& defaults = file.defaults;
  InheritedCase result;
  Case& c = result.c = file.definition.cases[number];
  result.key = "cases[" + std::to_string(number) + "]";
  const auto place = [&](bool own, const char* name) {
    return own ? result.key + "." + name : name;
  };
  result.load_cases = place(!c.load_cases.empty(), "load_cases");
  result.stages = place(!c.stages.empty(), "stages");
  result.pareto = place(c.pareto.has_value(), "pareto");
  if (c.load_cases.empty()) c.load_cases = defaults.load_cases;
  if (c.constraints.empty()) c.constraints = defaults.constraints;
  if (c.stages.empty()) c.stages = defaults.stages;
  if (!c.pareto) c.pareto = defaults.pareto;
  for (int i = 0; i < kScalarFieldCount; ++i) {
    result.own_variables[i] = c.variables[i].has_value();
    if (!c.variables[i]) c.variables[i] = defaults.variables[i];
  }
  result.own_assistance = c.curves.assistance.has_value();
  result.own_longitudinal = c.curves.longitudinal.has_value();
  if (!c.curves.assistance) c.curves.assistance = defaults.curves.assistance;
  if (!c.curves.longitudinal) c.curves.longitudinal = defaults.curves.longitudinal;
  return result;
}

StudyDefinition MakeDefinition(StudyFile file) {
  std::vector<Case> cases;
  cases.reserve(file.definition.cases.size());
  for (std::size_t i = 0; i < file.definition.cases.size(); ++i) {
    cases.push_back(MakeInheritedCase(file, i).c);
  }
  file.definition.cases = std::move(cases);
  return std::move(file.definition);
}

}  // namespace kingpin::study
