#pragma once

#include <span>

#include "core/mechanism/dynamics.h"

namespace kingpin::mechanism {

/// Constrained accelerations and reactions at (q, v), from the applied wrenches w.f (world axes,
/// about the reference point) and generalised forces w.generalised, which the caller has set after
/// UpdatePositions and UpdateVelocities.
///
/// @param drive_acceleration s̈ per row
/// @param acceleration out: q̈ per velocity coordinate
/// @param reaction out: R per row; 0 for rows that are redundant or not active. A position where
/// rows become
///     dependent (a singular position) is solved with the least reactions that meet the equations.
/// @throws std::runtime_error if the rows contradict each other there: no accelerations meet all of
/// them; or if a position is not finite
void SolveAccelerations(const Model& model, std::span<const double> drive_acceleration,
                        Workspace<double>& w, std::span<double> acceleration,
                        std::span<double> reaction);

/// Factorises the assembled equations in w.k and solves them, in the dense way if pivots turn out
/// unsafe.
void FactoriseAndSolve(const Model& model, Workspace<double>& w, std::span<double> acceleration,
                       std::span<double> reaction);

}  // namespace kingpin::mechanism
