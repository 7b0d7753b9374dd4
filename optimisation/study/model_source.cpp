#include "optimisation/study/model_source.h"

#include "core/io/csv.h"
#include "core/io/error.h"
#include "core/io/units.h"
#include "models/planar/car_reduction.h"
#include "models/planar/paper_set.h"
#include "optimisation/study/design_space.h"

namespace kingpin::study {

planar::Excitation MakeExcitation(const LoadCase& load_case) {
  if (load_case.history.empty()) return planar::Excitation(load_case.pulses);
  const io::Signals signals = io::ReadSignals(load_case.history);
  if (signals.channels.size() != 1) {
    throw io::InputError({load_case.history.string(), 0, "",
                          std::to_string(signals.channels.size()) + " channels beside the time",
                          "one, the longitudinal force", ""});
  }
  const io::Signals::Channel& force = signals.channels.front();
  // The values are SI whatever unit they were written in.
  if (!force.unit.empty() &&
      !io::IsUsableAs(io::ParseUnit(force.unit).dimension, io::ParseUnit("N").dimension)) {
    throw io::InputError({load_case.history.string(), 2, force.name, "unit '" + force.unit + "'",
                          "a force, e.g. N or kN", ""});
  }
  return planar::Excitation(load_case.pulses, signals.time, force.values);
}

LoadedModel LoadModel(const ModelSource& source, const std::vector<LoadCase>& load_cases) {
  LoadedModel model;
  if (source.car) {
    model.parameters = planar::MakePlanarParameters(*source.car, source.options, &model.derived);
  } else {
    const planar::PaperSet set = planar::ReadPaperSet(source.paper_set);
    model.parameters = set.parameters;
    model.paper_set = set.name;
    model.gamma_3_scale = set.gamma_3_scale;
    if (load_cases.empty()) {
      model.loads.push_back({"set " + set.name, 1.0, planar::Excitation(set.pulses)});
    }
  }
  for (const LoadCase& load_case : load_cases) {
    model.loads.push_back({load_case.name, load_case.weight, MakeExcitation(load_case)});
  }
  return model;
}

planar::Parameters<double> MakeInitialDesign(const Case& c, const LoadedModel& model) {
  planar::Parameters<double> initial = model.parameters;
  DesignValues starts{};
  for (int i = 0; i < kScalarFieldCount; ++i) {
    if (c.variables[i]) starts[i] = c.variables[i]->start;
  }
  SetScalars(initial, starts);
  return initial;
}

}  // namespace kingpin::study
