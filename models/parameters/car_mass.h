#pragma once

#include <Eigen/Core>

#include "models/parameters/car.h"

namespace kingpin::parameters {

/// Mass, centre of mass and inertia of several parts together.
struct MassProperties {
  double mass = 0.0;                                         ///< [kg]
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();  ///< car frame [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();         ///< tensor about it [kg m^2]
};

/// Properties of one part; the tensor has the entries the part lists and no others.
MassProperties ToMassProperties(const RigidBody& body);

/// Both parts together: masses add, and with r from the common centre to that of a part
/// I = Σ (I_i + m_i (rᵀr 1 − r rᵀ)) (Huygens-Steiner).
MassProperties Combine(const MassProperties& first, const MassProperties& second);

/// The part's image on the other side of the plane y = 0.
MassProperties Mirror(const MassProperties& part);

/// Belt and rim together, the axle along y through `centre`.
MassProperties CalcWheel(const Tyres& tyres, const Eigen::Vector3d& centre);

/// Everything that steers on the left: knuckle, hub and wheel.
MassProperties CalcFrontCarrier(const Car& car);

/// Sum of all parts. The tie rods and half shafts are slender rods, the latter between inner joint
/// and hub; the rear hubs and the steering wheel are points; the rack is a point in its middle.
MassProperties CalcWholeCar(const Car& car);

/// Load of the car standing on a level road, g = 9.80665 m/s², left = right.
struct StaticLoads {
  double wheelbase = 0.0;       ///< [m]
  double centre_behind = 0.0;   ///< centre of mass behind the front axle [m]
  double centre_height = 0.0;   ///< above ground [m]
  double front_wheel = 0.0;     ///< vertical load of one wheel [N]
  double rear_wheel = 0.0;      ///< likewise [N]
  double front_unsprung = 0.0;  ///< of one wheel [kg]
  double rear_unsprung = 0.0;   ///< of one wheel [kg]
};

/// Moments about the axles give the wheel loads. Unsprung are carrier, half the lower control arm,
/// half the tie rod and half the half shaft in front; hub, wheel and the share of the twist beam
/// that its pivots do not carry behind.
StaticLoads CalcStaticLoads(const Car& car);

}  // namespace kingpin::parameters
