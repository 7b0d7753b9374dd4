#include "optimisation/study/study_check.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/io/nearest_name.h"
#include "core/io/units.h"
#include "models/planar/planar_model.h"
#include "models/planar/simulate.h"
#include "models/planar/validate.h"
#include "optimisation/study/design_space.h"
#include "optimisation/study/model_source.h"

namespace kingpin::study {
namespace {

using planar::Parameters;

/// Says the same only once: a mistake in what all cases inherit would be found in each of them.
class OnceOnly : public io::Check {
 public:
  explicit OnceOnly(io::Check& check) : check_(check) {}

  void Fail(std::string_view key, std::string found, std::string expected,
            std::string suggestion = {}) override {
    is_good_ = false;
    if (!said_.insert(std::string(key) + "\n" + found).second) return;
    check_.Fail(key, std::move(found), std::move(expected), std::move(suggestion));
  }
  void Add(std::string_view key, const io::InputError& error) override {
    is_good_ = false;
    if (said_.insert(std::string(key) + "\n" + error.what()).second) check_.Add(key, error);
  }

  bool is_good() const { return is_good_; }

 private:
  io::Check& check_;
  std::set<std::string> said_;
  bool is_good_ = true;
};

template <class T>
void CheckUnique(const std::vector<T>& items, const std::string& key, io::Check& check) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!names.insert(items[i].name).second) {
      check.Fail(fmt::format("{}[{}].name", key, i),
                 fmt::format("'{}' a second time", items[i].name), "a unique name");
    }
  }
}

/// `T` has a duration, a sample interval and conventions of the measures.
template <class T>
void CheckGrid(const T& run, io::Check& check) {
  try {
    planar::CalcSampleIntervals(run.duration, run.sample_interval, run.sample_interval);
  } catch (const io::InputError& error) {
    check.Add("", error);
  }
  try {
    MakeConventions(run.measures, 1.0);
  } catch (const io::InputError& error) {
    check.Add("measures", error);
  }
}

void CheckLoads(const std::vector<LoadCase>& loads, const std::string& key, double duration,
                io::Check& check) {
  CheckUnique(loads, key, check);
  const std::string end = io::FormatQuantity(duration, "s");
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const LoadCase& load = loads[i];
    const std::string here = fmt::format("{}[{}]", key, i);
    bool is_late = false;
    for (std::size_t j = 0; j < load.pulses.size(); ++j) {
      if (load.pulses[j].start < duration) continue;
      is_late = true;
      check.Fail(fmt::format("{}.pulses[{}].start", here, j),
                 fmt::format("{}: the pulse of load case '{}' begins when the run is over",
                             io::FormatQuantity(load.pulses[j].start, "s"), load.name),
                 fmt::format("less than the duration, {}", end));
    }
    try {
      const planar::Excitation excitation = MakeExcitation(load);
      if (!is_late && !(excitation.start() < duration)) {
        check.Fail(here, fmt::format("load case '{}' without any force", load.name),
                   fmt::format("a force within the duration, {}", end));
      }
    } catch (const io::InputError& error) {
      check.Add(here, error);
    }
  }
}

/// Nothing when the model cannot be made; the reason is noted.
std::optional<LoadedModel> CheckModel(const ModelSource& source, const std::string& key,
                                      bool has_loads, double duration, io::Check& check) {
  try {
    LoadedModel model = LoadModel(source, {});
    for (const WeightedLoad& load : model.loads) {
      if (has_loads || load.excitation.start() < duration) continue;
      check.Fail("duration",
                 fmt::format("{}: the pulses of {} begin later", io::FormatQuantity(duration, "s"),
                             load.name),
                 fmt::format("more than {}", io::FormatQuantity(load.excitation.start(), "s")));
    }
    return model;
  } catch (const io::InputError& error) {
    check.Add(source.car ? key + ".car" : key, error);
    return std::nullopt;
  }
}

void CheckParameters(const Parameters<double>& parameters, const std::string& key,
                     io::Check& check) {
  try {
    planar::ValidateParameters(parameters);
  } catch (const io::InputError& error) {
    check.Add(key, error);
  }
}

/// Every stage name is unique, and every reference names an earlier stage.
void CheckStages(const InheritedCase& inherited, io::Check& check) {
  std::vector<std::string> known{"initial"};
  const auto require = [&](const std::string& name, const std::string& where) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      check.Fail(where, fmt::format("'{}'", name), "the name of an earlier stage of the case",
                 io::SuggestName(name, known, "stages"));
    }
  };
  const std::vector<Stage>& stages = inherited.c.stages;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const Stage& stage = stages[i];
    const std::string here = fmt::format("{}[{}]", inherited.stages, i);
    if (std::find(known.begin(), known.end(), stage.name) != known.end()) {
      check.Fail(here + ".name", fmt::format("'{}' a second time", stage.name), "a unique name");
    }
    require(stage.start, here + ".start");
    for (const std::string& name : stage.also_from) require(name, here + ".also_from");
    if (!stage.relative_to.empty()) require(stage.relative_to, here + ".relative_to");
    known.push_back(stage.name);
  }
  const std::vector<PrintedDesign>& printed = inherited.c.printed;
  for (std::size_t i = 0; i < printed.size(); ++i) {
    require(printed[i].stage, fmt::format("{}.printed[{}].stage", inherited.key, i));
  }
}

