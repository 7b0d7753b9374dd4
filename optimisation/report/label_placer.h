#pragma once

#include <string>
#include <vector>

namespace kingpin::report {

/// Puts names beside points of a drawing so that they cover neither each other nor the points.
class LabelPlacer {
 public:
  /// Labels stay inside this frame where they can [pixels].
  LabelPlacer(double left, double top, double right, double bottom)
      : frame_{left, top, right, bottom} {}

  /// Keeps a place free: a point, or a box.
  void Reserve(double x, double y) { boxes_.push_back({x - 5, y - 5, x + 5, y + 5}); }
  void ReserveBox(double left, double top, double right, double bottom) {
    boxes_.push_back({left, top, right, bottom});
  }

  /// A name for a point. Names of points within 6 pixels are written together, `K, L, road force`;
  /// the same name twice once.
  void Add(double x, double y, const std::string& name);

  /// The texts as SVG with these classes, in the order they were added.
  std::string Draw(const std::string& css);

 private:
  struct Box {
    double left, top, right, bottom;
  };
  struct Label {
    double x, y;
    std::vector<std::string> names;
  };

  bool IsFree(const Box& box) const;

  Box frame_;
  std::vector<Box> boxes_;
  std::vector<Label> labels_;
};

}  // namespace kingpin::report
