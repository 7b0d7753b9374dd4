#include "optimisation/study/make_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/io/version.h"
#include "core/signal/spectrum.h"
#include "models/planar/curve_spline.h"
#include "optimisation/measures/conventions.h"
#include "optimisation/study/quantities.h"
#include "optimisation/study/scalar_fields.h"
#include "optimisation/study/stage_problem.h"

namespace kingpin::study {
namespace {

using planar::Parameters;
using report::DisplayUnit;
using report::Preference;

constexpr double kDegree = 180.0 / std::numbers::pi;

// ------------------------------------------------------------------------------------ measures

std::vector<report::Measure> MakeMeasures(const StudyResult& study) {
  const auto& conventions = study.cases.front().conventions;
  const auto units = measures::DescribeUnits(conventions);
  const auto definitions = measures::DescribeMeasures(conventions);
  const std::array<const char*, 5> names{
      "Peak-to-peak rim acceleration", "Moving-window vibration level",
      "Frequency-weighted vibration", "Dissipation time", "Root mean square rim acceleration"};
  std::vector<report::Measure> rows;
  for (int k = 0; k < measures::kMeasureCount; ++k) {
    report::Measure row;
    row.symbol = "Γ_" + std::to_string(k + 1);
    row.name = names[k];
    row.unit = {units[k], 1.0};
    row.definition = definitions[k];
    row.weight = study.definition.weights()[k];
    row.headline = k == 0 || k == 4;
    rows.push_back(std::move(row));
  }
  const auto add = [&](const char* name, DisplayUnit unit, const char* definition,
                       Preference preference, double good = report::kMissing,
                       double poor = report::kMissing) {
    report::Measure row;
    row.name = name;
    row.unit = std::move(unit);
    row.definition = definition;
    row.preference = preference;
    row.good = good;
    row.poor = poor;
    rows.push_back(std::move(row));
  };
  const auto lower = Preference::kLower;
  add("Torsion torque, peak-to-peak", {"N*m"},
      "Of the column's torsion torque; largest over the load cases. Orientation only: below 3 N*m "
      "good, above 5.5 N*m disturbing.",
      lower, 3.0, 5.5);
  add("Torsion torque, peak", {"N*m"}, "Largest magnitude over the load cases.", lower);
  add("Rack force, peak", {"kN", 1e-3}, "Of the tie rod on the rack; largest over the load cases.",
      lower);
  add("Tie-rod force, peak", {"kN", 1e-3}, "Axial; largest over the load cases.", lower);
  add("Rim acceleration, r.m.q. (weighted)", {"m/s^2"},
      "Root mean quad of the weighted rim acceleration; largest over the load cases.", lower);
  add("Vibration dose value (weighted)", {"m/s^1.75"},
      "VDV of the weighted rim acceleration, ISO 2631-1; largest over the load cases.", lower);
  add("Decay time, short window", {"ms", 1e3},
      "As Γ_4 with a window of 50 ms; largest over the load cases.", lower);
  add("Road-feel gain", {"N*m/(N*m)"},
      "Torsion torque per moment about the vertical axis on the wheel carrier, steering wheel "
      "held, mean over 0 to 10 Hz.",
      Preference::kHigher);
  add("Steering ratio", {"rad/rad"},
      "Steering wheel angle per road wheel angle at the design position, rigid supports.",
      Preference::kNeutral);
  return rows;
}

template <class Get>
double Largest(const std::vector<measures::Companions>& companions, Get get) {
  double largest = 0.0;
  for (const auto& c : companions) largest = std::max(largest, get(c));
  return largest;
}

std::vector<double> MakeMeasureValues(const DesignResult& design, const DesignDetails& details) {
  std::vector<double> values(design.gammas.begin(), design.gammas.end());
  const auto& c = details.companions;
  using measures::Companions;
  values.push_back(Largest(c, [](const Companions& x) { return x.torsion_torque->peak_to_peak; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.torsion_torque->peak; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.rack_force->peak; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.tie_rod_force->peak; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.weighted.rmq; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.weighted.vdv; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.short_decay_time; }));
  values.push_back(design.road_feel_gain);
  values.push_back(design.steering_ratio);
  return values;
}

// ------------------------------------------------------------------------------------ one design

const std::vector<report::Channel>& Channels() {
  static const std::vector<report::Channel> channels{
      {"Rim acceleration", "A_tan", {"m/s^2"}, false},
      {"Torsion torque", "M_sw", {"N*m"}, false},
      {"Force of the tie rod on the rack", "", {"kN", 1e-3}, false},
      {"Tie-rod force", "F_R", {"kN", 1e-3}, false},
      {"Steering wheel angle", "φ", {"deg", kDegree}, false},
      {"Rack travel", "y", {"mm", 1e3}, false},
      {"Road force", "F_T", {"kN", 1e-3}, true}};
  return channels;
}

report::Curve MakeCurve(const planar::Curve<double>& curve) {
  const auto spline = planar::MakeSpline(curve);
  report::Curve sampled;
  constexpr int kPoints = 121;
  const double first = curve.x[0], last = curve.x[curve.count - 1];
  for (int i = 0; i < kPoints; ++i) {
    const double x = first + (last - first) * i / (kPoints - 1);
    sampled.x.push_back(x);
    sampled.y.push_back(spline(x));
  }
  return sampled;
}

report::CharacteristicCurve MakeCharacteristic(const planar::Curve<double>& curve) {
  report::CharacteristicCurve shown;
  if (curve.count < 2) return shown;
  shown.curve = MakeCurve(curve);
  shown.nodes.x.assign(curve.x.begin(), curve.x.begin() + curve.count);
  shown.nodes.y.assign(curve.f.begin(), curve.f.begin() + curve.count);
  return shown;
}

report::CornerGeometry MakeGeometry(const Parameters<double>& p, const Case& c) {
  report::CornerGeometry g;
  g.name = "front left";
  g.centre_of_mass = {0.0, 0.0};
  g.force_point = {p.force_x, p.force_y};
  g.rod_outer = {p.design_origin_x + p.outer_joint_x, p.design_origin_y + p.outer_joint_y};
  g.rod_inner = {p.design_origin_x + p.rack_position, p.rack_half_length - p.half_track};
  g.rack_half_length = p.rack_half_length;
  g.lateral_support = {p.lateral_x, p.lateral_y};
  g.lateral_direction = p.lateral_angle;
  g.longitudinal_support = {p.longitudinal_x, p.longitudinal_y};
  g.longitudinal_direction = p.longitudinal_angle;
  if (c.model.car) {
    g.kingpin = {p.design_origin_x, p.design_origin_y};
    if (c.model.options.road_force_at == planar::CarModeOptions::RoadForceAt::kWheelCentre) {
      g.wheel_centre = g.force_point;
      g.wheel_radius = c.model.car->tyres.free_radius;
      // The parameter set has no tyre width; the outline only needs the proportions of a wheel.
      constexpr double kDrawnWidthOverRadius = 0.6;
      g.wheel_width = kDrawnWidthOverRadius * g.wheel_radius;
    }
  }
  return g;
}

report::CornerMotion MakeMotion(const planar::History& h) {
  return {h.time, h.q[0], h.q[1], h.q[2], h.q[3], h.q[4], h.road_force};
}

std::vector<report::Mode> MakeModes(const planar::Modes& modes) {
  std::vector<report::Mode> rows;
  for (const planar::Mode& mode : modes.modes) {
    rows.push_back({mode.frequency, mode.damping_ratio, mode.summary});
  }
  return rows;
}

report::Design MakeDesignData(const DesignResult& design, const DesignDetails& details,
                              const Case& c, const std::vector<report::Variable>& variables,
                              const std::vector<DesignVariable>& sources, double sample_interval) {
  report::Design data;
  data.name = design.name;
  data.measures = MakeMeasureValues(design, details);
  for (std::size_t i = 0; i < variables.size(); ++i) {
    data.variables.push_back(GetVariable(design.parameters, sources[i]));
  }
  data.objective = design.sum_of_ratios;
  const planar::History& h = details.histories.front();
  data.time = h.time;
  data.histories = {h.rim_acceleration, h.torsion_torque, h.rack_force,
                    h.tie_rod_force,    h.q[4],           h.q[3],
                    h.road_force};
  const signal::Spectrum spectrum =
      signal::MakeAmplitudeSpectrum(h.rim_acceleration, sample_interval);
  data.spectrum = {spectrum.frequency, spectrum.value};
  data.response_frequency = details.response.frequency;
  for (const char* output : {"tie_rod.force", "steering.wheel.angle"}) {
    const auto& outputs = details.response.outputs;
    const auto found = std::find(outputs.begin(), outputs.end(), output);
    data.frequency_responses.push_back(details.response.value[found - outputs.begin()][0]);
  }
  data.modes = MakeModes(details.modes);
  data.characteristics = {MakeCharacteristic(design.parameters.assist_force),
                          MakeCharacteristic(design.parameters.longitudinal_force)};
  data.geometry = MakeGeometry(design.parameters, c);
  data.motion = MakeMotion(h);
  data.note = design.relative_to == design.name
                  ? std::string("The reference of all ratios.")
                  : fmt::format("Sum of ratios {:.4g}, relative to {}.", design.sum_of_ratios,
                                design.relative_to);
  return data;
}

// ------------------------------------------------------------------------------------ one case

/// All variables that any search of the case freed.
std::vector<DesignVariable> CollectVariables(const CaseResult& result) {
  std::vector<DesignVariable> variables;
  for (const DesignResult& design : result.designs) {
    if (!design.space) continue;
    for (const DesignVariable& v : design.space->variables()) {
      const auto same = [&](const DesignVariable& other) { return other.name == v.name; };
      if (std::none_of(variables.begin(), variables.end(), same)) variables.push_back(v);
    }
  }
  return variables;
}

std::string DescribeVariable(const DesignVariable& v, const Parameters<double>& p) {
  switch (v.kind) {
    case DesignVariable::Kind::kAssistance:
      return fmt::format("Assistance at {:.3g} N m", p.assist_force.x[v.index]);
    case DesignVariable::Kind::kLongitudinal:
      return fmt::format("Longitudinal support at {:.3g} mm",
                         1e3 * p.longitudinal_force.x[v.index]);
    case DesignVariable::Kind::kScalar:
      break;
  }
  return ScalarFields<double>()[v.index].description;
}

DisplayUnit ShownUnit(const DesignVariable& v) {
  if (v.unit == "m") return {"mm", 1e3};
  return {v.unit, 1.0};
}

report::Characteristic MakeCharacteristicAxes(const char* name, const char* x_name,
                                              DisplayUnit x_unit, const char* y_name,
                                              const planar::Curve<double>& initial,
                                              const std::vector<DesignVariable>& variables,
                                              DesignVariable::Kind kind) {
  report::Characteristic characteristic{name, x_name, std::move(x_unit), y_name, {"kN", 1e-3},
                                        {},   {}};
  report::Curve lower, upper;
  bool any = false;
  for (int k = 0; k < initial.count; ++k) {
    double low = initial.f[k], high = initial.f[k];
    for (const DesignVariable& v : variables) {
      if (v.kind != kind) continue;
      if (v.index == k) low = v.lower, high = v.upper, any = true;
      if (v.mirror == k) low = -v.upper, high = -v.lower;
    }
    lower.x.push_back(initial.x[k]);
    lower.y.push_back(low);
    upper.x.push_back(initial.x[k]);
    upper.y.push_back(high);
  }
  if (any) {
    characteristic.lower = std::move(lower);
    characteristic.upper = std::move(upper);
  }
  return characteristic;
}

std::string DescribeFree(const Stage& stage) {
  return fmt::format("{}", fmt::join(stage.free, ", "));
}

void AddSearch(const Stage& stage, const DesignResult& design, const Case& c, report::Case& shown,
               const std::vector<DesignVariable>& variables) {
  const optimisation::Result& search = *design.search;
  report::Stage row;
  row.name = design.name;
  row.algorithm = search.algorithm;
  row.free = DescribeFree(stage);
  row.evaluations = search.evaluations;
  row.seconds = design.seconds;
  row.start = search.start_value;
  row.end = search.value;
  row.status = search.status;
  for (const PrintedDesign& printed : c.printed) {
    if (printed.stage == design.name && printed.seconds) row.paper_seconds = *printed.seconds;
  }
  shown.stages.push_back(std::move(row));

  report::Convergence convergence;
  convergence.name = design.name;
  for (const auto& point : search.history) {
    convergence.evaluations.push_back(static_cast<double>(point.evaluations));
    convergence.best.push_back(point.value);
  }
  shown.convergence.push_back(std::move(convergence));

  if (!search.restarts.empty()) {
    report::Restarts restarts;
    restarts.name = design.name;
    for (const auto& restart : search.restarts) {
      restarts.start_values.push_back(restart.start_value);
      restarts.end_values.push_back(restart.value);
      std::vector<double> end(variables.size(), report::kMissing);
      for (int i = 0; i < design.space->size() && i < static_cast<int>(restart.end.size()); ++i) {
        for (std::size_t j = 0; j < variables.size(); ++j) {
          if (variables[j].name == design.space->variables()[i].name) end[j] = restart.end[i];
        }
      }
      restarts.end_designs.push_back(std::move(end));
    }
    shown.restarts.push_back(std::move(restarts));
  }
  for (const auto& active : search.active) {
    report::ActiveConstraint row_active;
    row_active.design = design.name;
    row_active.name = active.name + ", " + active.kind;
    for (const DesignVariable& v : design.space->variables()) {
      if (v.name != active.name) continue;
      row_active.value = GetVariable(design.parameters, v);
      row_active.limit = active.kind == "lower bound" ? v.lower : v.upper;
      row_active.unit = ShownUnit(v);
      if (active.multiplier) {
        row_active.effect =
            fmt::format("sum of ratios falls by {:.3g} per 1 % of the range of loosening",
                        *active.multiplier * 0.01 * (v.upper - v.lower));
      }
    }
    shown.active.push_back(std::move(row_active));
  }
}

report::Sensitivity MakeSensitivity(const SensitivityResult& sensitivity,
                                    const DesignResult& design) {
  report::Sensitivity shown;
  shown.design = sensitivity.design;
  for (int k = 0; k < measures::kMeasureCount; ++k) {
    shown.measures.push_back("Γ_" + std::to_string(k + 1));
  }
  shown.measures.emplace_back("road feel");
  shown.meaning =
      "Exact derivatives (dual numbers) times one hundredth of the variable's range, in per cent "
      "of the "
      "measure.";
  const auto& variables = sensitivity.space.variables();
  for (std::size_t i = 0; i < variables.size(); ++i) {
    shown.variables.push_back(variables[i].name);
    const double range = variables[i].upper - variables[i].lower;
    std::vector<double> row;
    for (int k = 0; k < measures::kMeasureCount; ++k) {
      row.push_back(sensitivity.derivative[i][k] * range / design.gammas[k]);
    }
    row.push_back(sensitivity.road_feel_derivative[i] * range / design.road_feel_gain);
    shown.values.push_back(std::move(row));
  }
  return shown;
}

report::ParetoFront MakeFront(const CaseResult& result) {
  report::ParetoFront front;
  front.name = result.name + ": kickback against road feel";
  front.x_name = "Road-feel gain";
  front.x_unit = {"N*m/(N*m)"};
  front.y_name = "Sum of ratios to the initial design";
  for (const ParetoPointResult& point : result.pareto) {
    front.front.push_back({point.road_feel_gain, point.sum_of_ratios, ""});
  }
  const auto& initial = result.designs.front();
  for (const DesignResult& design : result.designs) {
    double sum = 0.0;
    for (int k = 0; k < measures::kMeasureCount; ++k) {
      sum += design.gammas[k] / initial.gammas[k];
    }
    front.marked.push_back({design.road_feel_gain, sum, design.name});
  }
  front.note =
      "No design to the left and above a point of the front was found that beats it in both.";
  return front;
}

report::Case MakeCase(const Case& c, const CaseResult& result,
                      const std::vector<DesignDetails>& details, double sample_interval) {
  report::Case shown;
  shown.name = result.name;
  shown.channels = Channels();
  shown.responses = {{"Road force F_T to tie-rod force F_R", {"N/N"}},
                     {"Road force F_T to steering wheel angle φ", {"deg/kN", kDegree * 1e3}}};
  shown.weighting_name = result.conventions.weighting.name();
  for (double f = 1.0; f <= 500.0; f *= 1.05) {
    shown.weighting.x.push_back(f);
    shown.weighting.y.push_back(result.conventions.weighting.CalcMagnitude(f));
  }
  shown.spectrum_max_hz = 100.0;
  const std::vector<DesignVariable> variables = CollectVariables(result);
  const DesignResult& initial = result.designs.front();
  for (const DesignVariable& v : variables) {
    shown.variables.push_back(
        {v.name, DescribeVariable(v, initial.parameters), ShownUnit(v), v.lower, v.upper, false});
  }
  shown.characteristics = {
      MakeCharacteristicAxes("Power assistance", "Torsion torque", {"N*m"}, "Force on the rack",
                             initial.parameters.assist_force, variables,
                             DesignVariable::Kind::kAssistance),
      MakeCharacteristicAxes("Longitudinal support", "Elongation", {"mm", 1e3}, "Force",
                             initial.parameters.longitudinal_force, variables,
                             DesignVariable::Kind::kLongitudinal)};
  for (std::size_t i = 0; i < result.designs.size(); ++i) {
    shown.designs.push_back(MakeDesignData(result.designs[i], details[i], c, shown.variables,
                                           variables, sample_interval));
  }
  for (const Stage& stage : c.stages) {
    for (const DesignResult& design : result.designs) {
      if (design.name == stage.name && design.search) {
        AddSearch(stage, design, c, shown, variables);
      }
    }
  }
  for (const SensitivityResult& sensitivity : result.sensitivities) {
    shown.sensitivities.push_back(MakeSensitivity(sensitivity, result.Find(sensitivity.design)));
  }
  if (!result.pareto.empty()) shown.pareto.push_back(MakeFront(result));
  shown.warnings = result.warnings;
  return shown;
}

// ------------------------------------------------------------------------------------ the study

void AddFurther(const StudyResult& study, report::Further& further) {
  for (int k = 0; k < measures::kMeasureCount; ++k) {
    further.ratio_symbols.push_back("Γ_" + std::to_string(k + 1));
  }
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    const CaseResult& result = study.cases[i];
    const DesignResult& initial = result.designs.front();
    for (const Stage& stage : study.definition.cases[i].stages) {
      if (!stage.further) continue;
      for (const DesignResult& design : result.designs) {
        if (design.name != stage.name) continue;
        report::FurtherRow row;
        row.name = (result.paper_set.empty() ? "" : "set " + result.paper_set + ", ") + result.name;
        row.freedom = stage.name + " (" + DescribeFree(stage) + ")";
        row.objective_start = study.definition.weights()[0] + study.definition.weights()[1] +
                              study.definition.weights()[2] + study.definition.weights()[3] +
                              study.definition.weights()[4];
        row.objective =
            measures::CalcObjective(design.gammas, initial.gammas, study.definition.weights());
        for (const DesignResult& other : result.designs) {
          if (other.name == "OPT2") {
            row.objective_paper =
                measures::CalcObjective(other.gammas, initial.gammas, study.definition.weights());
          }
        }
        for (int k = 0; k < measures::kMeasureCount; ++k) {
          row.ratios.push_back(design.gammas[k] / initial.gammas[k]);
        }
        row.road_feel_ratio = design.road_feel_gain / initial.road_feel_gain;
        further.rows.push_back(std::move(row));
      }
    }
    if (!further.rows.empty() && !result.pareto.empty() &&
        further.rows.back().name.ends_with(result.name)) {
      further.pareto.push_back(MakeFront(result));
    }
  }
  if (further.rows.empty()) {
    further = {};
    return;
  }
  further.text =
      "How much lower the measures go when more is free than in the paper, and what that costs in "
      "road feel. Ratios are to the case's initial design.";
}

std::vector<report::ParameterGroup> MakeParameterGroups(const StudyResult& study,
                                                        const io::InputRecord& inputs) {
  std::vector<report::ParameterGroup> groups;
  for (const CaseResult& result : study.cases) {
    if (result.derived.empty()) continue;
    report::ParameterGroup group;
    group.title = "Derived for the planar model: " + result.name;
    group.source = "docs/theory/car-reduction.md";
    for (const auto& quantity : result.derived) {
      group.parameters.push_back({quantity.name, fmt::format("{:.6g}", quantity.value),
                                  quantity.unit, quantity.formula + "; " + quantity.source, false});
    }
    groups.push_back(std::move(group));
  }
  report::ParameterGroup group;
  group.title = "As read";
  for (const io::ValueRecord& value : inputs.values) {
    std::string origin = io::FormatOrigin(value.origin);
    if (!value.origin.certainty.empty()) origin += " [" + value.origin.certainty + "]";
    if (!value.origin.source.empty()) origin += " " + value.origin.source;
    const bool as_number = value.numbers.size() == 1;
    group.parameters.push_back(
        {value.path, as_number ? fmt::format("{:.6g}", value.numbers[0]) : value.value, value.unit,
         origin, value.origin.kind == io::ValueOrigin::Kind::kCommandLine});
  }
  groups.push_back(std::move(group));
  return groups;
}

}  // namespace

