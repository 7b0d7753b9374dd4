#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "optimisation/study/report_parts.h"
#include "optimisation/study/scalar_fields.h"

namespace kingpin::study {
namespace {

using planar::Parameters;

constexpr double kDegree = 180.0 / std::numbers::pi;

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

report::Characteristic MakeCharacteristicAxes(const char* name, const char* x_name,
                                              report::DisplayUnit x_unit, const char* y_name,
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

/// `Fig. 7a: printed optimum, step 1; Fig. 8a: step 2`: what of the paper a chart corresponds to.
std::string DescribeFigures(const Case& c, char part) {
  std::vector<std::pair<std::string, std::string>> figures;  // with the stages
  for (const PrintedDesign& printed : c.printed) {
    if (printed.figure.empty()) continue;
    const auto found = std::find_if(figures.begin(), figures.end(),
                                    [&](const auto& f) { return f.first == printed.figure; });
    if (found == figures.end()) {
      figures.emplace_back(printed.figure, printed.stage);
    } else {
      found->second += ", " + printed.stage;
    }
  }
  std::string text;
  for (const auto& [figure, stages] : figures) {
    text += fmt::format("{}{}{}: initial, {}", text.empty() ? "" : "; ", figure, part, stages);
  }
  return text.empty() ? text : " (the paper's " + text + ")";
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

}  // namespace

report::DisplayUnit GetShownUnit(const std::string& unit) {
  if (unit == "m") return {"mm", 1e3};
  return {unit, 1.0};
}

std::string DescribeFree(const Stage& stage) {
  return fmt::format("{}", fmt::join(stage.free, ", "));
}

std::vector<DesignVariable> CollectVariables(const CaseResult& result) {
  std::vector<DesignVariable> variables;
  for (const DesignResult& design : result.designs) {
    if (!design.space) continue;
    for (const DesignVariable& v : design.space->variables()) {
      const auto same = [&](const DesignVariable& other) { return other.name == v.name; };
      const auto found = std::find_if(variables.begin(), variables.end(), same);
      if (found == variables.end()) {
        variables.push_back(v);
      } else {
        found->lower = std::min(found->lower, v.lower);
        found->upper = std::max(found->upper, v.upper);
      }
    }
  }
  return variables;
}

report::Case MakeReportCase(const Case& c, const CaseResult& result,
                            const std::vector<DesignDetails>& details,
                            const std::array<double, 5>& weights, double sample_interval) {
  report::Case shown;
  shown.name = result.name;
  shown.channels = GetChannels();
  shown.channels.front().name += DescribeFigures(c, 'a');
  shown.spectrum_name += DescribeFigures(c, 'b');
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
    shown.variables.push_back({v.name, DescribeVariable(v, initial.parameters),
                               GetShownUnit(v.unit), v.lower, v.upper, false});
  }
  shown.characteristics = {
      MakeCharacteristicAxes("Power assistance", "Torsion torque", {"N*m"}, "Force on the rack",
                             initial.parameters.assist_force, variables,
                             DesignVariable::Kind::kAssistance),
      MakeCharacteristicAxes("Longitudinal support", "Elongation", {"mm", 1e3}, "Force",
                             initial.parameters.longitudinal_force, variables,
                             DesignVariable::Kind::kLongitudinal)};
  for (std::size_t i = 0; i < result.designs.size(); ++i) {
    shown.designs.push_back(
        MakeReportDesign(result.designs[i], details[i], c, variables, sample_interval));
  }
  for (const Stage& stage : c.stages) {
    for (const DesignResult& design : result.designs) {
      if (design.name == stage.name && design.search) {
        AddReportSearch(stage, design, c, initial, variables, shown);
      }
    }
  }
  for (const SensitivityResult& sensitivity : result.sensitivities) {
    shown.sensitivities.push_back(MakeSensitivity(sensitivity, result.Find(sensitivity.design)));
  }
  // A case that goes beyond the paper shows its front on that page.
  const bool further = std::any_of(c.stages.begin(), c.stages.end(),
                                   [](const Stage& stage) { return stage.further; });
  if (!result.pareto.empty() && !further) shown.pareto.push_back(MakeFront(result, weights));
  shown.warnings = result.warnings;
  return shown;
}

}  // namespace kingpin::study
