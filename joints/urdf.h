#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "joints/mechanism_description.h"

namespace kingpin::joints {

/// How the root link of a URDF tree stands in the world.
enum class UrdfBase {
  kFixed,     ///< welded to the world: no coordinates, and neither mass nor energy
  kFloating,  ///< on a free joint named `floating_base`
};

inline constexpr const char* kFloatingBase = "floating_base";

/// What a URDF file says of a joint beyond its place in the tree. Limits, damping and friction are
/// read and reported; they act in no evaluation of the tree.
struct UrdfJoint {
  struct Limit {
    double lower = 0, upper = 0;  ///< [rad] or [m]; of no meaning for continuous joints
    double effort = 0;            ///< [N m] or [N]
    double velocity = 0;          ///< [rad/s] or [m/s]
  };
  struct Mimic {
    std::string joint;
    double multiplier = 1, offset = 0;
  };
  std::string name, type, parent, child;
  std::optional<Limit> limit;
  double damping = 0;   ///< [N m s/rad] or [N s/m]
  double friction = 0;  ///< [N m] or [N]
  std::optional<Mimic> mimic;
};

/// A URDF file as a mechanism.
struct Urdf {
  /// Gravity is the standard one. A joint that mimics another is a coupling named `NAME mimics
  /// OTHER`.
  MechanismDescription description;
  std::string name;  ///< of the robot
  std::string root;
  std::vector<UrdfJoint> joints;  ///< by name
  /// The body of each link: named like it, apart from a link `world` that is not the world.
  std::map<std::string, std::string> bodies;
};

/// Reads a URDF file: urdfdom says what it means, after a pass over the XML that finds mistakes
/// with their lines.
///
/// - Links are bodies; inertia is rotated from the inertial frame into the link's axes.
/// - revolute, continuous, prismatic, fixed, floating, planar joints. A planar joint has
///   displacements along x and y and an angle about z of a frame whose z is the joint's axis.
/// - An axis may be off unit length by its printed digits (1e-3) and is brought to it; any other
///   length is an error.
/// - What is drawn, collides, drives or belongs to other programs (`visual`, `collision`,
///   `transmission`, `gazebo`, ...) is not read. A misspelt tag or attribute inside `link`, `joint`
///   and `inertial` is an error.
///
/// @throws io::InputError with file, line and key: text that is not XML, missing and unknown names,
///     names given twice, two parents, several roots, cycles, numbers that are none or not finite,
///     negative mass, document type definitions, more than 16 MiB, more than kMostUrdfLinks links
Urdf ReadUrdf(const std::string& file, UrdfBase base);

/// The same from text; `file` stands in messages.
Urdf ReadUrdfText(std::string_view text, const std::string& file, UrdfBase base);

inline constexpr int kMostUrdfLinks = 2000;

}  // namespace kingpin::joints
