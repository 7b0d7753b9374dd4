#pragma once

#include <Eigen/Core>

#include "models/parameters/bushing.h"
#include "models/parameters/rigid_body.h"
#include "models/parameters/strut.h"

namespace kingpin::parameters {

/// Hardpoints of the left front McPherson corner in design position, car frame [m].
struct FrontHardpoints {
  Eigen::Vector3d lower_ball_joint = Eigen::Vector3d::Zero();
  Eigen::Vector3d strut_top = Eigen::Vector3d::Zero();    ///< centre of the top mount
  Eigen::Vector3d strut_lower = Eigen::Vector3d::Zero();  ///< on the knuckle; with strut_top the
                                                          ///< axis of the strut
  Eigen::Vector3d tie_rod_outer = Eigen::Vector3d::Zero();
  Eigen::Vector3d tie_rod_inner = Eigen::Vector3d::Zero();  ///< at the rack's end
  Eigen::Vector3d wheel_centre = Eigen::Vector3d::Zero();
  double spring_seat_lower = 0.0;  ///< above strut_lower, along the strut's axis [m]
  double spring_seat_upper = 0.0;  ///< likewise [m]
};

/// Rubber mount between the strut's upper end and the body, round about the strut's axis.
struct StrutMount {
  BushingAxis radial;
  BushingAxis axial;
  double bearing_friction = 0.0;  ///< about the strut's axis [N m]
};

/// Bar with an arm at each end, linked to the struts.
struct AntiRollBar {
  double torsion_stiffness = 0.0;                           ///< of the whole bar [N m/rad]
  double arm_length = 0.0;                                  ///< [m]
  Eigen::Vector3d link_on_strut = Eigen::Vector3d::Zero();  ///< left [m]
  Eigen::Vector3d link_on_bar = Eigen::Vector3d::Zero();    ///< left [m]
  Eigen::Vector3d bar_bushing = Eigen::Vector3d::Zero();    ///< left [m]
};

/// Solid round tie rod with a ball joint at each end.
struct TieRod {
  double mass = 0.0;             ///< [kg]
  double diameter = 0.0;         ///< [m]
  double elastic_modulus = 0.0;  ///< [Pa]
  double chain_stiffness = 0.0;  ///< bar and both ball joints in series [N/m]
};

/// Left half of the front axle.
struct FrontSuspension {
  FrontHardpoints hardpoints;
  RigidBody knuckle;  ///< with strut tube and brake caliper
  RigidBody hub;      ///< with brake disc and outer joint; spins with the wheel
  RigidBody lower_control_arm;
  TieRod tie_rod;
  SpringDamper strut;
  AntiRollBar anti_roll_bar;
  Bushing arm_front;  ///< front bushing of the lower control arm
  Bushing arm_rear;   ///< rear (hydraulic) bushing
  StrutMount top_mount;
  double ball_joint_stiffness = 0.0;   ///< all directions; infinite: rigid [N/m]
  double ball_joint_friction = 0.0;    ///< each [N m]
  double rubber_dynamic_factor = 1.0;  ///< k between 10 and 100 Hz over static k [-]
};

}  // namespace kingpin::parameters
