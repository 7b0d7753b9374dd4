#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kingpin::joints::internal {

/// A number list of the file, checked, with one blank between the numbers.
using Numbers = std::optional<std::string>;

/// What a URDF file says about the dynamics, with lines. Only text that has been checked.
struct XmlOrigin {
  Numbers xyz, rpy;
};

struct XmlLink {
  std::string name;
  int line = 0;
  int inertial_line = 0;  ///< 0: none
  XmlOrigin origin;
  std::string mass;
  std::array<std::string, 6> inertia;  ///< ixx, ixy, ixz, iyy, iyz, izz
};

struct XmlJoint {
  std::string name, type;
  int line = 0;
  std::string parent, child;  ///< names of links
  int parent_line = 0, child_line = 0;
  XmlOrigin origin;
  Numbers axis;  ///< of unit length up to rounding
  struct Limit {
    Numbers lower, upper;
    std::string effort, velocity;
  };
  std::optional<Limit> limit;
  struct Dynamics {
    Numbers damping, friction;
  };
  std::optional<Dynamics> dynamics;
  struct Mimic {
    std::string joint;
    int line = 0;
    Numbers multiplier, offset;
  };
  std::optional<Mimic> mimic;
};

struct XmlRobot {
  std::string name;
  int line = 0;
  std::vector<XmlLink> links;
  std::vector<XmlJoint> joints;
  int root = 0;  ///< link
};

/// Reads and checks. Whatever passes is a tree with known names and finite numbers.
/// @throws io::InputError with everything that is wrong
XmlRobot ReadUrdfXml(std::string_view text, const std::string& file);

}  // namespace kingpin::joints::internal
