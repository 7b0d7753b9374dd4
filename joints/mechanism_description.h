#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/math/vector3.h"
#include "core/mechanism/system.h"

namespace kingpin::joints {

using math::Rotation;
using math::Transform;
using math::Vector3;

/// Where in the user's input something was written; file empty for mechanisms built in code.
struct Source {
  std::string file;
  int line = 0;
};

/// The name of the body that everything hangs on.
inline constexpr const char* kWorld = "world";

/// A rigid body: inertia about its centre of mass, axes of the body frame.
struct BodyDescription {
  std::string name;
  double mass = 0;         ///< [kg]; 0 only for a body without inertia
  Vector3<double> centre;  ///< centre of mass in the body frame [m]
  std::array<double, 6>
      central_inertia{};  ///< Jxx, Jyy, Jzz, Jxy, Jxz, Jyz about it [kg m²], Jxy = -∫xy dm
  Source source;
};

enum class JointType {
  kFixed,
  kRevolute,     ///< angle about the axis
  kPrismatic,    ///< displacement along the axis
  kScrew,        ///< angle about the axis, `pitch` metres along it per radian
  kCylindrical,  ///< displacement along, then angle about the axis
  kUniversal,  ///< angle about the axis (fixed in the parent), then about the second axis (fixed in
               ///< the child)
  /// Displacements along two directions across the axis, then angle about it. The directions are x
  /// and y of MakeRotationWithZ(axis): those of the joint frame if the axis is its z.
  kPlanar,
  kSpherical,  ///< quaternion
  kFree,       ///< position, quaternion
};

/// A frame fixed in a body.
struct FrameDescription {
  std::string body;
  Transform<double> X_BF;
};

/// A joint of the tree. At q = 0 the child's joint frame lies on the parent's.
struct JointDescription {
  std::string name;
  JointType type = JointType::kFixed;
  FrameDescription parent;
  FrameDescription child;
  Vector3<double> axis{0, 0, 1};         ///< in the joint frame, unit
  Vector3<double> second_axis{1, 0, 0};  ///< universal joints, perpendicular to `axis`
  double pitch = 0;                      ///< screws [m/rad]
  std::vector<double> position;  ///< start value of q, empty: zero (identity quaternion w = 1)
  std::vector<double> velocity;  ///< start value of v, empty: zero
  Source source;
};

/// Closures between two bodies of the tree, each a set of rows.
enum class ClosureType {
  kSpherical,      ///< the origins of both frames coincide: 3 rows
  kPointOnLine,    ///< a's origin on b's z axis: 2 rows
  kPointOnPlane,   ///< a's origin in b's xy plane: 1 row
  kDistance,       ///< the origins keep `length`: 1 row
  kParallelAxes,   ///< a's z axis parallel to b's: 2 rows
  kPerpendicular,  ///< a's z axis perpendicular to b's x axis: 1 row
  kRevolute,       ///< spherical and parallel axes: 5 rows
  kPrismatic,      ///< point on line and the same orientation: 5 rows
  kCylindrical,    ///< point on line and parallel axes: 4 rows
  kUniversal,      ///< spherical, and a's z axis perpendicular to b's x axis: 4 rows
  kFixed,          ///< all 6 rows
  kRollingDisc,    ///< a's disc about a's z axis, `radius`, rolls on b's xy plane: 3 rows
};

struct ClosureDescription {
  std::string name;
  ClosureType type = ClosureType::kSpherical;
  FrameDescription a, b;
  double length = 0;  ///< distance [m]; 0: that of the start position
  double radius = 0;  ///< rolling disc [m]
  Source source;
};

/// Σ factor q = offset over one-degree-of-freedom coordinates: gears, rack and pinion,
/// differentials.
struct CouplingDescription {
  struct Term {
    std::string joint;
    int coordinate = 0;  ///< of a joint with several
    double factor = 1;
  };
  std::string name;
  std::vector<Term> terms;
  std::optional<double> offset;  ///< absent: what the start position gives
  bool rate_only = false;  ///< Σ factor v = 0 (differentials of wheels that may have turned apart)
  Source source;
};

/// A coordinate that follows a motion s(t); the force it takes is the row's reaction. Spherical and
/// free joints follow ṡ(t) with a velocity coordinate (axes of the child), their quaternions follow
/// from there.
struct MotionDescription {
  std::string name;
  std::string joint;
  int coordinate = 0;
  mechanism::Drive motion;
  Source source;
};

/// Set-valued dry friction in a coordinate of a joint; limits as in mechanism::Friction.
struct FrictionDescription {
  std::string name;
  std::string joint;
  int coordinate = 0;
  double static_force = 0, kinetic_force = 0;  ///< [N, N m]
  double static_coefficient = 0,
         kinetic_coefficient = 0;          ///< times the normal force [1, or m for a turning joint]
  double preload = 0;                      ///< part of the normal force [N]
  bool from_joint = false;                 ///< the joint's own load is part of the normal force
  std::vector<std::string> from_closures;  ///< so are the reactions of these
  mechanism::Friction::Stribeck stribeck = mechanism::Friction::Stribeck::kNone;
  double stribeck_speed = 0;     ///< [m/s, rad/s]
  mechanism::Drive counterpart;  ///< motion of what it rubs against; empty: still
  Source source;
};

/// What a mechanism is made of, before it is put together. From C++ (mechanism_builder.h), YAML or
/// URDF.
struct MechanismDescription {
  std::string name = "mechanism";
  Vector3<double> gravity{0, 0, -9.80665};
  std::vector<BodyDescription> bodies;
  std::vector<JointDescription> joints;
  std::vector<ClosureDescription> closures;
  std::vector<CouplingDescription> couplings;
  std::vector<MotionDescription> motions;
  std::vector<FrictionDescription> frictions;
};

}  // namespace kingpin::joints
