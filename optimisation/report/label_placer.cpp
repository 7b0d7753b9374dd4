#include "optimisation/report/label_placer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/html.h"
#include "optimisation/report/svg.h"

namespace kingpin::report {
namespace {

constexpr double kFont = 11.0;
constexpr double kSamePlace = 6.0;

}  // namespace

void LabelPlacer::Add(double x, double y, const std::string& name) {
  if (name.empty() || !std::isfinite(x) || !std::isfinite(y)) return;
  for (Label& label : labels_) {
    if (std::hypot(label.x - x, label.y - y) > kSamePlace) continue;
    if (std::find(label.names.begin(), label.names.end(), name) == label.names.end()) {
      label.names.push_back(name);
    }
    return;
  }
  labels_.push_back({x, y, {name}});
}

bool LabelPlacer::IsFree(const Box& box) const {
  if (box.left < frame_.left || box.right > frame_.right || box.top < frame_.top ||
      box.bottom > frame_.bottom) {
    return false;
  }
  return std::none_of(boxes_.begin(), boxes_.end(), [&](const Box& b) {
    return b.left < box.right && box.left < b.right && b.top < box.bottom && box.top < b.bottom;
  });
}

std::string LabelPlacer::Draw(const std::string& css) {
  static constexpr double kWays[][2] = {{1, -1}, {1, 1}, {-1, -1}, {-1, 1},
                                        {0, -1}, {0, 1}, {1, 0},   {-1, 0}};
  for (const Label& label : labels_) Reserve(label.x, label.y);
  std::string out;
  for (const Label& label : labels_) {
    const std::string text = fmt::format("{}", fmt::join(label.names, ", "));
    const double width = EstimateTextWidth(text, kFont) + 4.0;
    const auto place = [&]() -> Box {
      for (const double distance : {8.0, 16.0, 26.0, 40.0, 56.0}) {
        for (const auto& way : kWays) {
          const double x = label.x + way[0] * distance;
          const double y = label.y + way[1] * distance;
          const double left = way[0] > 0 ? x : way[0] < 0 ? x - width : x - 0.5 * width;
          const Box box = {left - 2, y - 8, left + width + 2, y + 8};
          if (IsFree(box)) return box;
        }
      }
      return {label.x + 6, label.y - 16, label.x + width + 10, label.y};
    };
    const Box box = place();
    boxes_.push_back(box);
    out += SvgText(box.left + 2, box.top + 12.0, "start", SymbolSvg(text), css);
  }
  return out;
}

}  // namespace kingpin::report
