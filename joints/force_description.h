#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math/spatial_vector.h"
#include "joints/mechanism_description.h"
#include "joints/relative_motion.h"

// Force elements as plain data with their place in the user's input; `AddForces` (add_forces.h)
// turns them into force groups. Units are SI; per metre and newton along displacements and
// distances, per radian and newton metre about angles.

namespace kingpin::joints {

/// How a force depends on a deflection or on a rate: proportional, or a cubic spline through points
/// (continued linearly).
struct LawDescription {
  enum class Interpolation {
    kMonotone,  ///< C1, no overshoot
    kNatural,   ///< C2
  };
  double coefficient = 0;                     ///< force / argument; not together with points
  std::vector<std::array<double, 2>> points;  ///< (argument, force), arguments rising
  Interpolation interpolation = Interpolation::kMonotone;
  bool must_rise = false;  ///< points whose force falls are an error
};

// Where a force with one degree of freedom acts, and the quantity x that it depends on.

/// Along the line between the origins of two frames; x is their distance.
struct BetweenPoints {
  FrameDescription a, b;
};
/// About an axis; x is the angle of b against a about a's z axis. The axes z need not be parallel:
/// x is then the twist left when the shortest rotation between them is taken away. Where the joints
/// between a and b turn about that very axis or slide, x counts full turns by their coordinates;
/// otherwise it is in (-π, π], and TurnWatch ends runs in which it jumps.
struct AboutAxis {
  FrameDescription a, b;
};
/// On a coordinate of a joint; x is the angle or displacement.
struct OnCoordinate {
  std::string joint;
  int coordinate = 0;  ///< of a joint with several
};
using PlaceDescription = std::variant<BetweenPoints, AboutAxis, OnCoordinate>;

/// Spring and damper side by side: the force that pulls x back is
///
///   F = stiffness(x - free) + preload + damping(ẋ)
struct SpringDescription {
  std::string name;
  PlaceDescription place;
  LawDescription stiffness, damping;
  /// x without force (but for preload). Absent: the start value for distances, 0 for angles and
  /// coordinates.
  std::optional<double> free;
  double preload = 0;  ///< pulls; a negative one pushes
  Source source;
};

/// One-sided stop, with δ the penetration: δ = x - limit (upper) or limit - x. For δ > 0
///
///   F = max(0, f(δ) + damping s(δ/depth) δ̇),   f = stiffness(δ) or stiffness.coefficient
///   δ^exponent
///
/// pushes x back. s rises smoothly from 0 to 1 over `depth`, so that the damping does not jump at
/// contact; the stop never pulls.
struct StopDescription {
  std::string name;
  PlaceDescription place;
  bool upper = true;  ///< acts above the limit, else below
  double limit = 0;   ///< x at contact
  LawDescription stiffness;
  double exponent = 1;  ///< at least 1; only with a coefficient
  double damping = 0;   ///< [N s/m], [N m s/rad]
  double depth = 1e-3;  ///< penetration at which damping is in full [m], [rad]
  Source source;
};

/// Drives x with the force F (positive: makes x grow)
///
///   F = force(t) + proportional (s(t) - x) + derivative (ṡ(t) - ẋ), |F| <= limit
///
/// All of its power counts as supplied.
struct MotorDescription {
  std::string name;
  PlaceDescription place;
  std::function<double(double time)> force;
  mechanism::Drive target;  ///< s(t); empty: 0
  double proportional = 0, derivative = 0;
  std::optional<double> limit;
  Source source;
};

/// Any force F(t, x, ẋ) on one degree of freedom (positive: makes x grow). Derivatives come from
/// central differences.
struct CallbackDescription {
  std::string name;
  PlaceDescription place;
  std::function<double(double time, double x, double rate)> force;
  Source source;
};

/// Any wrench between two frames: on b, about its origin, in the axes of frame a; a gets the
/// opposite. Derivatives come from central differences.
struct WrenchCallbackDescription {
  std::string name;
  FrameDescription a, b;
  std::function<math::Wrench<double>(double time, const RelativeMotion<double>& motion)> wrench;
  Source source;
};

/// Bushing: see bushing.h for what its deflections are. Component i = x, y, z, then the rotation
/// vector's x, y, z, in the axes of frame a.
struct BushingDescription {
  using Matrix6 = std::array<std::array<double, 6>, 6>;
  std::string name;
  FrameDescription a, b;
  std::array<LawDescription, 6> stiffness, damping;
  std::optional<Matrix6> coupled_stiffness, coupled_damping;  ///< in addition to the laws
  std::array<double, 6> preload{};  ///< pulls the deflection towards zero from its positive side
  Source source;
};

/// A force at the origin of a frame, and a torque, both times `scale(t)`.
struct BodyForceDescription {
  enum class Axes {
    kWorld,
    kFrame,  ///< turns with the body
  };
  std::string name;
  FrameDescription at;
  Vector3<double> force, torque;
  Axes axes = Axes::kWorld;
  std::function<double(double time)> scale;  ///< empty: 1
  Source source;
};

using ForceDescription =
    std::variant<SpringDescription, StopDescription, MotorDescription, CallbackDescription,
                 WrenchCallbackDescription, BushingDescription, BodyForceDescription>;

}  // namespace kingpin::joints
