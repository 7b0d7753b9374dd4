#pragma once

namespace kingpin::parameters {

/// Mass and inertia of a body of revolution about its own centre, axis y.
struct RevolvedBody {
  double mass = 0.0;              ///< [kg]
  double spin_inertia = 0.0;      ///< Iyy [kg m^2]
  double diameter_inertia = 0.0;  ///< Ixx = Izz [kg m^2]
};

/// Wheel and tyre; the same on all four corners.
struct Tyres {
  RevolvedBody belt;
  RevolvedBody rim;                       ///< with the lower sidewall
  double free_radius = 0.0;               ///< [m]
  double effective_rolling_radius = 0.0;  ///< [m]
  double vertical_stiffness = 0.0;        ///< [N/m]
  double vertical_damping = 0.0;          ///< [N s/m]
  double ring_torsion_stiffness = 0.0;    ///< belt against rim about the axle [N m/rad]
  double ring_torsion_damping = 0.0;      ///< [N m s/rad]
  double ring_radial_stiffness = 0.0;     ///< belt against rim, in the plane of the wheel [N/m]
  double cornering_stiffness = 0.0;       ///< [N/rad]
  double pneumatic_trail = 0.0;           ///< [m]
  double relaxation_length = 0.0;         ///< [m]
};

}  // namespace kingpin::parameters
