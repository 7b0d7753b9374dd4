#include "optimisation/study/scenario_modes.h"

#include <complex>

#include <fmt/format.h>

#include "models/planar/linear_frequency_response.h"
#include "models/planar/linear_model.h"
#include "models/planar/linear_modes.h"
#include "optimisation/study/design_space.h"
#include "optimisation/study/model_source.h"

namespace kingpin::study {
namespace {

nlohmann::ordered_json MakeMatrix(const Eigen::MatrixXd& m) {
  auto rows = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    std::vector<double> row;
    for (Eigen::Index j = 0; j < m.cols(); ++j) row.push_back(m(i, j));
    rows.push_back(row);
  }
  return rows;
}

nlohmann::ordered_json MakeModeJson(const planar::Mode& mode) {
  nlohmann::ordered_json json;
  json["kind"] = planar::ToString(mode.kind);
  json["frequency"] = mode.frequency;
  json["damped_frequency"] = mode.damped_frequency;
  json["damping_ratio"] = mode.damping_ratio;
  json["eigenvalue"] = {mode.eigenvalue.real(), mode.eigenvalue.imag()};
  json["shares"] = mode.shares;
  for (const auto& component : mode.shape) {
    json["shape"].push_back({component.real(), component.imag()});
  }
  return json;
}

}  // namespace

ModesResult CalcScenarioModes(const Scenario& scenario, bool held) {
  LoadedModel loaded = LoadModel(scenario.model, scenario.load_cases);
  SetScalars(loaded.parameters, scenario.design);
  planar::LinearModel model = planar::MakeLinearModel(loaded.parameters);
  if (held) model = planar::HoldSteeringWheel(model);
  const planar::Modes modes = planar::CalcModes(model);
  const planar::FrequencyResponse response =
      planar::CalcFrequencyResponse(model, planar::MakeFrequencyGrid(modes, 0.5, 500.0));

  ModesResult result;
  nlohmann::ordered_json& json = result.json;
  json["scenario"] = scenario.name;
  json["steering_wheel"] = held ? "held" : "free";
  json["stable"] = modes.stable;
  json["modes"] = nlohmann::ordered_json::array();
  result.text = fmt::format("{}, steering wheel {}\n  {:>4}{:>14}{:>12}  {}\n", scenario.name,
                            held ? "held" : "free", "", "frequency Hz", "damping %", "mode");
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    const planar::Mode& mode = modes.modes[i];
    json["modes"].push_back(MakeModeJson(mode));
    result.text += fmt::format("  {:>4}{:>14.4f}{:>12.3f}  {}\n", i + 1, mode.frequency,
                               100.0 * mode.damping_ratio, mode.summary);
  }
  if (!modes.stable) result.text += "  ! unstable\n";
  nlohmann::ordered_json& space = json["state_space"];
  space["states"] = model.state_names;
  space["state_units"] = model.state_units;
  space["inputs"] = model.input_names;
  space["input_units"] = model.input_units;
  space["outputs"] = model.output_names;
  space["output_units"] = model.output_units;
  space["A"] = MakeMatrix(model.a);
  space["B"] = MakeMatrix(model.b);
  space["C"] = MakeMatrix(model.c);
  space["D"] = MakeMatrix(model.d);
  for (const std::string& note : model.notes) {
    json["notes"].push_back(note);
    result.text += "  note: " + note + "\n";
  }
  json["frequency_response"]["frequency"] = response.frequency;
  for (std::size_t o = 0; o < response.outputs.size(); ++o) {
    for (std::size_t i = 0; i < response.inputs.size(); ++i) {
      std::vector<double> magnitude, phase;
      for (const auto& value : response.value[o][i]) {
        magnitude.push_back(std::abs(value));
        phase.push_back(std::arg(value));
      }
      json["frequency_response"]["responses"].push_back(
          {{"input", response.inputs[i]},
           {"output", response.outputs[o]},
           {"unit", response.output_units[o] + "/(" + response.input_units[i] + ")"},
           {"magnitude", magnitude},
           {"phase", phase}});
    }
  }
  return result;
}

}  // namespace kingpin::study
