#include "models/planar/linear_export.h"

#include <fmt/format.h>
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

void AppendMatrix(std::string& text, const char* name, const Eigen::MatrixXd& matrix) {
  text += fmt::format("# {} ({} x {})\n", name, matrix.rows(), matrix.cols());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      text += fmt::format("{}{:.17g}", j == 0 ? "" : ",", matrix(i, j));
    }
    text += '\n';
  }
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
    for (const auto& value : mode.shape) shape.push_back({value.real(), value.imag()});
    json["shape"] = std::move(shape);
    json["summary"] = mode.summary;
    list.push_back(std::move(json));
  }
  return list;
}

Json MakeJson(const LinearAnalysis& analysis) {
  Json json;
  json["free"]["model"] = MakeJson(analysis.free);
  json["free"]["modes"] = MakeJson(analysis.free_modes, analysis.free);
  json["held"]["model"] = MakeJson(analysis.held);
  json["held"]["modes"] = MakeJson(analysis.held_modes, analysis.held);
  json["road_feel_gain"] = analysis.road_feel_gain;
  json["static_road_feel_gain"] = analysis.static_road_feel_gain;
  return json;
}

std::string FormatMatricesAsCsv(const LinearModel& model) {
  std::string text;
  AppendMatrix(text, "A", model.a);
  AppendMatrix(text, "B", model.b);
  AppendMatrix(text, "C", model.c);
  AppendMatrix(text, "D", model.d);
  return text;
}

std::string FormatResponseAsCsv(const FrequencyResponse& response) {
  std::vector<BodeCurve> curves;
  std::string names = "frequency";
  std::string units = "Hz";
  for (const auto& input : response.inputs) {
    for (const auto& output : response.outputs) {
      curves.push_back(CalcBodeCurve(response, input, output));
      names += fmt::format(",{0}/{1}.magnitude,{0}/{1}.phase", output, input);
      units += fmt::format(",{},deg", curves.back().unit);
    }
  }
  std::string text = names + '\n' + units + '\n';
  for (std::size_t k = 0; k < response.frequency.size(); ++k) {
    text += fmt::format("{:.17g}", response.frequency[k]);
    for (const auto& curve : curves) {
      text += fmt::format(",{:.17g},{:.17g}", curve.magnitude[k], curve.phase[k]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace kingpin::planar
