#include "optimisation/report/plot_area.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/html.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/svg.h"
#include "optimisation/report/ticks.h"

namespace kingpin::report {
namespace {

// Beyond this, differences of values overflow; such data are a failed run, not a curve.
constexpr double kLargest = 1e150;

}  // namespace

AxisMap::AxisMap(const Axis& axis, const std::vector<double>& values, double margin,
                 int wanted_ticks)
    : name_(axis.name), unit_(axis.unit), logarithmic_(axis.scale == Scale::kLog) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double v : values) {
    if (!std::isfinite(v) || std::abs(v) > kLargest || (logarithmic_ && v < 1e-150)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  has_data_ = low <= high;
  if (!has_data_) {
    low = logarithmic_ ? 1.0 : 0.0;
    high = logarithmic_ ? 10.0 : 1.0;
  }
  if (axis.include_zero && !logarithmic_) {
    low = std::min(low, 0.0);
    high = std::max(high, 0.0);
  }
  if (logarithmic_) {
    if (high / low < 1.001) {
      low /= 2.0;
      high *= 2.0;
    } else if (margin > 0.0) {
      const double factor = std::pow(high / low, margin);
      low /= factor;
      high *= factor;
    }
  } else if (high - low <= 1e-12 * std::max(std::abs(low), std::abs(high))) {
    const double pad = low == 0.0 ? 1.0 : 0.1 * std::abs(low);
    low -= pad;
    high += pad;
  } else {
    const double pad = margin * (high - low);
    if (!(axis.include_zero && low == 0.0)) low -= pad;
    if (!(axis.include_zero && high == 0.0)) high += pad;
  }
  const bool usable_min = std::isfinite(axis.min) && !(logarithmic_ && axis.min <= 0.0);
  const bool usable_max = std::isfinite(axis.max) && !(logarithmic_ && axis.max <= 0.0);
  if (usable_min && usable_max && axis.min < axis.max) {
    low = axis.min;
    high = axis.max;
  } else if (usable_min && !usable_max) {
    low = axis.min;
    if (!(low < high)) high = logarithmic_ ? 10.0 * low : low + std::max(1.0, std::abs(low));
  } else if (usable_max && !usable_min) {
    high = axis.max;
    if (!(low < high)) low = logarithmic_ ? high / 10.0 : high - std::max(1.0, std::abs(high));
  }
  low_ = low;
  high_ = high;
  for (const double tick : axis.ticks) {
    if (tick >= low && tick <= high) ticks_.push_back(tick);
  }
  if (ticks_.empty()) {
    ticks_ =
        logarithmic_ ? MakeLogTicks(low, high, wanted_ticks) : MakeTicks(low, high, wanted_ticks);
  }
  if (logarithmic_) {
    labels_ = MakeLogTickLabels(ticks_);
  } else {
    TickLabels made = MakeTickLabels(ticks_);
    labels_ = std::move(made.texts);
    exponent_ = made.exponent;
  }
}

void AxisMap::SetPixels(double at_low, double at_high) {
  pixel_low_ = at_low;
  pixel_high_ = at_high;
}

double AxisMap::ToPixel(double value) const {
  if (!std::isfinite(value) || std::abs(value) > kLargest) return kMissing;
  double share;
  if (logarithmic_) {
    if (value < 1e-150) return kMissing;
    share = std::log(value / low_) / std::log(high_ / low_);
  } else {
    share = (value - low_) / (high_ - low_);
  }
  return std::clamp(pixel_low_ + share * (pixel_high_ - pixel_low_), -1e5, 1e5);
}

std::string AxisMap::MakeTitle() const {
  std::string unit = PrettyUnit(unit_);
  if (exponent_ != 0) {
    const std::string power = FormatPowerOfTen(exponent_);
    unit = unit.empty() ? power : power + " " + unit;
  }
  return unit.empty() ? SymbolSvg(name_)
                      : fmt::format("{} [{}]", SymbolSvg(name_), EscapeHtml(unit));
}

std::string AxisMap::MakeScript() const {
  return fmt::format("[{},{},{:.9g},{:.9g},{}]", FormatPixel(pixel_low_), FormatPixel(pixel_high_),
                     low_, high_, logarithmic_ ? 1 : 0);
}

double AxisMap::CalcLabelWidth(double font_size) const {
  double width = 0.0;
  for (const std::string& label : labels_) {
    width = std::max(width, EstimateTextWidth(label, font_size));
  }
  return width;
}

}  // namespace kingpin::report
