#include "optimisation/report/decimation.h"

#include <algorithm>
#include <cmath>

namespace kingpin::report {
namespace {

void AddColumn(const std::vector<PixelPoint>& points, size_t begin, size_t end,
               std::vector<PixelPoint>& out) {
  if (end - begin <= 4) {
    out.insert(out.end(), points.begin() + static_cast<long>(begin),
               points.begin() + static_cast<long>(end));
    return;
  }
  size_t low = begin;
  size_t high = begin;
  for (size_t i = begin; i < end; ++i) {
    if (points[i].y < points[low].y) low = i;
    if (points[i].y > points[high].y) high = i;
  }
  std::vector<size_t> kept = {begin, std::min(low, high), std::max(low, high), end - 1};
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  for (const size_t i : kept) out.push_back(points[i]);
}

}  // namespace

std::vector<std::vector<PixelPoint>> DecimateLine(const std::vector<PixelPoint>& points,
                                                  double column) {
  std::vector<std::vector<PixelPoint>> pieces;
  size_t i = 0;
  while (i < points.size()) {
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y)) {
      ++i;
      continue;
    }
    std::vector<PixelPoint> piece;
    while (i < points.size() && std::isfinite(points[i].x) && std::isfinite(points[i].y)) {
      const double bin = std::floor(points[i].x / column);
      size_t end = i;
      while (end < points.size() && std::isfinite(points[end].y) &&
             std::floor(points[end].x / column) == bin) {
        ++end;
      }
      AddColumn(points, i, end, piece);
      i = end;
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace kingpin::report
