#pragma once

#include <span>
#include <vector>

namespace kingpin::mechanism {

/// Which forces hold what is at rest, and what gives way: friction of several elements at one
/// instant. With the slip accelerations a = A R + b (A symmetric, positive semidefinite), each
/// force is in its box and opposes:
///
///   |R| <= limit;  a > 0 only if R = -limit,  a < 0 only if R = limit.
///
/// The accelerations are unique, the forces are if A is regular. These are the conditions for a
/// minimum of R·A R/2 + b·R in the box; solved by an active set. Nothing is allocated after
/// construction.
class BoxProblem {
 public:
  /// Share of its own A(i, i) that must be left of a force's effect beside those of the others for
  /// it to count as independent of them.
  static constexpr double kIndependent = 1e-4;

  explicit BoxProblem(int capacity);

  /// @param size at most the capacity; A, b, limit and reference are for the caller to set
  void Resize(int size) { size_ = size; }
  int size() const { return size_; }
  double& A(int i, int j) { return A_[i * capacity_ + j]; }
  double A(int i, int j) const { return A_[i * capacity_ + j]; }

  std::vector<double> b;          ///< slip accelerations without these forces
  std::vector<double> limit;      ///< >= 0
  std::vector<double> reference;  ///< A(i, i) as it would be without any constraint: what counts as
                                  ///< zero is measured by it

  void Solve();

  std::vector<double> R;  ///< out
  std::vector<double> a;  ///< out; what is zero but for rounding is 0

  /// Chooses among `candidates` (1 per force) a largest independent set, those with most room to
  /// their limits first, and marks the others 0.
  void KeepIndependent(std::span<char> candidates);

 private:
  enum class State : char { kFree, kUpper, kLower };
  void SolveFree();
  void Eliminate(int pivot);
  void CalcAccelerations();
  int FindWorstBeyondLimit() const;
  int FindWorstHeldBack() const;
  bool CanHold(int i) const;

  int capacity_, size_ = 0;
  std::vector<double> A_, factor_, right_, scale_;
  std::vector<State> state_;
  std::vector<char> used_;
  std::vector<int> pivots_;
};

}  // namespace kingpin::mechanism
