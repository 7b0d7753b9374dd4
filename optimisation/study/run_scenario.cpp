#include "optimisation/study/run_scenario.h"

#include <cmath>

#include <fmt/format.h>

#include "models/planar/linear_road_feel.h"
#include "models/planar/reference_simulation.h"
#include "optimisation/measures/companions.h"
#include "optimisation/measures/gammas.h"
#include "optimisation/study/design_details.h"
#include "optimisation/study/design_space.h"
#include "optimisation/study/model_source.h"
#include "optimisation/study/quantities.h"

namespace kingpin::study {
namespace {

planar::History Run(const Scenario& scenario, const planar::Parameters<double>& parameters,
                    const planar::Excitation& excitation,
                    std::vector<std::pair<std::string, double>>& statistics) {
  if (scenario.method == ScenarioMethod::kCvode) {
    planar::ReferenceOptions options;
    options.duration = scenario.duration;
    options.sample_interval = scenario.sample_interval;
    planar::ReferenceRun run = planar::SimulateReference(parameters, excitation, options);
    statistics = {{"steps", static_cast<double>(run.statistics.steps)},
                  {"force_evaluations", static_cast<double>(run.statistics.force_evaluations)},
                  {"jacobians", static_cast<double>(run.statistics.jacobians)},
                  {"restarts", static_cast<double>(run.statistics.restarts)},
                  {"events", static_cast<double>(run.statistics.events.size())}};
    return std::move(run.history);
  }
  planar::SimulationOptions options;
  options.duration = scenario.duration;
  options.sample_interval = scenario.sample_interval;
  if (scenario.method == ScenarioMethod::kRungeKutta4) {
    options.method = planar::Method::kRungeKutta4;
    options.step = 1e-5;
  }
  if (scenario.step > 0.0) options.step = scenario.step;
  planar::History history = planar::Simulate(parameters, excitation, options);
  const planar::IntegrationRecord& integration = history.integration;
  statistics = {{"step", integration.step}, {"steps", static_cast<double>(integration.steps)}};
  if (!std::isnan(integration.error_estimate)) {
    statistics.emplace_back("error_estimate", integration.error_estimate);
    statistics.emplace_back("error_bound", integration.error_bound);
  }
  return history;
}

nlohmann::ordered_json MakeValue(double value, const std::string& unit) {
  return {{"value", value}, {"unit", unit}};
}

nlohmann::ordered_json MakeExtremes(const measures::Extremes& e, const std::string& unit) {
  return {{"peak", MakeValue(e.peak, unit)},
          {"time_of_peak", MakeValue(e.time_of_peak, "s")},
          {"peak_to_peak", MakeValue(e.peak_to_peak, unit)},
          {"impulse", MakeValue(e.impulse, unit + " s")}};
}

}  // namespace

ScenarioResult RunScenario(const Scenario& scenario) {
  LoadedModel model = LoadModel(scenario.model, scenario.load_cases);
  SetScalars(model.parameters, scenario.design);
  const WeightedLoad& load = model.loads.front();
  ScenarioResult result;
  const planar::History history =
      Run(scenario, model.parameters, load.excitation, result.statistics);
  result.signals = MakeSignals(history);

  const measures::GammaPlan plan(history.size(), scenario.sample_interval,
                                 MakeConventions(scenario.measures, model.gamma_3_scale));
  measures::GammaWorkspace workspace(plan);
  const measures::Gammas<double> gammas = workspace.Update(history.rim_acceleration);
  measures::CompanionOptions companion_options;
  companion_options.weighting = plan.conventions().weighting;
  const measures::Companions companions = measures::CalcCompanions(
      {history.rim_acceleration, history.torsion_torque, history.rack_force, history.tie_rod_force},
      scenario.sample_interval, companion_options);

  const auto units = measures::DescribeUnits(plan.conventions());
  const auto words = measures::DescribeMeasures(plan.conventions());
  nlohmann::ordered_json& json = result.summary;
  json["scenario"] = scenario.name;
  json["load_case"] = load.name;
  result.text = fmt::format("{}, {}\n", scenario.name, load.name);
  for (int k = 0; k < measures::kMeasureCount; ++k) {
    const std::string key = "gamma_" + std::to_string(k + 1);
    json["measures"][key] = {{"value", gammas[k]}, {"unit", units[k]}, {"definition", words[k]}};
    result.text += fmt::format("  Γ_{} {:>14.6g} {}\n", k + 1, gammas[k], units[k]);
  }
  json["torsion_torque"] = MakeExtremes(*companions.torsion_torque, "N m");
  json["rack_force"] = MakeExtremes(*companions.rack_force, "N");
  json["tie_rod_force"] = MakeExtremes(*companions.tie_rod_force, "N");
  json["rim_acceleration"] = {{"rmq_weighted", MakeValue(companions.weighted.rmq, "m/s^2")},
                              {"vdv_weighted", MakeValue(companions.weighted.vdv, "m/s^1.75")},
                              {"short_decay_time", MakeValue(companions.short_decay_time, "s")}};
  json["road_feel_gain"] = MakeValue(planar::CalcRoadFeelGain(model.parameters), "N m/(N m)");
  json["static_road_feel_gain"] =
      MakeValue(planar::CalcStaticRoadFeel(model.parameters), "N m/(N m)");
  json["steering_ratio"] = MakeValue(CalcSteeringRatio(model.parameters), "rad/rad");
  const double residual = history.CalcEnergyResidual();
  json["energy_residual"] = MakeValue(residual, "J/J");
  result.text += fmt::format(
      "  torsion torque peak-to-peak {:.4g} N m, tie-rod force peak {:.4g} N, rack force peak "
      "{:.4g} N\n"
      "  energy residual {:.1e} of the energy supplied\n",
      companions.torsion_torque->peak_to_peak, companions.tie_rod_force->peak,
      companions.rack_force->peak, residual);
  for (const auto& [name, value] : result.statistics) {
    json["solver"][name] = MakeValue(value, name == "step" ? "s" : "1");
  }
  return result;
}

}  // namespace kingpin::study
