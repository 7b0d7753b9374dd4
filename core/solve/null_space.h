#pragma once

#include <Eigen/Dense>
#include <span>

#include "core/mechanism/model.h"

namespace kingpin::solve {

/// Which rows count.
enum class Rows { kHolonomic, kAll };

/// Orthonormal basis of the directions of motion that the constraints leave in q, rows that switch
/// left out.
Eigen::MatrixXd CalcNullSpace(const mechanism::Model& model, std::span<const double> q,
                              Rows rows = Rows::kAll);

}  // namespace kingpin::solve
