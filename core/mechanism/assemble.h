#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/mechanism/model.h"

namespace kingpin::mechanism {

/// A position, then velocities, that meet the constraints.
struct Assembly {
  bool closed = false;
  double residual = 0;         ///< largest |Φ| that is left
  std::vector<int> open_rows;  ///< rows left open, the worst first
};

/// Moves q until every holonomic row is closed to `tolerance`: damped Gauss-Newton
/// (Levenberg-Marquardt). Coordinates that are `held` move only if the others alone cannot close
/// it.
///
/// @param drive s(t) per row
/// @param held per velocity coordinate
Assembly AssemblePositions(const Model& model, std::span<const double> drive,
                           std::span<const char> held, double tolerance, std::span<double> q);

/// The v nearest to the given one with Dᵀ v = `rate` in all rows that do not switch, moving the
/// `held` ones only if need be; `residual` and `open_rows` are of the rates.
Assembly AssembleVelocities(const Model& model, std::span<const double> rate,
                            std::span<const char> held, double tolerance, std::span<const double> q,
                            std::span<double> v);

}  // namespace kingpin::mechanism
