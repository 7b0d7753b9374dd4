#pragma once

#include <optional>

namespace kingpin::planar {

/// What of the car goes into the planar model beyond the paper's five coordinates. The defaults are
/// what a real car has; PaperLike() turns everything off.
struct CarModeOptions {
  enum class Assistance { kNone, kHydraulic, kElectric };
  enum class HandsOnRim { kFree, kLight, kFirm };
  enum class Aligning {
    kNone,      ///< the front end steers freely: a zero-frequency mode, the wheel drifts off
    kConstant,  ///< a stiffness: what the lagged torque amounts to at `aligning_frequency`
    kLagged,    ///< cornering stiffness times trail behind the tyre's relaxation
  };
  enum class Friction {
    kNone,
    kCoefficient,  ///< coefficient times (yoke preload + side force of the tie rod)
    kConstant,     ///< a force limit
  };
  enum class RoadForceAt {
    kWheelCentre,   ///< a free-rolling wheel cannot pass a moment about its axle
    kContactPatch,  ///< a wheel locked by an outboard brake
  };
  enum class SupportAxes {
    kCondensed,   ///< L leans so that the condensed 2x2 stiffness at K is met exactly
    kOrthogonal,  ///< L along y (β = 90°): the coupling of x and y is dropped
  };
  enum class YawInertia {
    kSteeringAxis,  ///< gives the carrier's inertia about the inclined steering axis
    kVertical,      ///< about a vertical axis through the centre of mass
  };

  double speed = 35.0 / 3.6;  ///< of the car: electric assistance, tyre relaxation [m/s]
  Assistance assistance = Assistance::kHydraulic;
  /// Let the assistance follow torque with its lag. Off by default: a plain lag without the phase
  /// compensation that real controllers and valves have makes the loop unstable with the shipped
  /// car's gains (assist_stability.h; docs/theory/car-reduction.md).
  bool assist_lag = false;
  HandsOnRim hands = HandsOnRim::kFree;
  Aligning aligning = Aligning::kLagged;
  double aligning_frequency = 15.0;  ///< [Hz]
  Friction friction = Friction::kCoefficient;
  bool opposite_wheel = true;  ///< the other wheel's inertia, geared to the rack
  bool torsion_bar_stops = true;
  bool column_damping = true;
  bool rack_damping = true;         ///< of the rack's seals and guides, beside the friction
  std::optional<double> free_play;  ///< in place of the car's [m]
  RoadForceAt road_force_at = RoadForceAt::kWheelCentre;
  double lateral_share = 0.0;   ///< ρ: lateral over longitudinal road force [-]
  bool dynamic_rubber = false;  ///< rubber at its stiffness between 10 and 100 Hz
  SupportAxes support_axes = SupportAxes::kCondensed;
  YawInertia yaw_inertia = YawInertia::kSteeringAxis;
  int longitudinal_nodes = 7;          ///< of F_N's spline, odd
  double longitudinal_range = 8000.0;  ///< F_N's spline ends at this force [N]

  /// The paper's model on this car: no option on, supports orthogonal, no damping but P = η K and
  /// that of the longitudinal support.
  static CarModeOptions PaperLike();
};

}  // namespace kingpin::planar
