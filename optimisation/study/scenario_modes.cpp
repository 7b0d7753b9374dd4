#include "optimisation/study/scenario_modes.h"

#include <fmt/format.h>

#include "models/planar/linear_export.h"
#include "optimisation/study/design_space.h"
#include "optimisation/study/model_source.h"

namespace kingpin::study {

ModesResult CalcScenarioModes(const Scenario& scenario, bool held) {
  LoadedModel loaded = LoadModel(scenario.model, scenario.load_cases);
  SetScalars(loaded.parameters, scenario.design);
  const planar::LinearAnalysis analysis = planar::AnalyseLinearly(loaded.parameters);

  ModesResult result;
  result.json["scenario"] = scenario.name;
  result.json.update(planar::MakeJson(analysis));
  const planar::Modes& modes = held ? analysis.held_modes : analysis.free_modes;
  const planar::LinearModel& model = held ? analysis.held : analysis.free;
  result.text = fmt::format("{}, steering wheel {}\n  {:>4}{:>14}{:>12}  {}\n", scenario.name,
                            held ? "held" : "free", "", "frequency Hz", "damping %", "mode");
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    const planar::Mode& mode = modes.modes[i];
    result.text += fmt::format("  {:>4}{:>14.4f}{:>12.3f}  {}\n", i + 1, mode.frequency,
                               100.0 * mode.damping_ratio, mode.summary);
  }
  if (!modes.stable) result.text += "  ! unstable\n";
  for (const std::string& note : model.notes) result.text += "  note: " + note + "\n";
  return result;
}

}  // namespace kingpin::study
