#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "core/mechanism/model.h"

namespace kingpin::mechanism {

/// q moved by v for unit time at constant joint velocities: sums, and for spherical and free joints
/// the exponential map, which keeps quaternions on the unit sphere.
void MovePositions(const Model& model, std::span<const double> v, std::span<double> q);

/// Brings the quaternions in q back to unit length.
void NormaliseQuaternions(const Model& model, std::span<double> q);

/// [M, D; Dᵀ, 0] in q as a dense matrix, all rows in.
Eigen::MatrixXd CalcEquationMatrix(const Model& model, std::span<const double> q);

/// Φ in q of the holonomic rows; rows without Φ and rows of coordinates given only by their rate
/// are 0.
/// @param drive s of each row, or empty for zeros
Eigen::VectorXd CalcResidual(const Model& model, std::span<const double> q,
                             std::span<const double> drive = {});

/// Moves q along `direction`, as far as the constraints let it, keeping the residuals that q has.
void MoveOnConstraints(const Model& model, std::span<const double> direction, std::span<double> q);

}  // namespace kingpin::mechanism
