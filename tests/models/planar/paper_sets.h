#pragma once

#include <algorithm>
#include <array>

#include "models/planar/parameters.h"

/// The three parameter sets identified from the paper's tables (case 2, initial design), and an
/// excitation of three pulses each. Numbers in SI; the same values stand in examples/paper.
namespace kingpin::planar::sets {

struct PaperSet {
  const char* name;
  Parameters<double> parameters;
  std::array<double, 3> pulse_peak;      ///< [N]
  std::array<double, 3> pulse_start;     ///< [s]
  std::array<double, 3> pulse_duration;  ///< [s]
};

inline Curve<double> MakeCurve(std::array<double, 7> x, std::array<double, 7> f) {
  Curve<double> curve;
  curve.count = 7;
  std::copy(x.begin(), x.end(), curve.x.begin());
  std::copy(f.begin(), f.end(), curve.f.begin());
  return curve;
}

inline PaperSet SetA() {
  Parameters<double> p;
  p.carrier_mass = 35.0;
  p.carrier_yaw_inertia = 0.4006;
  p.force_x = -0.0484;
  p.force_y = -0.08141;
  p.lateral_share = 0.5412;
  p.rack_half_length = 0.25;
  p.rack_position = 0.05;
  p.outer_joint_x = -0.1325;
  p.outer_joint_y = -0.025;
  p.half_track = 0.7901;
  p.rod_rigidity = 10180000.0;
  p.lateral_stiffness = 995500.0;
  p.lateral_x = 0.12;
  p.lateral_y = -0.04666;
  p.lateral_angle = 1.687;
  p.longitudinal_force =
      MakeCurve({-0.009, -0.006, -0.003, 0.0, 0.003, 0.006, 0.009},
                {-21601.134, -7703.336, -1842.442, 0.0, 1842.442, 7703.336, 21601.134});
  p.longitudinal_damping = 39.066545999999995;
  p.longitudinal_x = 0.05841;
  p.longitudinal_y = -0.02069;
  p.longitudinal_angle = 0.1635;
  p.damping_time = 0.001822;
  p.rack_mass = 2.0;
  p.friction_speed = 0.001;
  p.wheel_inertia = 0.04;
  p.column_stiffness = 60.0;
  p.gear_ratio = 164.1;
  p.rim_radius = 0.185;
  p.assist_force =
      MakeCurve({0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0},
                {0.0, 873.21128, 1746.49024, 2619.90456, 3493.52192, 4367.41, 5241.63648});
  return {"A",
          p,
          {4668.0, -1188.4728, -1976.898},
          {0.1321, 0.21873, 0.140013},
          {0.04928, 0.0776, 0.08371}};
}

inline PaperSet SetB() {
  Parameters<double> p;
  p.carrier_mass = 35.0;
  p.carrier_yaw_inertia = 0.9293;
  p.force_x = -0.004969;
  p.force_y = -0.07711;
  p.lateral_share = 0.27;
  p.rack_half_length = 0.25;
  p.rack_position = 0.05;
  p.outer_joint_x = -0.1325;
  p.outer_joint_y = -0.025;
  p.half_track = 0.7882;
  p.rod_rigidity = 22530000.0;
  p.lateral_stiffness = 1065000.0;
  p.lateral_x = 0.111;
  p.lateral_y = 0.01455;
  p.lateral_angle = 1.668;
  p.longitudinal_force = MakeCurve(
      {-0.009, -0.006, -0.003, 0.0, 0.003, 0.006, 0.009},
      {-16671.8682, -5911.14613333, -1394.54326667, 0.0, 1394.54326667, 5911.14613333, 16671.8682});
  p.longitudinal_damping = 19.69864;
  p.longitudinal_x = 0.1113;
  p.longitudinal_y = -0.02521;
  p.longitudinal_angle = 0.1648;
  p.damping_time = 0.002082;
  p.rack_mass = 2.0;
  p.friction_speed = 0.001;
  p.wheel_inertia = 0.04;
  p.column_stiffness = 60.0;
  p.gear_ratio = 164.5;
  p.rim_radius = 0.185;
  p.assist_force = MakeCurve({0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0},
                             {0.0, 863.58, 1930.44, 3403.86, 5487.12, 8383.5, 12296.28});
  return {
      "B", p, {5944.0, 158.1104, -1782.6056}, {0.1429, 0.2732, 0.14679}, {0.05136, 0.0682, 0.1068}};
}

inline PaperSet SetC() {
  Parameters<double> p;
  p.carrier_mass = 35.0;
  p.carrier_yaw_inertia = 0.4013;
  p.force_x = -0.02873;
  p.force_y = -0.02395;
  p.lateral_share = 0.2996;
  p.rack_half_length = 0.25;
  p.rack_position = 0.05;
  p.outer_joint_x = -0.1325;
  p.outer_joint_y = -0.025;
  p.half_track = 0.7984;
  p.rod_rigidity = 8111000.0;
  p.lateral_stiffness = 10270000.0;
  p.lateral_x = 0.02186;
  p.lateral_y = -0.003934;
  p.lateral_angle = 1.804;
  p.longitudinal_force = MakeCurve(
      {-0.009, -0.006, -0.003, 0.0, 0.003, 0.006, 0.009},
      {-15402.4182, -5396.34613333, -1236.59326667, 0.0, 1236.59326667, 5396.34613333, 15402.4182});
  p.longitudinal_damping = 249.8;
  p.longitudinal_x = 0.07325;
  p.longitudinal_y = -0.02082;
  p.longitudinal_angle = -0.02595;
  p.damping_time = 0.0003393;
  p.rack_mass = 2.0;
  p.friction_speed = 0.001;
  p.wheel_inertia = 0.04;
  p.column_stiffness = 60.0;
  p.gear_ratio = 181.3;
  p.rim_radius = 0.185;
  p.assist_force =
      MakeCurve({0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0},
                {0.0, 831.302299, 1662.618392, 2493.962073, 3325.347136, 4156.787375, 4988.296584});
  return {"C",
          p,
          {4131.0, 2262.9618, -2792.1429},
          {0.183, 0.3658, 0.21158},
          {0.05214, 0.03087, 0.0638}};
}

inline std::array<PaperSet, 3> AllSets() { return {SetA(), SetB(), SetC()}; }

}  // namespace kingpin::planar::sets
