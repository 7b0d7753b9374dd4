#include "models/planar/linear_export.h"

#include <nlohmann/json.hpp>

#include "models/planar/linear_road_feel.h"
#include "models/planar/validate.h"

namespace kingpin::planar {
namespace {

using Json = nlohmann::ordered_json;

Json MakeNames(const std::vector<std::string>& names, const std::vector<std::string>& units) {
  Json list = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    list.push_back({{"name", names[i]}, {"unit", units[i]}});
  }
  return list;
}

Json MakeRows(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json MakePart(const LinearModel& model, const Modes& modes, const FrequencyResponse& response) {
  Json json;
  json["stable"] = modes.stable;
  json["modes"] = MakeJson(modes, model);
  json["model"] = MakeJson(model);
  json["frequency_response"] = MakeJson(response);
  return json;
}

}  // namespace

LinearAnalysis AnalyseLinearly(const Parameters<double>& parameters,
                               const LinearAnalysisOptions& options) {
  ValidateParameters(parameters);
  LinearAnalysis result;
  result.free = MakeLinearModel(parameters, options.at);
  result.held = HoldSteeringWheel(result.free);
  result.free_modes = CalcModes(result.free);
  result.held_modes = CalcModes(result.held);
  const auto respond = [&](const LinearModel& model, const Modes& modes) {
    return CalcFrequencyResponse(
        model, MakeFrequencyGrid(modes, options.lowest_frequency, options.highest_frequency,
                                 options.points_per_decade));
  };
  result.free_response = respond(result.free, result.free_modes);
  result.held_response = respond(result.held, result.held_modes);
  result.road_feel_gain = CalcRoadFeelGain(parameters);
  result.static_road_feel_gain = CalcStaticRoadFeel(parameters);
  return result;
}

Json MakeJson(const LinearModel& model) {
  Json json;
  json["states"] = MakeNames(model.state_names, model.state_units);
  json["inputs"] = MakeNames(model.input_names, model.input_units);
  json["outputs"] = MakeNames(model.output_names, model.output_units);
  json["A"] = MakeRows(model.a);
  json["B"] = MakeRows(model.b);
  json["C"] = MakeRows(model.c);
  json["D"] = MakeRows(model.d);
  json["notes"] = model.notes;
  return json;
}

Json MakeJson(const Modes& modes, const LinearModel& model) {
  Json list = Json::array();
  for (const Mode& mode : modes.modes) {
    Json json;
    json["kind"] = ToString(mode.kind);
    json["frequency"] = mode.frequency;
    json["damped_frequency"] = mode.damped_frequency;
    json["damping_ratio"] = mode.damping_ratio;
    json["eigenvalue"] = {mode.eigenvalue.real(), mode.eigenvalue.imag()};
    json["time_constant"] = mode.time_constant;
    Json shares = Json::object();
    for (std::size_t i = 0; i < model.coordinate_names.size(); ++i) {
      shares[model.coordinate_names[i]] = mode.shares[i];
    }
    json["shares"] = std::move(shares);
    Json shape = Json::array();
    for (std::size_t i = 0; i < mode.shape.size(); ++i) {
      shape.push_back({{"state", model.state_names[i]},
                       {"unit", model.state_units[i]},
                       {"value", {mode.shape[i].real(), mode.shape[i].imag()}}});
    }
    json["shape"] = std::move(shape);
    json["summary"] = mode.summary;
    list.push_back(std::move(json));
  }
  return list;
}

Json MakeJson(const FrequencyResponse& response) {
  Json json;
  json["frequency"] = {{"unit", "Hz"}, {"values", response.frequency}};
  json["responses"] = Json::array();
  for (const auto& input : response.inputs) {
    for (const auto& output : response.outputs) {
      const BodeCurve curve = CalcBodeCurve(response, input, output);
      json["responses"].push_back({{"input", input},
                                   {"output", output},
                                   {"unit", curve.unit},
                                   {"magnitude", curve.magnitude},
                                   {"phase", curve.phase}});
    }
  }
  return json;
}

Json MakeJson(const LinearAnalysis& analysis) {
  Json json;
  json["free"] = MakePart(analysis.free, analysis.free_modes, analysis.free_response);
  json["held"] = MakePart(analysis.held, analysis.held_modes, analysis.held_response);
  json["road_feel_gain"] = {{"value", analysis.road_feel_gain}, {"unit", "N m/(N m)"}};
  json["static_road_feel_gain"] = {{"value", analysis.static_road_feel_gain},
                                   {"unit", "N m/(N m)"}};
  return json;
}

}  // namespace kingpin::planar
