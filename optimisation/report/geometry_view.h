#pragma once

#include <string>
#include <vector>

#include "optimisation/report/study_report_data.h"

namespace kingpin::report {

/// A design in the geometry figure, with the style it has in all figures.
struct GeometryItem {
  const Design* design = nullptr;
  size_t style = 0;
};

/// The corner seen from above, to scale, all items overlaid: x (forward) points up, y (left) to the
/// left. When an item has a motion, controls for the animation and the sampled coordinates (at most
/// 400 instants) are added; without script, and printed, the figure shows the rest position. The
/// last item carries the labels. Empty when no item has a point to draw.
std::string DrawGeometry(const std::vector<GeometryItem>& items);

}  // namespace kingpin::report
