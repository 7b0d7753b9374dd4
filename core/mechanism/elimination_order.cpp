#include "core/mechanism/elimination_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/mechanism/row_groups.h"

namespace kingpin::mechanism {

namespace {

constexpr double kSafeShare = 0.01;     // of the largest pivot a row can have
constexpr double kRunTimeShare = 1e-5;  // of the pivots seen, before digits are worth saving

// The matrix while unknowns are taken out of it, in sparse rows that hold both triangles.
class Elimination {
 public:
  explicit Elimination(const SampledMatrix& samples)
      : diagonal_(samples.diagonal),
        rows_(samples.diagonal.size()),
        fill_(rows_.size(), 0),
        stale_(rows_.size(), 1) {
    for (const auto& [i, j, value] : samples.entries) {
      rows_[i].push_back({j, value});
      rows_[j].push_back({i, value});
    }
    for (Row& row : rows_) std::sort(row.begin(), row.end(), Before);
  }

  const SampleValues& diagonal(int k) const { return diagonal_[k]; }
  int CountNeighbours(int k) const { return static_cast<int>(rows_[k].size()); }
  std::vector<int> ListNeighbours(int k) const {
    std::vector<int> list;
    for (const Neighbour& neighbour : rows_[k]) list.push_back(neighbour.unknown);
    return list;
  }
  /// Whether k is coupled with an unknown below `limit`.
  bool HasNeighbourBelow(int k, int limit) const {
    return !rows_[k].empty() && rows_[k].front().unknown < limit;
  }

  /// Pairs of neighbours that the elimination of k would link.
  long GetFill(int k) {
    if (stale_[k]) {
      fill_[k] = CalcFill(k);
      stale_[k] = 0;
    }
    return fill_[k];
  }

  void Remove(int k) {
    for (const auto& [i, value] : rows_[k]) {
      rows_[i].erase(Find(rows_[i], k));
      stale_[i] = 1;
    }
    rows_[k].clear();
  }

  /// @param out_at_times k may be out of use: what it links counts, not what it changes. Rows that
  /// depend on each other may then all have their place, as long as they are never used together.
  void Eliminate(int k, bool out_at_times) {
    const Row pivot_row = rows_[k];
    Remove(k);
    for (const auto& [i, value] : pivot_row) {
      SampleValues l{};
      for (int s = 0; s < kSamples && !out_at_times; ++s) l[s] = value[s] / diagonal_[k][s];
      for (int s = 0; s < kSamples; ++s) diagonal_[i][s] -= l[s] * value[s];
      Subtract(i, l, pivot_row);
    }
  }

 private:
  struct Neighbour {
    int unknown = 0;
    SampleValues value{};
  };
  using Row = std::vector<Neighbour>;

  static bool Before(const Neighbour& a, const Neighbour& b) { return a.unknown < b.unknown; }
  static Row::iterator Find(Row& row, int unknown) {
    return std::lower_bound(row.begin(), row.end(), Neighbour{unknown, {}}, Before);
  }

  long CalcFill(int k) const {
    const Row& row = rows_[k];
    long linked = 0;
    for (const Neighbour& i : row) linked += CountShared(rows_[i.unknown], row);
    const long n = static_cast<long>(row.size());
    return (n * (n - 1) - linked) / 2;
  }

  static long CountShared(const Row& a, const Row& b) {
    long shared = 0;
    for (size_t i = 0, j = 0; i < a.size() && j < b.size();) {
      if (a[i].unknown == b[j].unknown)
        ++shared, ++i, ++j;
      else if (a[i].unknown < b[j].unknown)
        ++i;
      else
        ++j;
    }
    return shared;
  }

  // row i -= l times the pivot's row
  void Subtract(int i, const SampleValues& l, const Row& pivot_row) {
    Row& row = rows_[i];
    merged_.clear();
    auto at = row.begin();
    for (const Neighbour& b : pivot_row) {
      if (b.unknown == i) continue;
      while (at != row.end() && at->unknown < b.unknown) merged_.push_back(*at++);
      Neighbour sum{b.unknown, {}};
      if (at != row.end() && at->unknown == b.unknown) {
        sum = *at++;
      } else if (i < b.unknown) {
        MarkShared(row, rows_[b.unknown]);
      }
      for (int s = 0; s < kSamples; ++s) sum.value[s] -= l[s] * b.value[s];
      merged_.push_back(sum);
    }
    merged_.insert(merged_.end(), at, row.end());
    row.swap(merged_);
  }

