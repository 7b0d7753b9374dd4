#pragma once

#include <string>
#include <vector>

#include "joints/mechanism.h"

namespace kingpin::joints {

/// A position or velocity coordinate under the name that signals give it: of the joint alone where
/// it has one coordinate, `JOINT.x`, `JOINT.angle`, `JOINT.quaternion_w` and so on where it has
/// several.
struct CoordinateName {
  std::string name;
  bool turns = false;
  bool is_quaternion = false;
};

/// In the order of q, and in that of v.
std::vector<CoordinateName> ListPositionNames(const Mechanism& mechanism);
std::vector<CoordinateName> ListVelocityNames(const Mechanism& mechanism);

/// Unit of a coordinate (derivative 0), its rate (1) or acceleration (2).
std::string GetUnit(const CoordinateName& coordinate, int derivative);

/// Unit of a row's reaction: closures push [N] or turn [N m], coordinates take what they are.
std::string GetReactionUnit(const Mechanism& mechanism, int row);

/// The names of coordinates only.
std::vector<std::string> GetNames(const std::vector<CoordinateName>& coordinates);

/// Indices of the names that `chosen` means: itself, or those below it (`JOINT` means `JOINT.x`).
/// @throws io::InputError if there is none, with `what` (such as "joint or coordinate")
std::vector<int> FindNamed(const std::string& chosen, const std::vector<std::string>& names,
                           const Source& source, const std::string& key, const char* what);

}  // namespace kingpin::joints
