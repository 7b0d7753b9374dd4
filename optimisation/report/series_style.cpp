#include "optimisation/report/series_style.h"

#include <array>

namespace kingpin::report {

SeriesStyle StyleOf(size_t index) {
  static const std::array<SeriesStyle, 7> kStyles = {{
      {"#949494", "", 2.4, Marker::kSquare},
      {"#0072B2", "", 1.4, Marker::kCircle},
      {"#D55E00", "7 2.5", 1.5, Marker::kDiamond},
      {"#009E73", "2 2", 1.8, Marker::kTriangle},
      {"#B0548A", "9 2.5 2 2.5", 1.5, Marker::kCross},
      {"#E69F00", "4 2", 1.7, Marker::kSquare},
      {"#56B4E9", "12 3", 1.7, Marker::kCircle},
  }};
  if (index == 0) return kStyles[0];
  return kStyles[1 + (index - 1) % (kStyles.size() - 1)];
}

}  // namespace kingpin::report
