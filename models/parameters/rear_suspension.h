#pragma once

#include <Eigen/Core>

#include "models/parameters/bushing.h"
#include "models/parameters/rigid_body.h"
#include "models/parameters/strut.h"

namespace kingpin::parameters {

/// Twist-beam rear axle: two rigid arms coupled by a torsion spring about a lateral axis through
/// the shear centre of the cross beam. Points of the left side, car frame [m].
struct RearSuspension {
  Eigen::Vector3d wheel_centre = Eigen::Vector3d::Zero();
  Bushing pivot;
  Eigen::Vector3d shear_centre = Eigen::Vector3d::Zero();  ///< of the cross beam, y = 0
  Eigen::Vector3d spring_lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d spring_upper = Eigen::Vector3d::Zero();
  Eigen::Vector3d damper_lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d damper_upper = Eigen::Vector3d::Zero();
  RigidBody beam;                  ///< the whole beam with both arms
  double hub_mass = 0.0;           ///< hub and brake of one side, at the wheel centre [kg]
  double torsion_stiffness = 0.0;  ///< of the cross beam [N m/rad]
  SpringDamper spring_damper;
};

}  // namespace kingpin::parameters
