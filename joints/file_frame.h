#pragma once

#include <array>

#include "core/math/quaternion.h"
#include "joints/mechanism_description.h"

namespace kingpin::joints {

/// Three numbers of a mechanism file.
using FilePoint = std::array<double, 3>;

inline Vector3<double> MakeVector(const FilePoint& p) { return {p[0], p[1], p[2]}; }

/// The pose of a frame from its origin and its rotation vector [rad].
inline Transform<double> MakePose(const FilePoint& at, const FilePoint& turned) {
  return {math::MakeRotation(math::MakeQuaternion(MakeVector(turned))), MakeVector(at)};
}

}  // namespace kingpin::joints
