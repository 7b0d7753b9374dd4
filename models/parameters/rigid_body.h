#pragma once

#include <Eigen/Core>

namespace kingpin::parameters {

/// A rigid part in the car's design position.
///
/// Car frame: origin midway between the front wheel centres in design position, x forward, y left,
/// z up. A part listed for the left side has a mirror image on the right (y changes sign).
struct RigidBody {
  double mass = 0.0;                                         ///< [kg]
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();  ///< car frame [m]
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();         ///< Ixx, Iyy, Izz about it [kg m^2]
  double inertia_xz = 0.0;  ///< entry xz of the tensor, −∫ x z dm, about it [kg m^2]
};

}  // namespace kingpin::parameters
