#pragma once

#include <Eigen/Core>

namespace kingpin::parameters {

/// Solid round half shaft with a joint at each end.
struct HalfShaft {
  double mass = 0.0;      ///< with joints; half of it is unsprung [kg]
  double diameter = 0.0;  ///< [m]
  double length = 0.0;    ///< [m]
  Eigen::Vector3d inner_joint = Eigen::Vector3d::Zero();  ///< car frame [m]
};

/// Front-wheel drive with an open differential.
struct Driveline {
  HalfShaft left;
  HalfShaft right;
  double shear_modulus = 0.0;         ///< of the half shafts [Pa]
  double shaft_damping = 0.0;         ///< each [N m s/rad]
  double differential_inertia = 0.0;  ///< cage and final-drive wheel [kg m^2]
  double final_drive_ratio = 0.0;     ///< [-]
  double gear_ratio = 0.0;            ///< of the gear engaged, the second [-]
  double engine_inertia = 0.0;        ///< with flywheel and clutch [kg m^2]
};

}  // namespace kingpin::parameters
