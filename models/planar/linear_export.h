#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "models/planar/linear_frequency_response.h"
#include "models/planar/linear_model.h"
#include "models/planar/linear_modes.h"

/// Linear models, modes and frequency responses as JSON and CSV, for control design in other tools
/// and for the verb `modes`.
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
/// "time_constant", "shares": {coordinate: share...}, "shape": [[re, im]...], "summary"}...]`
nlohmann::ordered_json MakeJson(const Modes& modes, const LinearModel& model);
/// The whole analysis: `free` and `held`, each with `model` and `modes`, and `road_feel_gain`,
/// `static_road_feel_gain`.
nlohmann::ordered_json MakeJson(const LinearAnalysis& analysis);

/// The four matrices one after another as CSV, each under a comment line `# A (13 x 13)`, 17
/// significant digits.
std::string FormatMatricesAsCsv(const LinearModel& model);

/// A table of all responses: `frequency`, then magnitude and phase of every output per input; the
/// second row holds units.
std::string FormatResponseAsCsv(const FrequencyResponse& response);

}  // namespace kingpin::planar
