#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/math/scalar.h"

namespace kingpin::math {

/// The elimination of a sparse symmetric matrix K = L D Lᵀ in a fixed order, planned once for many
/// matrices with the same pattern. No pivoting takes place in the factorisation: the order must be
/// one in which pivots stay away from zero, and the caller checks them (PivotsAreSafe in
/// core/mechanism/dynamics.h).
///
/// A right side b is carried along as one more row of the matrix, so that elimination leaves D⁻¹
/// L⁻¹ b beside L.
///
/// Storage of one matrix: `size()` numbers. The diagonal entry of the k-th eliminated unknown at
/// slot k; from `unknowns() + 1` on, the columns of L one after the other, fill included, each
/// ending with the entry of b.
class SparseLdltPattern {
 public:
  SparseLdltPattern() = default;

  /// `order[k]` is the unknown eliminated k-th; `entries` are the (row, column) pairs that may be
  /// non-zero, in any order, either triangle, diagonal not needed.
  SparseLdltPattern(std::span<const int> order, std::span<const std::pair<int, int>> entries);

  /// Storage for the entries alone, in their own order, without the plan of an elimination: to
  /// assemble samples before there is one.
  static SparseLdltPattern MakeStorage(int unknowns, std::span<const std::pair<int, int>> entries);

  int unknowns() const { return unknowns_; }
  int size() const { return size_; }  ///< numbers in the storage of one matrix and right side
  /// Where entry (i, j) is stored; -1 if it is not in the pattern.
  int GetSlot(int i, int j) const;
  /// Where b of unknown i is stored.
  int GetRightSideSlot(int i) const { return begin_[position_[i] + 1] - 1; }
  int position(int unknown) const { return position_[unknown]; }  ///< k of an unknown
  long operations() const {
    return static_cast<long>(targets_.size());
  }  ///< multiply-subtracts of a factorisation

  /// Replaces K and b by L, D⁻¹ and D⁻¹ L⁻¹ b in place.
  template <class S>
  KINGPIN_INLINE void Factorise(S* k) const {
    const std::int32_t* target = targets_.data();
    const std::int32_t* begin = begin_.data();
    for (int j = 0; j < unknowns_; ++j) {
      const S inverse = S(1.0) / k[j];
      k[j] = inverse;
      const int first = begin[j], last = begin[j + 1];
      for (int a = first; a < last - 1; ++a) {
        const S l = k[a] * inverse;
        for (int b = a; b < last; ++b) k[*target++] -= l * k[b];
      }
      for (int a = first; a < last; ++a) k[a] = k[a] * inverse;
    }
  }

  /// x of the right side that was factorised along; x in elimination order (index
  /// position(unknown)).
  template <class S>
  KINGPIN_INLINE void BackSubstitute(const S* k, S* x) const {
    const std::int32_t* row = row_.data() - (unknowns_ + 1);
    for (int j = unknowns_ - 1; j >= 0; --j) {
      const int last = begin_[j + 1] - 1;
      S xj = k[last];
      for (int a = begin_[j]; a < last; ++a) xj -= k[a] * x[row[a]];
      x[j] = xj;
    }
  }

  /// Solves K x = b for another right side in place; x in elimination order.
  template <class S>
  KINGPIN_INLINE void Solve(const S* k, S* x) const {
    const std::int32_t* row = row_.data() - (unknowns_ + 1);
    for (int j = 0; j < unknowns_; ++j) {
      const S xj = x[j];
      for (int a = begin_[j]; a < begin_[j + 1] - 1; ++a) x[row[a]] -= k[a] * xj;
    }
    for (int j = unknowns_ - 1; j >= 0; --j) {
      S xj = x[j] * k[j];
      for (int a = begin_[j]; a < begin_[j + 1] - 1; ++a) xj -= k[a] * x[row[a]];
      x[j] = xj;
    }
  }

 private:
  using Columns = std::vector<std::vector<int>>;
  void SetColumns(std::span<const std::pair<int, int>> entries, bool fill, Columns& columns);

  int unknowns_ = 0;
  int size_ = 0;
  std::vector<int> position_;
  std::vector<std::int32_t> begin_;  ///< per column, slot of its first entry below the diagonal
  std::vector<std::int32_t>
      row_;  ///< position of each entry below the diagonal, ascending within a column
  std::vector<std::int32_t> targets_;  ///< slots that the elimination updates, in its order
};

}  // namespace kingpin::math
