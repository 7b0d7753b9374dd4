#pragma once

#include <span>

#include "core/mechanism/system.h"

namespace kingpin::solve {

struct EquilibriumOptions {
  /// Of the accelerations left [m/s^2, rad/s^2] and of the rates of states; in stiff systems,
  /// whose accelerations are rounded by more, see below.
  double tolerance = 1e-9;
  int iterations = 500;
};

struct Equilibrium {
  int iterations = 0;
  double residual = 0;  ///< largest acceleration or rate left
};

/// Moves y to a position in which the system rests: constraints met, v = 0, accelerations and rates
/// of states zero.
///
/// Pseudo-transient continuation (Kelley and Keyes, SIAM J. Numer. Anal. 35, 1998): implicit steps
/// of motion without inertia, ξ' = a(ξ), in the directions that the constraints leave, with exact
/// derivatives,
///
///   (1/δ - ∂a/∂ξ) Δξ = a,
///
/// whose step δ grows as the accelerations fall. Far away it goes downhill, which leads to stable
/// positions; near the end it is Newton's method. Directions in which nothing changes (a car's
/// place on a plane) stay as they are. Where nothing can move, y rests as it is.
///
/// Positions near one (metre, radian) are rounded to ε = 2.2e-16, and accelerations with them to
/// ε Σ_j |∂a_i/∂q_j|: 1e-4 in a steel beam of short elements, whose ω² is 1e12. Within that bound
/// Newton steps go on as long as each at least halves what is left, and the last stands.
///
/// Drives stand still where they are at t = 0 while the position is sought. If they move there, the
/// v returned follows them, with the least kinetic energy.
///
/// Dry friction is left out: a position that friction alone holds is not unique.
///
/// @throws std::runtime_error if nothing comes to rest; the message names the link that accelerates
/// most
Equilibrium FindEquilibrium(const mechanism::System& system, const EquilibriumOptions& options,
                            std::span<double> y);

}  // namespace kingpin::solve
