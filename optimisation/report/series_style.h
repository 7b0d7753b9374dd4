#pragma once

#include <cstddef>
#include <string>

namespace kingpin::report {

enum class Marker { kNone, kCircle, kSquare, kDiamond, kTriangle, kCross };

/// How a design is drawn, the same in every figure. Colours are those of Okabe and Ito (safe for
/// colour-blind readers); width, dash and marker tell the designs apart in greyscale, too.
struct SeriesStyle {
  std::string colour = "#0072B2";
  std::string dash;  ///< SVG stroke-dasharray; empty: solid
  double width = 1.5;
  Marker marker = Marker::kCircle;
};

/// Style of the n-th design; 0 is the reference (a broad pale line the others lie upon).
SeriesStyle StyleOf(size_t index);

}  // namespace kingpin::report
