#pragma once

#include <array>

#include "models/planar/parameters.h"

/// The scalars of the planar model that may be design variables, by name.
namespace kingpin::study {

inline constexpr int kScalarFieldCount = 17;

template <class S>
struct ScalarField {
  const char* name;         ///< in study files
  const char* description;  ///< in reports
  const char* unit;
  S planar::Parameters<S>::*member;
};

/// r_L, r_X, x_tr, y_tr are the paper's (3.15); the others carry the names of their fields.
template <class S>
constexpr std::array<ScalarField<S>, kScalarFieldCount> ScalarFields() {
  using P = planar::Parameters<S>;
  return {{
      {"r_L", "Half length of the rack", "m", &P::rack_half_length},
      {"r_X", "Longitudinal position of the rack", "m", &P::rack_position},
      {"x_tr", "Outer tie-rod joint, longitudinal", "m", &P::outer_joint_x},
      {"y_tr", "Outer tie-rod joint, lateral", "m", &P::outer_joint_y},
      {"lateral_stiffness", "Lateral support stiffness", "N/m", &P::lateral_stiffness},
      {"lateral_x", "Lateral support, longitudinal position", "m", &P::lateral_x},
      {"lateral_y", "Lateral support, lateral position", "m", &P::lateral_y},
      {"longitudinal_x", "Longitudinal support, longitudinal position", "m", &P::longitudinal_x},
      {"longitudinal_y", "Longitudinal support, lateral position", "m", &P::longitudinal_y},
      {"longitudinal_damping", "Longitudinal support damping", "N*s/m", &P::longitudinal_damping},
      {"carrier_mass", "Mass of the wheel carrier", "kg", &P::carrier_mass},
      {"carrier_yaw_inertia", "Yaw inertia of the wheel carrier", "kg*m^2",
       &P::carrier_yaw_inertia},
      {"rack_mass", "Mass of the rack and what is geared to it", "kg", &P::rack_mass},
      {"rack_damping", "Rack damping", "N*s/m", &P::rack_damping},
      {"column_stiffness", "Torsional stiffness of the column", "N*m/rad", &P::column_stiffness},
      {"gear_ratio", "Steering gear ratio", "rad/m", &P::gear_ratio},
      {"wheel_inertia", "Inertia of the steering wheel", "kg*m^2", &P::wheel_inertia},
  }};
}

}  // namespace kingpin::study
