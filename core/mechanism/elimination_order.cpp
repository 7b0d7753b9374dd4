#include "core/mechanism/elimination_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kingpin::mechanism {

namespace {

constexpr double kSafeShare = 0.1;   // of the largest pivot a row can have
constexpr double kDependent = 1e-9;  // of the same: nothing but rounding is left
// What a row of gradient one (the scale of the samples) at least has of it, squared: less is
// rounding of a gradient that vanishes.
constexpr double kNoGradient = 1e-20;
constexpr double kRunTimeShare = 1e-5;  // of the pivots seen, before digits are worth saving

}  // namespace

EliminationOrder ChooseEliminationOrder(int coordinates,
                                        const std::vector<Eigen::MatrixXd>& samples,
                                        std::span<const char> switching,
                                        std::span<const std::pair<int, int>> pattern) {
  const int n = static_cast<int>(samples.front().rows());
  std::vector<Eigen::MatrixXd> work = samples;
  std::vector<std::vector<char>> linked(n, std::vector<char>(n, 0));
  for (const auto& [i, j] : pattern) linked[i][j] = linked[j][i] = i != j;

  // The largest pivots that rows can have: the diagonal of Dᵀ M⁻¹ D.
  std::vector<std::vector<double>> full(work.size(), std::vector<double>(n, 0));
  const bool coupled = coordinates > 0 && n > coordinates;  // no empty matrix is taken apart
  for (size_t s = 0; coupled && s < work.size(); ++s) {
    const Eigen::MatrixXd D = work[s].topRightCorner(coordinates, n - coordinates);
    const Eigen::MatrixXd X = work[s].topLeftCorner(coordinates, coordinates).ldlt().solve(D);
    for (int r = coordinates; r < n; ++r) {
      full[s][r] = D.col(r - coordinates).dot(X.col(r - coordinates));
    }
  }

  EliminationOrder result;
  result.redundant.assign(n - coordinates, 0);
  std::vector<char> gone(n, 0);
  std::vector<int> neighbours;
  const auto eliminate = [&](int k) {
    neighbours.clear();
    for (int i = 0; i < n; ++i) {
      if (!gone[i] && i != k && linked[k][i]) neighbours.push_back(i);
    }
    for (Eigen::MatrixXd& A : work) {
      const double inverse = 1.0 / A(k, k);
      for (int i : neighbours) {
        const double l = A(i, k) * inverse;
        for (int j : neighbours) A(i, j) -= l * A(k, j);
      }
    }
    for (int i : neighbours) {
      for (int j : neighbours) linked[i][j] = i != j;
    }
    gone[k] = 1;
    result.order.push_back(k);
  };

  int lasting = 0;  // rows still to go that are always in use
  for (char s : switching) lasting += !s;
  for (int step = 0; step < n; ++step) {
    int best = -1;
    long best_fill = std::numeric_limits<long>::max();
    int best_degree = n;
    double best_share = 0;
    bool best_is_last_resort = true;
    for (int k = 0; k < n; ++k) {
      if (gone[k]) continue;
      double share = 1;
      bool last_resort = false;
      if (k >= coordinates) {
        if (switching[k - coordinates] && lasting > 0) continue;
        bool free = true;  // no coordinate left that could still feed this pivot
        for (int i = 0; i < coordinates && free; ++i) free = gone[i] || !linked[k][i];
        share = std::numeric_limits<double>::infinity();
        for (size_t s = 0; s < work.size(); ++s) {
          share = std::min(share, full[s][k] > kNoGradient ? -work[s](k, k) / full[s][k] : 0.0);
        }
        last_resort = share < kSafeShare;
        if (last_resort && !free) continue;
      }
      // Rows that nothing can help any more go last, the best of them first.
      if (last_resort && (best >= 0 && !best_is_last_resort)) continue;
      long fill = 0;
      int degree = 0;
      for (int i = 0; i < n; ++i) {
        if (gone[i] || i == k || !linked[k][i]) continue;
        ++degree;
        for (int j = i + 1; j < n; ++j) fill += !gone[j] && j != k && linked[k][j] && !linked[i][j];
      }
      const bool better =
          best < 0 || (best_is_last_resort && !last_resort) ||
          (last_resort ? share > best_share
                       : fill < best_fill || (fill == best_fill && degree < best_degree));
      if (better) {
        best = k;
        best_fill = fill;
        best_degree = degree;
        best_share = share;
        best_is_last_resort = last_resort;
      }
    }
    if (best >= coordinates && !switching[best - coordinates]) --lasting;
    if (best >= coordinates) {
      // Dependent in every sample: one state with a pivot is enough to keep the row.
      double largest = 0;
      for (size_t s = 0; s < work.size(); ++s) {
        if (full[s][best] > kNoGradient)
          largest = std::max(largest, -work[s](best, best) / full[s][best]);
      }
      if (largest < kDependent) {
        result.redundant[best - coordinates] = 1;
        result.pivot_limits.push_back(0);
        for (int i = 0; i < n; ++i) linked[best][i] = linked[i][best] = 0;
        gone[best] = 1;
        result.order.push_back(best);
        continue;
      }
    }
    double smallest = std::numeric_limits<double>::infinity();
    for (const Eigen::MatrixXd& A : work) smallest = std::min(smallest, std::abs(A(best, best)));
    result.pivot_limits.push_back((best < coordinates ? 1 : -1) * kRunTimeShare * smallest);
    eliminate(best);
  }
  return result;
}

}  // namespace kingpin::mechanism
