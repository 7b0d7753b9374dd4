#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/math/pack.h"
#include "core/math/scalar.h"

namespace kingpin::math {

namespace internal {

/// to[i] -= Σ_w l[w] from[w][i], i < count.
template <int W, class S>
KINGPIN_INLINE void SubtractProducts(S* to, const S* l, const S* const* from, int count) {
  for (int i = 0; i < count; ++i) {
    S sum = to[i];
    for (int w = 0; w < W; ++w) sum -= l[w] * from[w][i];
    to[i] = sum;
  }
}

template <int N, int W, class T, class Isa>
KINGPIN_INLINE void SubtractRegister(Pack<T, 1, Isa>* to, const Pack<T, 1, Isa>* l,
                                     const Pack<T, 1, Isa>* const* from, int i) {
  using R = Pack<T, N, Isa>;
  R sum = R::Load(&to[i].r);
  for (int w = 0; w < W; ++w) sum -= R(l[w].r) * R::Load(&from[w][i].r);
  sum.Store(&to[i].r);
}

/// The same for single numbers, in registers of four. Whole registers lie at the end, where columns
/// agree: what one update stores the next one loads in the same pieces.
template <int W, class T, class Isa>
KINGPIN_INLINE void SubtractProducts(Pack<T, 1, Isa>* to, const Pack<T, 1, Isa>* l,
                                     const Pack<T, 1, Isa>* const* from, int count) {
  int i = 0;
  if (count & 1) SubtractRegister<1, W>(to, l, from, i), i += 1;
  if (count & 2) SubtractRegister<2, W>(to, l, from, i), i += 2;
  for (; i < count; i += 4) SubtractRegister<4, W>(to, l, from, i);
}

}  // namespace internal

/// The elimination of a sparse symmetric matrix K = L D Lᵀ in a fixed order, planned once for many
/// matrices with the same pattern. No pivoting takes place in the factorisation: the order must be
/// one in which pivots stay away from zero, and the caller checks them (PivotsAreSafe in
/// core/mechanism/dynamics.h).
///
/// A right side b is carried along as one more row of the matrix, so that elimination leaves L⁻¹ b
/// beside L D.
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
  long operations() const { return operations_; }  ///< multiply-subtracts of a factorisation

  /// Replaces K and b by L D, D⁻¹ (on the diagonal) and L⁻¹ b in place.
  template <class S>
  KINGPIN_INLINE void Factorise(S* k) const {
    const std::int32_t* plan = plan_.data();
    for (const Node& node : nodes_) {
      switch (node.width) {
        case 1:
          EliminateNode<1>(node.first, plan, k);
          break;
        case 2:
          EliminateNode<2>(node.first, plan, k);
          break;
        case 3:
          EliminateNode<3>(node.first, plan, k);
          break;
        case 4:
          EliminateNode<4>(node.first, plan, k);
          break;
        case 5:
          EliminateNode<5>(node.first, plan, k);
          break;
        default:
          EliminateNode<6>(node.first, plan, k);
      }
    }
  }

  /// x of the right side that was factorised along; x in elimination order (index
  /// position(unknown)).
  template <class S>
  KINGPIN_INLINE void BackSubstitute(const S* k, S* x) const {
    if (unknowns_ == 0) return;
    const std::int32_t* row = row_.data() - (unknowns_ + 1);
    for (int j = unknowns_ - 1; j >= 0; --j) {
      const int first = begin_[j], last = begin_[j + 1] - 1;
      // What was found long ago comes first, in two sums: no product waits for the one before it.
      S even = k[last], odd(0.0);
      int a = last - 1;
      for (; a > first; a -= 2) {
        even -= k[a] * x[row[a]];
        odd += k[a - 1] * x[row[a - 1]];
      }
      if (a == first) even -= k[a] * x[row[a]];
      x[j] = (even - odd) * k[j];
    }
  }

  /// Solves K x = b for another right side in place; x in elimination order.
  template <class S>
  KINGPIN_INLINE void Solve(const S* k, S* x) const {
    if (unknowns_ == 0) return;
    const std::int32_t* row = row_.data() - (unknowns_ + 1);
    for (int j = 0; j < unknowns_; ++j) {
      x[j] *= k[j];
      for (int a = begin_[j]; a < begin_[j + 1] - 1; ++a) x[row[a]] -= k[a] * x[j];
    }
    for (int j = unknowns_ - 1; j >= 0; --j) {
      S sum(0.0);
      for (int a = begin_[j]; a < begin_[j + 1] - 1; ++a) sum += k[a] * x[row[a]];
      x[j] -= k[j] * sum;
    }
  }

 private:
  using Columns = std::vector<std::vector<int>>;

  /// Columns that are eliminated together: each is the first row of the one before, and their
  /// further rows are the same.
  struct Node {
    std::int32_t first = 0, width = 1;
  };
  static constexpr int kWidest = 6;

  void SetColumns(std::span<const std::pair<int, int>> entries, bool fill, Columns& columns);
  void SetNodes(const Columns& columns);

  /// Columns j to j + W - 1, first among themselves, then their products off the rest:
  ///
  ///   K_ba -= Σ_w (K_aw / d_w) K_bw   for all rows a <= b below the node, and for b the right side
  template <int W, class S>
  KINGPIN_INLINE void EliminateNode(int j, const std::int32_t*& plan, S* k) const {
    S inverse[W];
    S* column[W];  // entries below the node
    const int rows = begin_[j + W] - begin_[j + W - 1] - 1;
    for (int w = 0; w < W; ++w) column[w] = k + begin_[j + w] + (W - 1 - w);
    for (int w = 0; w < W; ++w) {
      inverse[w] = S(1.0) / k[j + w];
      k[j + w] = inverse[w];
      for (int v = w + 1; v < W; ++v) {
        const S* entry = column[w] - (W - v);  // of row j + v
        const S l = *entry * inverse[w];
        k[j + v] -= l * *entry;
        const S* from[1] = {entry + 1};
        internal::SubtractProducts<1>(column[v] - (W - 1 - v), &l, from, W - 1 - v + rows + 1);
      }
    }
    const std::int32_t* row = &row_[begin_[j + W - 1] - (unknowns_ + 1)];
    for (int a = 0; a < rows; ++a) {
      S l[W];
      const S* from[W];
      S diagonal = k[row[a]];
      for (int w = 0; w < W; ++w) {
        l[w] = column[w][a] * inverse[w];
        diagonal -= l[w] * column[w][a];
      }
      k[row[a]] = diagonal;
      const int scattered = *plan++;
      int b = a + 1;
      for (const int end = b + scattered; b < end; ++b) {
        S* to = k + *plan++;
        S sum = *to;
        for (int w = 0; w < W; ++w) sum -= l[w] * column[w][b];
        *to = sum;
      }
      for (int w = 0; w < W; ++w) from[w] = column[w] + b;
      internal::SubtractProducts<W>(k + *plan++, l, from, rows + 1 - b);
    }
  }

  int unknowns_ = 0;
  int size_ = 0;
  long operations_ = 0;
  std::vector<int> position_;
  std::vector<std::int32_t> begin_;  ///< per column, slot of its first entry below the diagonal
  std::vector<std::int32_t>
      row_;  ///< position of each entry below the diagonal, ascending within a column
  std::vector<Node> nodes_;
  /// For each node and each row a below it: how many of the slots (b, a), b > a, come one by one;
  /// these slots; and where the rest of them begins, which lies together up to the right side.
  std::vector<std::int32_t> plan_;
};

}  // namespace kingpin::math
