#include "core/mechanism/box_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kingpin::mechanism {

namespace {

constexpr double kNoEffect = 1e-8;    // of the reference: the force moves nothing there
constexpr double kDependent = 1e-10;  // of A(i, i): what is left is rounding
constexpr double kRounding = 1e-10;   // of the terms that an acceleration is the sum of

}  // namespace

BoxProblem::BoxProblem(int capacity)
    : b(capacity),
      limit(capacity),
      reference(capacity),
      R(capacity),
      a(capacity),
      capacity_(capacity),
      A_(static_cast<size_t>(capacity) * capacity),
      factor_(A_.size()),
      right_(capacity),
      scale_(capacity),
      state_(capacity),
      used_(capacity) {
  pivots_.reserve(capacity);
}

bool BoxProblem::CanHold(int i) const { return A(i, i) > kNoEffect * reference[i]; }

void BoxProblem::Solve() {
  std::fill_n(state_.begin(), size_, State::kFree);
  // Each exchange brings one force to its limit or back; a handful per force is the rule.
  for (int exchange = 0; exchange < 20 * (size_ + 1); ++exchange) {
    SolveFree();
    if (const int i = FindWorstBeyondLimit(); i >= 0) {
      state_[i] = R[i] > 0 ? State::kUpper : State::kLower;
      continue;
    }
    CalcAccelerations();
    const int i = FindWorstHeldBack();
    if (i < 0) return;
    state_[i] = State::kFree;
  }
  CalcAccelerations();
}

// Takes a pivot out of the rows still to be used, and of their right sides.
void BoxProblem::Eliminate(int pivot) {
  const double* pivot_row = &factor_[static_cast<size_t>(pivot) * capacity_];
  for (int i = 0; i < size_; ++i) {
    if (used_[i]) continue;
    double* row = &factor_[static_cast<size_t>(i) * capacity_];
    const double l = row[pivot] / pivot_row[pivot];
    for (int j = 0; j < size_; ++j) {
      if (!used_[j]) row[j] -= l * pivot_row[j];
    }
    right_[i] -= l * right_[pivot];
  }
}

// A R = -b in the free rows, by Cholesky's factorisation with the strongest left as the next pivot;
// what depends on the others takes no part.
void BoxProblem::SolveFree() {
  for (int i = 0; i < size_; ++i) {
    R[i] = state_[i] == State::kUpper ? limit[i] : state_[i] == State::kLower ? -limit[i] : 0;
    used_[i] = state_[i] != State::kFree || !CanHold(i);
  }
  for (int i = 0; i < size_; ++i) {
    right_[i] = -b[i];
    for (int j = 0; j < size_; ++j) right_[i] -= A(i, j) * R[j];
  }
  std::copy(A_.begin(), A_.end(), factor_.begin());
  pivots_.clear();
  while (true) {
    int best = -1;
    double most = kDependent;
    for (int i = 0; i < size_; ++i) {
      if (used_[i]) continue;
      const double share = factor_[i * capacity_ + i] / A(i, i);
      if (share > most) {
        most = share;
        best = i;
      }
    }
    if (best < 0) break;
    used_[best] = 1;
    pivots_.push_back(best);
    Eliminate(best);
  }
  for (size_t k = pivots_.size(); k-- > 0;) {
    const int i = pivots_[k];
    double sum = right_[i];
    for (size_t m = k + 1; m < pivots_.size(); ++m) {
      sum -= factor_[i * capacity_ + pivots_[m]] * R[pivots_[m]];
    }
    R[i] = sum / factor_[i * capacity_ + i];
  }
}

void BoxProblem::CalcAccelerations() {
  for (int i = 0; i < size_; ++i) {
    a[i] = b[i];
    scale_[i] = std::abs(b[i]) + reference[i] * limit[i];
    for (int j = 0; j < size_; ++j) {
      a[i] += A(i, j) * R[j];
      scale_[i] += std::abs(A(i, j) * R[j]);
    }
    if (std::abs(a[i]) <= kRounding * scale_[i]) a[i] = 0;
  }
}

int BoxProblem::FindWorstBeyondLimit() const {
  int worst = -1;
  double largest = 1;
  for (int i = 0; i < size_; ++i) {
    if (state_[i] != State::kFree || R[i] == 0) continue;
    const double share =
        limit[i] > 0 ? std::abs(R[i]) / limit[i] : std::numeric_limits<double>::infinity();
    if (share > largest) {
      largest = share;
      worst = i;
    }
  }
  return worst;
}

// At its limit although the slip would go the other way.
int BoxProblem::FindWorstHeldBack() const {
  int worst = -1;
  double largest = 0;
  for (int i = 0; i < size_; ++i) {
    if (state_[i] == State::kFree || !CanHold(i)) continue;
    const double wrong = (state_[i] == State::kUpper ? a[i] : -a[i]) / std::sqrt(A(i, i));
    if (wrong > largest) {
      largest = wrong;
      worst = i;
    }
  }
  return worst;
}

void BoxProblem::KeepIndependent(std::span<char> candidates) {
  std::copy(A_.begin(), A_.end(), factor_.begin());
  for (int i = 0; i < size_; ++i) used_[i] = !candidates[i] || !CanHold(i);
  std::fill(candidates.begin(), candidates.end(), 0);
  while (true) {
    int best = -1;
    double most = -1;
    for (int i = 0; i < size_; ++i) {
      if (used_[i]) continue;
      if (factor_[i * capacity_ + i] < kIndependent * A(i, i)) {
        used_[i] = 1;
        continue;
      }
      const double room = (limit[i] - std::abs(R[i])) * std::sqrt(A(i, i));
      if (room > most) {
        most = room;
        best = i;
      }
    }
    if (best < 0) return;
    candidates[best] = used_[best] = 1;
    Eliminate(best);
  }
}

}  // namespace kingpin::mechanism
