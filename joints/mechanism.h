#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/mechanism/system.h"
#include "joints/mechanism_description.h"

namespace kingpin::joints {

/// A mechanism put together: the compiled system, and where the user's names are in it. Forces and
/// drives are added to `system` by those who know them.
struct Mechanism {
  /// Coordinates of a joint.
  struct JointPlace {
    std::string name;
    JointType type = JointType::kFixed;
    int link = 0;  ///< the last link of its chain, the one the child belongs to
    int q = 0, positions = 0;
    int v = 0, velocities = 0;
  };
  /// Rows of a closure or coupling.
  struct RowPlace {
    std::string name;
    int first = 0, count = 0;
  };

  mechanism::System system;
  std::vector<double> start;       ///< y = (q, v, states), assembled
  std::vector<JointPlace> joints;  ///< movable ones, in the order of their coordinates
  std::vector<RowPlace> rows;
  std::map<std::string, mechanism::Frame, std::less<>> bodies;  ///< body frames, "world" among them

  const JointPlace& GetJoint(
      std::string_view name) const;  ///< @throws std::out_of_range naming the known ones
  const mechanism::Frame& GetBody(
      std::string_view name) const;  ///< @throws std::out_of_range naming the known ones
  /// A frame of the user's as one fixed in a link.
  mechanism::Frame MakeFrame(const FrameDescription& frame) const;
};

/// Puts a mechanism together. Coordinates go depth first, siblings in the order of their joints'
/// names, so that neither the order of the input nor of its files matters; bodies on fixed joints
/// become part of the link that carries them.
///
/// @throws io::InputError with the source of the culprit: body without joint, with two parents, a
/// cycle of joints,
///     unknown names, names given twice, axes that are not unit vectors, negative mass, inertia no
///     body can have, movable links without inertia, values that are not finite
Mechanism MakeMechanism(const MechanismDescription& description);

}  // namespace kingpin::joints
