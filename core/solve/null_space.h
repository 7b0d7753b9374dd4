#pragma once

#include <Eigen/Dense>
#include <span>

#include "core/mechanism/model.h"

namespace kingpin::solve {

/// Which rows count.
enum class Rows { kHolonomic, kAll };

/// The directions of motion that the constraints leave, δq = T ξ with Dᵀ T = 0 and Tᵀ M T = 1: in
/// them the kinetic energy is ½|ξ̇|², and forces that have a potential have symmetric derivatives.
struct NullSpace {
  Eigen::MatrixXd basis;    ///< T: velocities x freedoms
  Eigen::MatrixXd inverse;  ///< Tᵀ M: the ξ of a δq that the constraints allow
  int freedoms() const { return static_cast<int>(basis.cols()); }
};

/// The null space in q of the rows that hold the mechanism for good: those that are redundant or
/// switch are left out. In a singular position, where rows come to depend on each other, it is
/// larger than elsewhere.
NullSpace CalcNullSpace(const mechanism::Model& model, std::span<const double> q,
                        Rows rows = Rows::kAll);

/// The δv of least kinetic energy whose rates Dᵀ δv of the same rows (all of them) are those of
/// `rates`, one column each.
Eigen::MatrixXd CalcLeastMotion(const mechanism::Model& model, std::span<const double> q,
                                const Eigen::MatrixXd& rates);

}  // namespace kingpin::solve
