#pragma once

#include <Eigen/Dense>
#include <span>
#include <utility>
#include <vector>

namespace kingpin::mechanism {

/// The order in which the unknowns of [M, D; Dᵀ, 0] are eliminated.
struct EliminationOrder {
  std::vector<int> order;            ///< the k-th unknown to go
  std::vector<char> redundant;       ///< per row: depends on the rows kept
  std::vector<double> pivot_limits;  ///< per step: what the pivot must lie beyond at run time, in
                                     ///< the samples' units
};

/// Chooses the order by least fill on the pattern, among the unknowns whose pivots are safe in
/// every sample.
///
/// Eliminating a coordinate leaves a positive definite block of coordinates and a negative definite
/// block of rows (Vanderbei, Symmetric quasidefinite matrices, SIAM J. Optim. 5, 1995), so that
/// coordinates may always go. A row may go once enough of its coordinates are gone: when its pivot
/// has at least a tenth of the size it would have with all of them gone. A row that is left with no
/// pivot after all its coordinates and the other rows are gone depends on the others.
///
/// @param coordinates number of coordinates; unknowns from there on are rows
/// @param samples the matrix in some admissible states, in units that bring its entries near one
/// @param switching per row: may be out of use at times, so that it goes after all others and is
/// the redundant one of a
///     dependent set
/// @param pattern pairs that may be non-zero
EliminationOrder ChooseEliminationOrder(int coordinates,
                                        const std::vector<Eigen::MatrixXd>& samples,
                                        std::span<const char> switching,
                                        std::span<const std::pair<int, int>> pattern);

}  // namespace kingpin::mechanism
