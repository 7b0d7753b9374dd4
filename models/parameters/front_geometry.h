#pragma once

#include <Eigen/Core>

#include "models/parameters/car.h"

namespace kingpin::parameters {

/// Steering axis and levers of the left front corner in design position.
///
/// The steering (kingpin) axis runs from the lower ball joint through the top mount, unit vector e
/// upwards. Moments about it are M = e·((r − r_B) × F) for a force F at r; positive M steers to the
/// left (counter-clockwise from above).
struct FrontGeometry {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< e
  double inclination = 0.0;  ///< kingpin inclination, the top leaning inwards [rad]
  double caster = 0.0;       ///< the top leaning backwards [rad]
  Eigen::Vector3d axis_at_hub = Eigen::Vector3d::Zero();     ///< K: the axis at hub height [m]
  Eigen::Vector3d axis_at_ground = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d contact_patch = Eigen::Vector3d::Zero();   ///< below the wheel centre [m]
  double hub_offset = 0.0;                                   ///< wheel centre outboard of K [m]
  double scrub_radius = 0.0;      ///< contact patch outboard of the axis at ground [m]
  double caster_trail = 0.0;      ///< contact patch behind the axis at ground [m]
  double moment_fx_centre = 0.0;  ///< M per Fx at the wheel centre (free-rolling wheel) [m]
  double moment_fx_patch = 0.0;   ///< M per Fx at the patch (locked wheel) [m]
  double moment_fy_patch = 0.0;   ///< M per Fy at the patch [m]
  double moment_fz_patch = 0.0;   ///< M per Fz at the patch [m]
  Eigen::Vector3d tie_rod = Eigen::Vector3d::Zero();  ///< unit vector from inner to outer joint
  double tie_rod_length = 0.0;                        ///< [m]
  double tie_rod_lever = 0.0;                         ///< |M| per newton of rod force [m]
  double rack_force_per_fx = 0.0;  ///< rack force along y per Fx at the wheel centre, quasi-static
                                   ///< and frictionless, magnitude [-]
  double carrier_axis_inertia = 0.0;  ///< of knuckle, hub and wheel about the axis [kg m^2]
};

FrontGeometry CalcFrontGeometry(const Car& car);

/// Velocities of the left front corner per metre per second of wheel travel (rack held) or of rack
/// travel (wheel held vertically): rigid links, ideal joints.
struct FrontMotion {
  Eigen::Vector3d wheel_centre = Eigen::Vector3d::Zero();    ///< velocity [-]
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();        ///< angular velocity [rad/m]
  double strut = 0.0;                                        ///< compression rate [-]
  Eigen::Vector3d anti_roll_link = Eigen::Vector3d::Zero();  ///< velocity of link_on_strut [-]
  Eigen::Vector3d patch = Eigen::Vector3d::Zero();  ///< velocity of the carrier at the patch [-]
};

/// Upward wheel travel with the rack held.
///
/// Five constraints on the carrier's velocity (v, ω): the lower ball joint circles about the line
/// through the arm's bushings (2), the carrier's point at the top mount moves along the strut (2),
/// the rod keeps its length (1).
FrontMotion CalcBumpMotion(const Car& car);

/// Rack travel to +y with the wheel centre at constant height.
FrontMotion CalcRackMotion(const Car& car);

}  // namespace kingpin::parameters
