#pragma once

#include <filesystem>
#include <vector>

#include "core/io/input_kinds.h"
#include "core/solve/simulate.h"
#include "joints/beam.h"
#include "joints/force_description.h"
#include "joints/mechanism.h"

namespace kingpin::joints {

/// A mechanism file: what it is made of, and how it is to be simulated.
struct MechanismFile {
  MechanismDescription description;
  std::vector<ForceDescription> forces;
  bool start_at_rest = false;  ///< find the equilibrium first
  solve::SimulationOptions simulation;
  /// What pictures show, by name of a joint or coordinate, of a closure, coupling, motion or row;
  /// empty: what is not inside a beam.
  struct Report {
    std::vector<std::string> coordinates, reactions;
    Source coordinates_source, reactions_source;
  };
  Report report;
  /// A frequency response from a motor or a force on a body to a channel of signals.csv.
  struct Response {
    std::string name, from, to;
    double low = 0.1, high = 100;  ///< [Hz]
    int points = 200;
    Source source;
  };
  std::vector<Response> responses;
  /// Quantities of springs and motors to be varied until the equilibrium meets targets
  /// (mechanism_trim.h).
  struct Trim {
    enum class Quantity { kFree, kPreload, kForce, kTarget };
    struct Vary {
      std::string of;
      Quantity quantity = Quantity::kPreload;
      Source source;
    };
    struct Target {
      std::string of;  ///< coordinate or ROW.reaction
      double value = 0;
      Source source;
    };
    std::vector<Vary> vary;
    std::vector<Target> targets;
    Source source;
  };
  Trim trim;
  std::vector<std::string> beam_joints;  ///< those inside beams, their roots left out
};

/// Reads a YAML file of kind `mechanism` (docs/formats.md).
/// @throws io::InputError with file, line and key for everything that is wrong in the file itself;
/// what the parts
///     mean together is checked by MakeMechanism and AddForces, whose errors carry the places, too
MechanismFile ReadMechanismFile(const std::filesystem::path& path,
                                const io::ReadOptions& options = {},
                                io::InputRecord* record = nullptr);

/// The same from text, for tests and fuzzing.
MechanismFile ReadMechanismText(std::string_view text, const std::string& name,
                                const io::ReadOptions& options = {},
                                io::InputRecord* record = nullptr);

/// Kind `mechanism`, for `kingpin check` and `kingpin schema`; checking puts the mechanism
/// together.
void AddInputKinds(io::InputKinds* kinds);

/// Puts the mechanism of a file together, forces included, at rest if the file asks for it.
/// @throws io::InputError; std::runtime_error if no equilibrium is found
Mechanism MakeMechanism(const MechanismFile& file);

}  // namespace kingpin::joints
