#pragma once

#include "models/planar/parameters.h"

/// Quantities of a design that need no simulation and that constraints may name.
namespace kingpin::study {

/// Steering wheel angle per angle of the road wheel, at the design position [rad/rad].
///
/// With rigid supports the carrier can only turn about the point C where the lines of the supports
/// L and N cross (for a car, the kingpin axis at hub height). A rigid tie rod along the unit vector
/// e from the rack to the carrier's joint p then gives, with r = p − C,
///
///     e · (ψ̇ ẑ × r) = e_y ẏ     →     φ̇/ψ̇ = i_U (r_x e_y − r_y e_x) / e_y
///
/// Not defined for parallel supports (infinite or NaN).
template <class S>
S CalcSteeringRatio(const planar::Parameters<S>& p) {
  using math::SinCos;
  S sin_l, cos_l, sin_n, cos_n;
  SinCos(p.lateral_angle, sin_l, cos_l);
  SinCos(p.longitudinal_angle, sin_n, cos_n);
  // Lines x + t (cos, sin) through L and N: cross at C = L + t (cos β, sin β).
  const S dx = p.longitudinal_x - p.lateral_x;
  const S dy = p.longitudinal_y - p.lateral_y;
  const S t = (dx * sin_n - dy * cos_n) / (cos_l * sin_n - sin_l * cos_n);
  const S centre_x = p.lateral_x + t * cos_l;
  const S centre_y = p.lateral_y + t * sin_l;
  const S outer_x = p.design_origin_x + p.outer_joint_x;
  const S outer_y = p.design_origin_y + p.outer_joint_y;
  const S rod_x = outer_x - (p.design_origin_x + p.rack_position);
  const S rod_y = outer_y - (p.rack_half_length - p.half_track);
  return p.gear_ratio * ((outer_x - centre_x) * rod_y - (outer_y - centre_y) * rod_x) / rod_y;
}

}  // namespace kingpin::study
