#pragma once

#include "models/planar/planar_forces.h"

/// The force model on plain numbers, for reports, reference integrators and linearisation. With
/// Dual, use CalcDynamics in planar_forces.h directly.
namespace kingpin::planar {

/// Loads and accelerations at (x, F_T). `slip` as for CalcDynamics: the sign of the rack's sliding
/// speed, or 0 while Coulomb friction holds it.
Dynamics<double> CalcForces(const Model<double>& model, const State<double>& x, double road_force,
                            double slip = 0);

/// a = M⁻¹ (forces): writes 5 accelerations.
void CalcAccelerations(const Model<double>& model, const State<double>& x, double road_force,
                       double* a, double slip = 0);

/// The sign that Coulomb friction has in a state: that of the rack's speed; when it rests, 0 if
/// friction holds it, else the direction in which the other forces break it away.
double CalcSlip(const Model<double>& model, const State<double>& x, double road_force);

/// Kinetic and potential energy [J].
double CalcKineticEnergy(const Model<double>& model, const State<double>& x);
double CalcPotentialEnergy(const Model<double>& model, const State<double>& x);

}  // namespace kingpin::planar
