#pragma once

#include <complex>
#include <string>
#include <vector>

#include "models/planar/linear_model.h"
#include "models/planar/linear_modes.h"

/// Frequency responses H(iω) = C (iω I − A)⁻¹ B + D of a linear planar model (the paper's 2.6 and
/// 2.7, with every row of B and the right C), and their Bode data.
namespace kingpin::planar {

struct FrequencyResponse {
  std::vector<double> frequency;  ///< [Hz]
  std::vector<std::string> inputs, outputs;
  std::vector<std::string> input_units, output_units;
  /// value[output][input][k], in output unit per input unit.
  std::vector<std::vector<std::vector<std::complex<double>>>> value;
};

/// One curve of a Bode plot.
struct BodeCurve {
  std::string input, output, unit;
  std::vector<double> frequency;     ///< [Hz]
  std::vector<double> magnitude;     ///< |H| [unit]
  std::vector<double> magnitude_db;  ///< 20 lg |H|, −inf where H = 0
  std::vector<double> phase;         ///< [deg], unwrapped, first value in (−180, 180]
};

/// A logarithmic grid from `lowest` to `highest` [Hz] with `per_decade` points, and around every
/// oscillatory mode of `modes` a cluster that puts at least nine points inside its half-power
/// bandwidth, so that no peak is cut. Ascending, without duplicates.
/// @throws std::invalid_argument unless 0 < lowest < highest and per_decade > 0.
std::vector<double> MakeFrequencyGrid(const Modes& modes, double lowest, double highest,
                                      int per_decade = 100);

/// H at every frequency of `grid` [Hz].
/// @throws io::RunError when iω is an eigenvalue of A (an undamped mode exactly on the grid, or
/// the drift mode at 0 Hz).
FrequencyResponse CalcFrequencyResponse(const LinearModel& model, const std::vector<double>& grid);

/// @throws std::invalid_argument when the response has no such input or output.
BodeCurve CalcBodeCurve(const FrequencyResponse& response, const std::string& input,
                        const std::string& output);

}  // namespace kingpin::planar
