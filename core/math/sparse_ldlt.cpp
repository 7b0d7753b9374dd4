#include "core/math/sparse_ldlt.h"

#include <algorithm>

namespace kingpin::math {

// Columns as sorted sets; eliminating column j joins its rows to the column of the first of them
// (its parent in the elimination tree), which is where all fill comes from.
void SparseLdltPattern::SetColumns(std::span<const std::pair<int, int>> entries, bool fill,
                                   Columns& columns) {
  columns.resize(unknowns_);
  for (const auto& [i, j] : entries) {
    const int a = std::min(position_[i], position_[j]), b = std::max(position_[i], position_[j]);
    if (a != b) columns[a].push_back(b);
  }
  begin_.assign(unknowns_ + 1, unknowns_ + 1);
  for (int j = 0; j < unknowns_; ++j) {
    std::vector<int>& rows = columns[j];
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    if (fill && !rows.empty()) {
      columns[rows[0]].insert(columns[rows[0]].end(), rows.begin() + 1, rows.end());
    }
    rows.push_back(unknowns_);  // the right side
    row_.insert(row_.end(), rows.begin(), rows.end());
    begin_[j + 1] = unknowns_ + 1 + static_cast<int>(row_.size());
  }
  size_ = begin_[unknowns_];
}

SparseLdltPattern SparseLdltPattern::MakeStorage(int unknowns,
                                                 std::span<const std::pair<int, int>> entries) {
  SparseLdltPattern pattern;
  pattern.unknowns_ = unknowns;
  for (int k = 0; k < unknowns; ++k) pattern.position_.push_back(k);
  Columns columns;
  pattern.SetColumns(entries, false, columns);
  return pattern;
}

SparseLdltPattern::SparseLdltPattern(std::span<const int> order,
                                     std::span<const std::pair<int, int>> entries)
    : unknowns_(static_cast<int>(order.size())), position_(order.size()) {
  for (int k = 0; k < unknowns_; ++k) position_[order[k]] = k;
  Columns columns;
  SetColumns(entries, true, columns);
  SetNodes(columns);
}

void SparseLdltPattern::SetNodes(const Columns& columns) {
  for (int j = 0; j < unknowns_;) {
    int width = 1;
    while (width < kWidest && j + width < unknowns_ && columns[j + width - 1][0] == j + width &&
           columns[j + width - 1].size() == columns[j + width].size() + 1) {
      ++width;
    }
    nodes_.push_back({j, width});
    for (int w = 0; w < width; ++w) {
      const long rows = static_cast<long>(columns[j + w].size()) - 1;
      operations_ += rows * (rows + 3) / 2;
    }
    j += width;
    const std::vector<int>& rows = columns[j - 1];
    for (size_t a = 0; a + 1 < rows.size(); ++a) {
      const std::vector<int>& other = columns[rows[a]];
      std::vector<int> slots;
      size_t at = 0;
      for (size_t b = a + 1; b < rows.size(); ++b) {
        while (other[at] != rows[b]) ++at;
        slots.push_back(begin_[rows[a]] + static_cast<int>(at));
      }
      // slots that follow each other, up to the last, which is the right side
      size_t run = slots.size() - 1;
      while (run > 0 && slots[run - 1] + 1 == slots[run]) --run;
      plan_.push_back(static_cast<int>(run));
      plan_.insert(plan_.end(), slots.begin(), slots.begin() + static_cast<long>(run) + 1);
    }
  }
}

int SparseLdltPattern::GetSlot(int i, int j) const {
  const int a = std::min(position_[i], position_[j]), b = std::max(position_[i], position_[j]);
  if (a == b) return a;
  const auto first = row_.begin() + (begin_[a] - (unknowns_ + 1)),
             last = row_.begin() + (begin_[a + 1] - (unknowns_ + 1));
  const auto found = std::lower_bound(first, last, b);
  return found != last && *found == b ? begin_[a] + static_cast<int>(found - first) : -1;
}

}  // namespace kingpin::math
