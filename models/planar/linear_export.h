#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "models/planar/linear_frequency_response.h"
#include "models/planar/linear_model.h"
#include "models/planar/linear_modes.h"

/// Linear models, modes and frequency responses as JSON, for control design in other tools: what
/// the verb `modes` writes.
namespace kingpin::planar {

/// Everything that is known about the small motions of one planar model, as plain data.
struct LinearAnalysis {
  LinearModel free, held;  ///< steering wheel free, and held by the driver
  Modes free_modes, held_modes;
  FrequencyResponse free_response, held_response;
  double road_feel_gain = 0.0;         ///< mean over 0 to 10 Hz [N m/N m]
  double static_road_feel_gain = 0.0;  ///< at 0 Hz [N m/N m]
};

struct LinearAnalysisOptions {
  OperatingPoint at;
  double lowest_frequency = 0.5;     ///< [Hz]
  double highest_frequency = 500.0;  ///< [Hz]
  int points_per_decade = 100;
};

/// Validates the parameters, linearises, finds modes and responses.
/// @throws io::InputError for parameters that make no model; else as the functions it calls.
LinearAnalysis AnalyseLinearly(const Parameters<double>& parameters,
                               const LinearAnalysisOptions& options = {});

/// `{"states": [{"name", "unit"}...], "inputs", "outputs", "A": [[...]...], "B", "C", "D",
/// "notes"}`, matrices by rows.
nlohmann::ordered_json MakeJson(const LinearModel& model);
/// `[{"kind", "frequency", "damped_frequency", "damping_ratio", "eigenvalue": [re, im],
/// "time_constant", "shares": {coordinate: share...}, "shape": [{"state", "unit", "value": [re,
/// im]}...], "summary"}...]`; frequencies in Hz, eigenvalues in 1/s, time constants in s. A shape
/// is relative: only ratios of its values mean something, in the ratio of their units.
nlohmann::ordered_json MakeJson(const Modes& modes, const LinearModel& model);
/// `{"frequency": {"unit": "Hz", "values": [...]}, "responses": [{"input", "output", "unit",
/// "magnitude": [...], "phase": [...]}...]}`, phases in degrees, unwrapped.
nlohmann::ordered_json MakeJson(const FrequencyResponse& response);
/// The whole analysis: `free` and `held`, each with `stable`, `modes`, `model` and
/// `frequency_response`, and `road_feel_gain`, `static_road_feel_gain`.
nlohmann::ordered_json MakeJson(const LinearAnalysis& analysis);

}  // namespace kingpin::planar
