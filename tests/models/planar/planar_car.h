#pragma once

#include "models/planar/parameters.h"
#include "tests/models/planar/paper_sets.h"

namespace kingpin::planar {

/// The planar model of the C-segment car as tabulated in the vehicle data, section 3.4 (c_R =
/// 5e6 N/m effective, c_L = 2.3e6 N/m for which the eigenfrequencies are listed).
inline Parameters<double> PlanarCar() {
  Parameters<double> p;
  p.carrier_mass = 35.0;
  p.carrier_yaw_inertia = 0.62;
  p.force_x = 0.0;
  p.force_y = 0.043;
  p.lateral_share = 0.0;
  p.half_track = 0.707;
  p.rack_half_length = 0.330;
  p.outer_joint_x = -0.128;
  p.outer_joint_y = -0.039;
  // Direction (0.1059, 0.9944), from the rack's end at y = 0.330 m.
  p.rack_position = -0.164;
  p.rod_rigidity = 9.5e7 * 0.34;
  p.rod_compliance = 1.0 / 5e6 - 1.0 / 9.5e7;
  p.lateral_stiffness = 2.3e6;
  p.lateral_x = 0.0;
  p.lateral_y = -0.012;
  p.lateral_angle = 1.5707963267948966;
  p.longitudinal_x = 0.0;
  p.longitudinal_y = -0.012;
  p.longitudinal_angle = 0.0;
  // A straight line: the small-signal stiffness 4.9e5 N/m, for which frequencies are listed.
  p.longitudinal_force = sets::MakeCurve({-0.009, -0.006, -0.003, 0.0, 0.003, 0.006, 0.009},
                                         {-4410.0, -2940.0, -1470.0, 0.0, 1470.0, 2940.0, 4410.0});
  p.longitudinal_damping = 4.9e5 * 1.2e-3;
  p.damping_time = 1.2e-3;
  p.rack_mass = 2.0;
  p.wheel_inertia = 0.04;
  p.column_stiffness = 60.0;
  p.gear_ratio = 125.66;
  p.rim_radius = 0.185;
  // 1.03e-3 m² times the hydraulic pressure.
  p.assist_force = sets::MakeCurve({0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0},
                                   {0.0, 154.5, 463.5, 1236.0, 2884.0, 5665.0, 8755.0});
  return p;
}

}  // namespace kingpin::planar
