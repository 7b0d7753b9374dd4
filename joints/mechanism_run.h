#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/io/csv.h"
#include "joints/mechanism_file.h"

namespace kingpin::joints {

/// What simulating a mechanism file gives.
struct MechanismRun {
  io::Signals signals;  ///< per joint coordinate position, rate, acceleration; per row its
                        ///< reaction; energies
  nlohmann::ordered_json
      summary;       ///< degrees of freedom, redundant rows, residuals, energy balance, end state
  std::string text;  ///< for the terminal
  std::vector<std::pair<std::string, double>> statistics;
};

/// @throws io::InputError for a mechanism that cannot be put together, io::RunError when the run
/// fails
MechanismRun RunMechanism(const MechanismFile& file);

/// Equilibrium and modes of a mechanism file.
struct MechanismModes {
  nlohmann::ordered_json json;  ///< A, bases, eigenvalues, frequencies, damping, shapes
  std::string text;
};
MechanismModes CalcMechanismModes(const MechanismFile& file);

}  // namespace kingpin::joints