  // a new link between two unknowns changes the fill of whatever is linked with both
  void MarkShared(const Row& a, const Row& b) {
    for (size_t i = 0, j = 0; i < a.size() && j < b.size();) {
      if (a[i].unknown == b[j].unknown)
        stale_[a[i].unknown] = 1, ++i, ++j;
      else if (a[i].unknown < b[j].unknown)
        ++i;
      else
        ++j;
    }
  }

  std::vector<SampleValues> diagonal_;
  std::vector<Row> rows_;
  std::vector<long> fill_;
  std::vector<char> stale_;
  Row merged_;
};

// An order with the same elimination tree, hence the same fill and the same pivots, in which every
// subtree comes in one piece: what is eliminated together lies together.
void SortDepthFirst(const std::vector<std::vector<int>>& neighbours, EliminationOrder& order) {
  const int steps = static_cast<int>(order.order.size());
  std::vector<int> step_of(1 + *std::max_element(order.order.begin(), order.order.end()), steps);
  for (int k = 0; k < steps; ++k) step_of[order.order[k]] = k;
  // the parent of a step is the first of its neighbours to go; steps without one hang on `steps`
  std::vector<std::vector<int>> children(steps + 1);
  for (int k = 0; k < steps; ++k) {
    int parent = steps;
    for (int unknown : neighbours[k]) parent = std::min(parent, step_of[unknown]);
    children[parent].push_back(k);
  }
  EliminationOrder sorted;
  std::vector<std::pair<int, size_t>> path = {{steps, 0}};  // step, how many children are done
  while (!path.empty()) {
    auto& [step, done] = path.back();
    if (done < children[step].size()) {
      path.emplace_back(children[step][done++], 0);
      continue;
    }
    if (step < steps) {
      sorted.order.push_back(order.order[step]);
      sorted.pivot_limits.push_back(order.pivot_limits[step]);
    }
    path.pop_back();
  }
  order = std::move(sorted);
}

}  // namespace

EliminationOrder ChooseEliminationOrder(const SampledMatrix& samples) {
  const int n = static_cast<int>(samples.diagonal.size()), coordinates = samples.coordinates;
  Elimination work(samples);
  // the share that a row's pivot has of what it could be, the least of all samples
  const auto get_share = [&](int k) {
    double least = std::numeric_limits<double>::infinity();
    for (int s = 0; s < kSamples; ++s) {
      const double full = samples.largest_pivot[k][s];
      least = std::min(least, full > kNoGradient ? -work.diagonal(k)[s] / full : 0.0);
    }
    return least;
  };

  EliminationOrder result;
  std::vector<std::vector<int>> neighbours;  // per step, that the unknown had when it went
  std::vector<int> left;                     // unknowns still to go, in their own order
  int lasting = 0;                           // rows still to go that are always in use
  for (int k = 0; k < n; ++k) {
    if (samples.last[k] == SampledMatrix::kOut) {
      work.Remove(k);
    } else {
      left.push_back(k);
      lasting += k >= coordinates && !samples.last[k];
    }
  }
  while (!left.empty()) {
    int best = -1;
    long best_fill = std::numeric_limits<long>::max();
    int best_degree = n;
    double best_share = 0;
    bool best_is_last_resort = true;
    for (int k : left) {
      double share = 1;
      bool last_resort = false;
      if (k >= coordinates) {
        if (samples.last[k] && lasting > 0) continue;
        share = get_share(k);
        last_resort = share < kSafeShare;
        // as long as coordinates are left that could still feed this pivot
        if (last_resort && work.HasNeighbourBelow(k, coordinates)) continue;
      }
      // Rows that nothing can help any more go last, the best of them first.
      if (last_resort && best >= 0 && !best_is_last_resort) continue;
      const long fill = work.GetFill(k);
      const int degree = work.CountNeighbours(k);
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
    left.erase(std::lower_bound(left.begin(), left.end(), best));
    if (best >= coordinates && !samples.last[best]) --lasting;
    double smallest = std::numeric_limits<double>::infinity();
    for (double pivot : work.diagonal(best)) smallest = std::min(smallest, std::abs(pivot));
    result.order.push_back(best);
    result.pivot_limits.push_back((best < coordinates ? 1 : -1) * kRunTimeShare * smallest);
    neighbours.push_back(work.ListNeighbours(best));
    work.Eliminate(best, samples.last[best]);
  }
  if (!result.order.empty()) SortDepthFirst(neighbours, result);
  for (int k = 0; k < n; ++k) {
    if (samples.last[k] != SampledMatrix::kOut) continue;
    result.order.push_back(k);
    result.pivot_limits.push_back(0);
  }
  return result;
}

}  // namespace kingpin::mechanism
