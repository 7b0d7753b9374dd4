#pragma once

#include "models/parameters/car.h"
#include "models/parameters/derived_quantity.h"
#include "models/planar/car_mode_options.h"
#include "models/planar/parameters.h"

namespace kingpin::planar {

/// Car mode: every parameter of the planar model from the car's hardpoints, masses and bushings.
///
/// In short (docs/theory/car-reduction.md has each formula with its source):
///
/// - carrier: knuckle, hub and wheel of the left front corner, origin at their centre of mass;
/// - design origin o = K, the steering axis at the height of the wheel centre; x_tr, y_tr, r_X are
///   measured from there;
/// - both supports act at K: F_N along x is the quasi-static recession curve of K, the tie rod
/// taken
///   out, from FrontCompliance; c_L and β give the rest of the condensed stiffness;
/// - tie rod: bar, ball joints and the rack's housing mounts in series, projected on the plane;
/// - road force at the wheel centre, or at the scrub lever about K of a locked wheel;
/// - b_N and η from the bushings' loss factors;
/// - rack mass with pinion, electric motor and opposite wheel reflected to it.
///
/// Signs: positive φ drives the rack to +y. With the rack behind the axle that steers to the right.
///
/// Left out, since the planar model has no place for it: dry friction in the column, mass of the
/// tie rods, the limit of the pump's flow (it brakes rack speeds above about 0.13 m/s
/// hydraulically).
///
/// Fills `record`, if given, with every derived quantity, its formula and source.
/// Throws io::InputError for options that contradict the car.
Parameters<double> MakePlanarParameters(const parameters::Car& car, const CarModeOptions& options,
                                        parameters::DerivedQuantities* record = nullptr);

/// Torsional stiffness of a round shaft, G π d⁴/(32 l) [N m/rad].
double CalcShaftStiffness(const parameters::RoundShaft& shaft);

/// Piston area of the hydraulic assistance, π (D² − d²)/4 [m²].
double CalcPistonArea(const parameters::HydraulicAssist& assist);

/// Both wheels' steering inertia hangs on the rack; this is one of them: I_e (dθ/dy)², with I_e
/// about the steering axis and dθ/dy = |n_y|/lever of the tie rod [kg].
double CalcWheelMassAtRack(const parameters::Car& car);

/// Rotor inertia at the rack, J (i_worm i_U)² [kg].
double CalcMotorMassAtRack(const parameters::Steering& steering);

/// Pinion turns per metre of rack, i_U = 2π/(travel per turn) [rad/m].
double CalcGearRatio(const parameters::Rack& rack);

/// Stiffness of the tie rod between carrier and body along itself: chain (bar and ball joints) in
/// series with the housing mounts, which give way along y: 1/c = 1/c_chain + n_y²/c_mount [N/m].
double CalcTieRodStiffness(const parameters::Car& car, bool dynamic_rubber);

}  // namespace kingpin::planar