/// Design spaces of one case: makes each as the run will, and finds the keys to blame.
class SpaceCheck {
 public:
  SpaceCheck(const InheritedCase& inherited, const LoadedModel& model, io::Check& check)
      : inherited_(inherited), initial_(MakeInitialDesign(inherited.c, model)), check_(check) {}

  void Run() {
    const Case& c = inherited_.c;
    CheckParameters(initial_, inherited_.key + ".model", check_);
    std::map<std::string, Parameters<double>> designs{{"initial", initial_}};
    for (std::size_t i = 0; i < c.stages.size(); ++i) {
      const Stage& stage = c.stages[i];
      // What a search will find lies within its bounds, as its start does.
      Parameters<double> base = designs.at(stage.start);
      SetScalars(base, stage.design);
      const std::string here = fmt::format("{}[{}]", inherited_.stages, i);
      CheckParameters(base, here + ".design", check_);
      MakeSpace(base, stage.free, stage.curves, here);
      designs.insert_or_assign(stage.name, base);
    }
    if (c.pareto) MakeSpace(initial_, c.pareto->free, c.pareto->curves, inherited_.pareto);
    // The sensitivities are taken with respect to all curves that have bounds.
    std::vector<std::string> curves;
    if (c.curves.assistance && initial_.assist_force.count > 0) curves.emplace_back("assistance");
    if (c.curves.longitudinal) curves.emplace_back("longitudinal");
    MakeSpace(initial_, curves, {}, inherited_.key);
  }

 private:
  void MakeSpace(const Parameters<double>& base, const std::vector<std::string>& free,
                 const CurveTable& special, const std::string& here) {
    try {
      DesignSpace::Make(base, initial_, free, inherited_.c.variables,
                        MergeCurves(inherited_.c.curves, special), "");
    } catch (const io::InputError& error) {
      for (const io::InputProblem& problem : error.problems()) {
        check_.Fail(FindKey(problem.key, special, here), problem.found, problem.expected,
                    problem.suggestion);
      }
    }
  }

  /// The bounds that a space complains about may stand in the stage, in the case or above all
  /// cases.
  std::string FindKey(const std::string& key, const CurveTable& special,
                      const std::string& here) const {
    const auto starts = [&key](const std::string& name) { return key.rfind(name, 0) == 0; };
    bool own = true;
    for (int i = 0; i < kScalarFieldCount; ++i) {
      if (key != std::string("variables.") + ScalarFields<double>()[i].name) continue;
      own = inherited_.own_variables[i] || !inherited_.c.variables[i];
      return own ? inherited_.key + "." + key : key;
    }
    if (starts("curves.assistance")) {
      if (special.assistance) return here + "." + key;
      own = inherited_.own_assistance || !inherited_.c.curves.assistance;
    } else if (starts("curves.longitudinal")) {
      if (special.longitudinal) return here + "." + key;
      own = inherited_.own_longitudinal || !inherited_.c.curves.longitudinal;
    } else {
      return here + "." + key;  // `free`
    }
    return own ? inherited_.key + "." + key : key;
  }

  const InheritedCase& inherited_;
  const Parameters<double> initial_;
  io::Check& check_;
};

}  // namespace

void CheckStudy(const StudyFile& file, io::Check& given) {
  OnceOnly check(given);
  const StudyDefinition& study = file.definition;
  CheckGrid(study, check);
  CheckUnique(study.cases, "cases", check);
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    const InheritedCase inherited = MakeInheritedCase(file, i);
    const Case& c = inherited.c;
    if (c.model.car && c.load_cases.empty()) {
      check.Fail(inherited.key + ".load_cases", "nothing", "at least one road force");
    }
    CheckLoads(c.load_cases, inherited.load_cases, study.duration, check);
    CheckStages(inherited, check);
    const std::optional<LoadedModel> model =
        CheckModel(c.model, inherited.key + ".model", !c.load_cases.empty(), study.duration, check);
    // Spaces follow the stages' references.
    if (model && check.is_good()) SpaceCheck(inherited, *model, check).Run();
  }
}

void CheckScenario(const Scenario& scenario, io::Check& given) {
  OnceOnly check(given);
  CheckGrid(scenario, check);
  if (scenario.model.car && scenario.load_cases.empty()) {
    check.Fail("load_cases", "nothing", "one road force");
  }
  CheckLoads(scenario.load_cases, "load_cases", scenario.duration, check);
  std::optional<LoadedModel> model =
      CheckModel(scenario.model, "model", !scenario.load_cases.empty(), scenario.duration, check);
  if (!model) return;
  SetScalars(model->parameters, scenario.design);
  CheckParameters(model->parameters, "design", check);
  if (!check.is_good() || scenario.method != ScenarioMethod::kFast || scenario.step <= 1e-5) return;
  const planar::Structure structure = planar::MakeModel(model->parameters).structure;
  if (structure.has_events() || structure.friction_law == planar::FrictionLaw::kSmoothed) {
    check.Fail("step", io::FormatQuantity(scenario.step, "s"),
               "at most 1e-05 s, or none: dry friction, stops and free play are integrated by "
               "Runge-Kutta");
  }
}

}  // namespace kingpin::study
