#pragma once

#include <string>
#include <vector>

#include "joints/mechanism_file.h"

namespace kingpin::joints {

/// A quantity of a force that was varied, and what it came to.
struct TrimmedQuantity {
  std::string name;  ///< FORCE.quantity
  double value = 0;  ///< [m, rad, N, N m]
};

/// Changes the quantities of `file.forces` that its section `equilibrium` names until the
/// equilibrium meets the targets: as many of one as of the other. Newton's method on equilibria,
/// with derivatives by differences and steps cut until the targets come closer. Nothing to do
/// without that section.
///
/// @throws io::InputError as CheckTrim does; std::runtime_error if an equilibrium or the targets
///     cannot be reached, with the target that is missed most
std::vector<TrimmedQuantity> Trim(MechanismFile& file);

/// Whether everything the section names exists and may be varied.
/// @throws io::InputError with file, line and key
void CheckTrim(const MechanismFile& file, const Mechanism& mechanism);

}  // namespace kingpin::joints