StudyDetails CalcStudyDetails(const StudyResult& study) {
  StudyDetails details;
  for (const CaseResult& result : study.cases) {
    std::vector<DesignDetails>& of_case = details.emplace_back();
    const auto samples = static_cast<std::size_t>(
        std::llround(study.definition.duration / study.definition.sample_interval) + 1);
    const measures::GammaPlan plan(samples, study.definition.sample_interval, result.conventions);
    for (const DesignResult& design : result.designs) {
      of_case.push_back(CalcDetails(design.parameters, result.loads, plan,
                                    study.definition.duration, study.definition.sample_interval));
    }
  }
  return details;
}

report::StudyReportData MakeReport(const StudyResult& study, const StudyDetails& details,
                                   const io::InputRecord& inputs, const ReportContext& context) {
  report::StudyReportData data;
  data.title = "Steering kickback: " + study.definition.name;
  data.subtitle = study.definition.description;
  data.created = context.created;
  data.program = io::FormatVersion();
  data.command = context.command;
  data.run_seconds = study.seconds;
  data.measures = MakeMeasures(study);
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    data.cases.push_back(MakeCase(study.definition.cases[i], study.cases[i], details[i],
                                  study.definition.sample_interval));
  }
  data.comparisons = MakeComparisons(study);
  AddFurther(study, data.further);
  data.parameters = MakeParameterGroups(study, inputs);
  if (study.cancelled) data.warnings.emplace_back("The study was stopped before it was finished.");
  data.conventions.push_back(
      {"Γ over several load cases", "weighted mean of the load cases' values"});
  data.conventions.push_back(
      {"Axes and signs", "ISO 8855: x forward, y left, z up; angles counter-clockwise from above"});
  data.conventions.push_back(
      {"Samples", fmt::format("every {:g} ms over {:g} s", 1e3 * study.definition.sample_interval,
                              study.definition.duration)});
  for (const CaseResult& result : study.cases) {
    for (const WeightedLoad& load : result.loads) {
      data.conventions.push_back(
          {"Load case, " + result.name, fmt::format("{}, weight {:g}", load.name, load.weight)});
    }
  }
  data.solver.push_back({"simulations", std::to_string(study.simulations)});
  data.solver.push_back({"wall time", fmt::format("{:.2f} s", study.seconds)});
  data.solver.push_back({"threads", std::to_string(context.threads)});
  data.solver.push_back({"seed", std::to_string(study.definition.seed)});
  const io::Version version = io::GetVersion();
  data.versions = {{"program", io::FormatVersion()},
                   {"compiler", version.compiler},
                   {"instruction set", context.instruction_set}};
  return data;
}

}  // namespace kingpin::study
