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
