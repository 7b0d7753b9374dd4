#pragma once

#include <Eigen/Core>

#include "models/parameters/bushing.h"
#include "models/parameters/table.h"

namespace kingpin::parameters {

struct SteeringWheel {
  double mass = 0.0;                                 ///< [kg]
  double inertia = 0.0;                              ///< about the column [kg m^2]
  double rim_radius = 0.0;                           ///< [m]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< car frame [m]
};

/// Solid round shaft in torsion: stiffness G π d⁴/(32 l).
struct RoundShaft {
  double diameter = 0.0;       ///< d [m]
  double length = 0.0;         ///< l [m]
  double shear_modulus = 0.0;  ///< G [Pa]
};

/// Torsion bar, upper column and intermediate shaft in series.
struct Column {
  double torsion_bar_stiffness = 0.0;  ///< [N m/rad]
  double stop_angle = 0.0;             ///< twist of the torsion bar at its stop, one side [rad]
  double stop_stiffness = 0.0;         ///< of the column beyond the stop [N m/rad]
  RoundShaft upper_shaft;
  RoundShaft intermediate_shaft;
  double total_stiffness = 0.0;  ///< stated for the series of the three [N m/rad]; checked
  double damping = 0.0;          ///< of the bearings [N m s/rad]
  double friction = 0.0;         ///< of the bearings [N m]
};

struct Rack {
  double mass = 0.0;                  ///< [kg]
  double travel = 0.0;                ///< to either side [m]
  double travel_per_turn = 0.0;       ///< of the pinion [m]
  double damping = 0.0;               ///< [N s/m]
  double friction_coefficient = 0.0;  ///< on yoke preload + side force [-]
  double yoke_preload = 0.0;          ///< [N]
  double friction_force = 0.0;        ///< the alternative: a constant limit [N]
  BushingAxis housing_mounts;         ///< sum of the mounts, along y
  double pinion_inertia = 0.0;        ///< [kg m^2]
  double free_play = 0.0;             ///< total clearance at the inner joint [m]
};

/// Driver's hands on the rim, reduced to the column.
struct Hands {
  double inertia = 0.0;    ///< [kg m^2]
  double damping = 0.0;    ///< [N m s/rad]
  double stiffness = 0.0;  ///< [N m/rad]
};

struct HydraulicAssist {
  double piston_bore = 0.0;     ///< [m]
  double rod_diameter = 0.0;    ///< [m]
  Table pressure;               ///< [Pa] over torsion-bar torque [N m], for torque ≥ 0; odd
  double pressure_limit = 0.0;  ///< [Pa]
  double lag = 0.0;             ///< first order [s]
  double pump_flow = 0.0;       ///< [m^3/s]
};

struct ElectricAssist {
  Table force;                         ///< at the rack [N] over torsion-bar torque [N m] ≥ 0; odd
  Table speed_factor;                  ///< [-] over vehicle speed [m/s], linear between
  double motor_inertia = 0.0;          ///< [kg m^2]
  double worm_ratio = 0.0;             ///< motor turns per turn of the pinion [-]
  double motor_friction = 0.0;         ///< at the rack [N]
  double loop_frequency = 0.0;         ///< of the torque loop, second order [Hz]
  double loop_damping = 0.0;           ///< [-]
  double controller_delay = 0.0;       ///< [s]
  double torsion_bar_stiffness = 0.0;  ///< takes the place of the column's [N m/rad]
};

struct Steering {
  SteeringWheel wheel;
  Column column;
  Rack rack;
  Hands light_hands;
  Hands firm_hands;
  HydraulicAssist hydraulic;
  ElectricAssist electric;
};

}  // namespace kingpin::parameters
