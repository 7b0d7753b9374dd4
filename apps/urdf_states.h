#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "joints/mechanism.h"

namespace kingpin::apps {

/// What `kingpin urdf --evaluate` evaluates, in the coordinates of the mechanism.
struct UrdfStates {
  struct State {
    std::vector<double> q, v, tau, a;
  };
  math::Vector3<double> gravity;
  std::vector<State> states;
};

/// Reads STATES.json (docs/formats.md):
///
///     {"gravity": [x, y, z],
///      "states": [{"base_position": [x, y, z], "base_quaternion_xyzw": [x, y, z, w],
///                  "joint_positions": {"NAME": value, ...}, "v": [...], "tau": [...], "a":
///                  [...]}]}
///
/// The two keys of the base belong to a floating base and to no other. Joints with several
/// coordinates take a list: planar [x, y, angle], floating [x, y, z, qx, qy, qz, qw]. Quaternions
/// may be off unit length by their printed digits.
///
/// @throws io::InputError with file, line of what is not JSON, key of what is wrong: every key and
///     every joint must be there, none besides, all sizes right
UrdfStates ReadUrdfStates(const std::string& file, const joints::Mechanism& mechanism,
                          bool floating_base);

}  // namespace kingpin::apps
