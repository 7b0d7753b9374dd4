#include "optimisation/study/study_summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "optimisation/measures/conventions.h"
#include "optimisation/study/design_space.h"
#include "optimisation/study/scalar_fields.h"

namespace kingpin::study {
namespace {

constexpr const char* kGammaKeys[] = {"gamma_1", "gamma_2", "gamma_3", "gamma_4", "gamma_5"};

/// Pads UTF-8 text to a width in characters, which fmt's width is not sure to do for Greek letters.
std::string Pad(const std::string& text, std::size_t width) {
  std::size_t characters = 0;
  for (const char c : text) characters += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return characters >= width ? text : text + std::string(width - characters, ' ');
}

std::string FormatRatioRow(const DesignResult& design, const DesignResult& initial,
                           const std::array<double, 5>& weights) {
  std::string row = "  " + Pad(design.name, 26);
  for (int k = 0; k < measures::kMeasureCount; ++k) {
    row += fmt::format("{:>9.3f}", design.gammas[k] / initial.gammas[k]);
  }
  row += fmt::format("{:>9.3f}", measures::CalcObjective(design.gammas, initial.gammas, weights));
  row += fmt::format("{:>11.3f}", design.road_feel_gain / initial.road_feel_gain);
  if (design.search) {
    row += fmt::format("{:>12}{:>9.2f} s", design.search->evaluations, design.seconds);
  }
  if (design.relative_to != initial.name) {
    row += fmt::format("   {:.3f} relative to {}", design.sum_of_ratios, design.relative_to);
  }
  return row + "\n";
}

nlohmann::ordered_json MakeDesignJson(const DesignResult& design) {
  nlohmann::ordered_json json;
  json["name"] = design.name;
  for (int k = 0; k < measures::kMeasureCount; ++k) json[kGammaKeys[k]] = design.gammas[k];
  json["sum_of_ratios"] = design.sum_of_ratios;
  json["relative_to"] = design.relative_to;
  json["road_feel_gain"] = design.road_feel_gain;
  json["static_road_feel_gain"] = design.static_road_feel_gain;
  json["steering_ratio"] = design.steering_ratio;
  nlohmann::ordered_json geometry;
  const auto fields = ScalarFields<double>();
  for (int i = 0; i < 4; ++i) geometry[fields[i].name] = design.parameters.*(fields[i].member);
  json["geometry"] = geometry;
  const auto add_curve = [&](const char* name, const planar::Curve<double>& curve) {
    json[name]["kind"] =
        curve.kind == planar::CurveKind::kMonotone ? "monotone cubic" : "natural cubic";
    json[name]["x"] = std::vector<double>(curve.x.begin(), curve.x.begin() + curve.count);
    json[name]["f"] = std::vector<double>(curve.f.begin(), curve.f.begin() + curve.count);
  };
  if (design.parameters.assist_force.count > 0) {
    add_curve("assistance", design.parameters.assist_force);
  }
  add_curve("longitudinal", design.parameters.longitudinal_force);
  if (!design.search) return json;
  const optimisation::Result& search = *design.search;
  nlohmann::ordered_json& out = json["search"];
  out["algorithm"] = search.algorithm;
  out["status"] = search.status;
  out["evaluations"] = search.evaluations;
  out["gradient_evaluations"] = search.gradient_evaluations;
  out["simulations"] = design.simulations;
  out["seconds"] = design.seconds;
  out["start_value"] = search.start_value;
  out["value"] = search.value;
  out["feasible"] = search.feasible;
  out["variables"] = nlohmann::ordered_json::array();
  for (const DesignVariable& v : design.space->variables()) {
    out["variables"].push_back({{"name", v.name},
                                {"unit", v.unit},
                                {"value", GetVariable(design.parameters, v)},
                                {"lower", v.lower},
                                {"upper", v.upper}});
  }
  out["active"] = nlohmann::ordered_json::array();
  for (const auto& active : search.active) {
    out["active"].push_back({{"name", active.name}, {"kind", active.kind}});
  }
  out["local_minima"] = nlohmann::ordered_json::array();
  for (const auto& minimum : search.minima) {
    out["local_minima"].push_back(
        {{"x", minimum.x}, {"value", minimum.value}, {"searches", minimum.searches}});
  }
  out["restarts"] = nlohmann::ordered_json::array();
  for (const auto& restart : search.restarts) {
    out["restarts"].push_back(
        {{"start", restart.start}, {"end", restart.end}, {"value", restart.value}});
  }
  return json;
}

}  // namespace

std::string FormatComparison(const report::Comparison& comparison) {
  std::string text = comparison.title + "\n  " + Pad("", 8) + fmt::format("{:>12}", "paper");
  for (const std::string& column : comparison.columns) {
    text += fmt::format("{:>12}{:>9}", column, "diff");
  }
  text += "\n";
  for (const report::ComparisonRow& row : comparison.rows) {
    text += "  " + Pad(row.symbol.empty() ? "time" : row.symbol, 8) +
            fmt::format("{:>12.6g}", row.unit.per_si * row.paper);
    // A length is a coordinate, whose zero is arbitrary.
    const bool absolute = row.unit.text == "mm" || row.paper == 0.0;
    for (const double ours : row.ours) {
      text += fmt::format("{:>12.6g}", row.unit.per_si * ours);
      if (absolute) {
        text += fmt::format("{:>+9.2g}", row.unit.per_si * (ours - row.paper));
      } else {
        text += fmt::format("{:>8.1f}%", 100.0 * (ours - row.paper) / std::abs(row.paper));
      }
    }
    if (!row.unit.text.empty()) text += "  " + row.unit.text;
    text += "\n";
  }
  return text;
}

std::string FormatSummary(const StudyResult& study,
                          const std::vector<report::Comparison>& comparisons) {
  std::string text = study.definition.name + "\n";
  for (const CaseResult& result : study.cases) {
    const DesignResult& initial = result.designs.front();
    const auto units = measures::DescribeUnits(result.conventions);
    text += fmt::format("\n{}\n  initial:", result.name);
    for (int k = 0; k < measures::kMeasureCount; ++k) {
      text += fmt::format("  Γ_{} = {:.5g} {}", k + 1, initial.gammas[k], units[k]);
    }
    text += fmt::format("\n  {}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>11}{:>12}{:>11}\n",
                        Pad("ratio to initial", 26), "Γ_1", "Γ_2", "Γ_3", "Γ_4", "Γ_5", "sum",
                        "road feel", "evaluations", "time");
    for (std::size_t i = 1; i < result.designs.size(); ++i) {
      text += FormatRatioRow(result.designs[i], initial, study.definition.weights());
    }
    for (const std::string& warning : result.warnings) text += "  ! " + warning + "\n";
  }
  for (const report::Comparison& comparison : comparisons) {
    text += "\n" + FormatComparison(comparison);
  }
  text += fmt::format("\n{} simulations in {:.1f} s\n", study.simulations, study.seconds);
  if (study.cancelled) text += "Stopped before the end; what was finished is kept.\n";
  return text;
}

nlohmann::ordered_json MakeSummary(const StudyResult& study) {
  nlohmann::ordered_json json;
  json["study"] = study.definition.name;
  json["finished"] = !study.cancelled;
  json["seconds"] = study.seconds;
  json["simulations"] = study.simulations;
  json["cases"] = nlohmann::ordered_json::array();
  for (const CaseResult& result : study.cases) {
    nlohmann::ordered_json c;
    c["name"] = result.name;
    const auto units = measures::DescribeUnits(result.conventions);
    const auto words = measures::DescribeMeasures(result.conventions);
    for (int k = 0; k < measures::kMeasureCount; ++k) {
      c["conventions"][kGammaKeys[k]] = {{"unit", units[k]}, {"definition", words[k]}};
    }
    c["designs"] = nlohmann::ordered_json::array();
    for (const DesignResult& design : result.designs)
      c["designs"].push_back(MakeDesignJson(design));
    c["pareto"] = nlohmann::ordered_json::array();
    for (const ParetoPointResult& point : result.pareto) {
      c["pareto"].push_back(
          {{"road_feel_gain", point.road_feel_gain}, {"sum_of_ratios", point.sum_of_ratios}});
    }
    c["warnings"] = result.warnings;
    json["cases"].push_back(std::move(c));
  }
  return json;
}

}  // namespace kingpin::study
