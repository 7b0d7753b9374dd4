#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/io/csv.h"
#include "joints/mechanism_file.h"
#include "joints/mechanism_linear.h"

namespace kingpin::joints {

/// Looks up every name by which a file chooses what is shown or analysed.
/// @throws io::InputError with file, line and key for one that names nothing
void CheckNames(const MechanismFile& file, const Mechanism& mechanism);

/// Called with the time reached [s] at t = 0 and at every sample; false ends the run there.
using Proceed = std::function<bool(double time)>;

/// What simulating a mechanism file gives. One that ended early holds what was finished until then.
struct MechanismRun {
  bool finished = true;  ///< false: it failed, or `proceed` ended it
  std::string failure;   ///< why it failed; empty: it did not
  /// Per coordinate position, rate, acceleration; per row its reaction; energies [J]: kinetic,
  /// potential, total, dissipated and supplied so far, balance (total - total at the start -
  /// supplied + dissipated); largest residuals of the constraints.
  io::Signals signals;
  /// How many channels of each come first, in that order.
  int positions = 0, velocities = 0, rows = 0;
  /// Coordinates and rows to be shown (`report:`), by the names of their channels; those chosen by
  /// nobody are the ones that are not inside a beam.
  std::vector<std::string> shown_coordinates, shown_reactions;
  /// Dry friction: when it began to stick (mode 0) or to slide (±1).
  struct FrictionChange {
    double time = 0;
    std::string name;
    int mode = 0;
  };
  std::vector<FrictionChange> friction_changes;
  nlohmann::ordered_json summary;  ///< whether it finished, degrees of freedom, redundant rows,
                                   ///< residuals, energy balance, end state
  std::string text;                ///< for the terminal
  std::vector<std::pair<std::string, double>> statistics;
};

/// @throws io::InputError for a mechanism that cannot be put together, io::RunError when the run
/// fails before its first sample; later, `failure` says why
MechanismRun RunMechanism(const MechanismFile& file, const Proceed& proceed = {});

/// Equilibrium and modes of a mechanism file.
struct MechanismModes {
  nlohmann::ordered_json
      json;  ///< A, B, C, D, bases, eigenvalues, frequencies, damping, shapes, responses
  std::string text;
  std::vector<ResponseCurve> responses;
};
MechanismModes CalcMechanismModes(const MechanismFile& file);

}  // namespace kingpin::joints
