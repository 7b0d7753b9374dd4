#pragma once

#include "models/planar/parameters.h"

namespace kingpin::planar {

/// Growth of small motions about rest with the assistance curve's slope held at one value.
///
/// The assistance pushes the rack with dF_A/dM times the column's torque c_k (φ − i_U y). It acts
/// like a spring between rack and steering wheel that the wheel does not feel; behind a lag it also
/// pushes in phase with the rack's speed and can drive a growing oscillation. Friction, stops and
/// free play are left out, so an unstable result means: growth until they limit it. The tyre's
/// aligning torque is left out, too: behind its own lag it makes a free, frictionless steering
/// weave slowly, whatever the assistance does.
///
/// Eigenvalues of the linear model at rest (linear_model.h).
struct AssistStability {
  double growth = 0.0;     ///< largest real part of the eigenvalues beyond 0.1/s in magnitude
                           ///< (below lies the free steering's zero) [1/s]
  double frequency = 0.0;  ///< of that eigenvalue [Hz]
};

/// For a slope dF_A/dM of the assistance [N per N m].
AssistStability CalcAssistStability(const Parameters<double>& parameters, double slope);

/// The steepest slope up to which small motions do not grow [N per N m]; infinite if none does up
/// to 1e6 N/(N m). By bisection to a relative 1e-6 above the first crossing on a grid of ratio 1.1.
double CalcLargestStableSlope(const Parameters<double>& parameters);

/// Steepest chord between neighbouring nodes of a curve.
double CalcSteepestChord(const Curve<double>& curve);

}  // namespace kingpin::planar
