#pragma once

#include <array>
#include <vector>

namespace kingpin::mechanism {

constexpr int kSamples = 6;
using SampleValues = std::array<double, kSamples>;

/// [M, D; Dᵀ, 0] in some admissible states, in units that bring its entries near one.
struct SampledMatrix {
  struct Entry {
    int i = 0, j = 0;
    SampleValues value{};
  };
  int coordinates = 0;  ///< unknowns from there on are rows
  std::vector<SampleValues> diagonal;
  std::vector<Entry> entries;  ///< off the diagonal, one of each pair that may be non-zero
  std::vector<SampleValues> largest_pivot;  ///< per unknown; of rows: the diagonal of Dᵀ M⁻¹ D
  /// Per unknown: 1 for rows that may be out of use at times, so that they go after all others;
  /// kOut for rows that depend on others and take no part.
  static constexpr char kOut = 2;
  std::vector<char> last;
};

/// The order in which the unknowns of [M, D; Dᵀ, 0] are eliminated.
struct EliminationOrder {
  std::vector<int> order;            ///< the k-th unknown to go
  std::vector<double> pivot_limits;  ///< per step: what the pivot must lie beyond at run time, in
                                     ///< the samples' units
};

/// Chooses the order by least fill, among the unknowns whose pivots are safe in every sample.
///
/// Eliminating a coordinate leaves a positive definite block of coordinates and a negative definite
/// block of rows (Vanderbei, Symmetric quasidefinite matrices, SIAM J. Optim. 5, 1995), so that
/// coordinates may always go. A row may go once enough of its coordinates are gone: when its pivot
/// has at least a hundredth of the size it would have with all of them gone, or when all are.
///
/// Works on sparse rows: the time is about that of a sparse factorisation, times the square of the
/// number of neighbours an unknown has.
EliminationOrder ChooseEliminationOrder(const SampledMatrix& samples);

}  // namespace kingpin::mechanism
