#include "core/io/nearest_name.h"

#include <algorithm>

#include <fmt/format.h>

namespace kingpin::io {
namespace {

constexpr std::size_t kLongestName = 128;  // keeps the quadratic cost bounded for hostile keys
constexpr std::size_t kMostListed = 24;

char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

int CalcEditDistance(std::string_view a, std::string_view b) {
  const std::size_t n = b.size();
  std::vector<int> before(n + 1);
  std::vector<int> last(n + 1);
  std::vector<int> row(n + 1);
  for (std::size_t j = 0; j <= n; ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= n; ++j) {
      const bool same = Lower(a[i - 1]) == Lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && Lower(a[i - 1]) == Lower(b[j - 2]) &&
          Lower(a[i - 2]) == Lower(b[j - 1])) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[n];
}

std::string FindNearestName(std::string_view name, const std::vector<std::string>& candidates) {
  if (name.empty() || name.size() > kLongestName) return {};
  std::string best;
  int best_distance = std::max(1, static_cast<int>(name.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestName) continue;
    const int distance = CalcEditDistance(name, candidate);
    // A distance equal to the whole name would only replace every letter.
    if (distance < best_distance && distance < static_cast<int>(candidate.size())) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string SuggestName(std::string_view name, const std::vector<std::string>& candidates,
                        std::string_view what) {
  if (candidates.empty()) return {};
  const std::string nearest = FindNearestName(name, candidates);
  if (!nearest.empty()) return fmt::format("did you mean '{}'?", nearest);
  std::string list;
  for (std::size_t i = 0; i < candidates.size() && i < kMostListed; ++i) {
    list += (i == 0 ? "" : ", ") + candidates[i];
  }
  if (candidates.size() > kMostListed) {
    list += fmt::format(" and {} more", candidates.size() - kMostListed);
  }
  return fmt::format("known {}: {}", what, list);
}

}  // namespace kingpin::io
