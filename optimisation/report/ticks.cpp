#include "optimisation/report/ticks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/number_format.h"

namespace kingpin::report {

std::vector<double> MakeTicks(double low, double high, int wanted) {
  if (!(low < high) || !std::isfinite(high - low)) return {low};
  const double raw = (high - low) / std::max(wanted, 1);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double mantissa = raw / power;
  // The nearest of 1, 2, 5, 10 on a logarithmic scale.
  double step = 10.0 * power;
  if (mantissa <= 7.07) step = 5.0 * power;
  if (mantissa <= 3.16) step = 2.0 * power;
  if (mantissa <= 1.41) step = power;
  if (!(step > 0.0)) return {low};
  // The slack lets a range that ends on a round number show it in spite of rounding.
  const double first = std::ceil(low / step - 1e-9);
  const double last = std::floor(high / step + 1e-9);
  std::vector<double> ticks;
  for (double k = first; k <= last && ticks.size() < 100; k += 1.0) {
    ticks.push_back(std::clamp(k * step, low, high));
    if (k + 1.0 == k) break;  // values so large that the step is lost
  }
  if (ticks.empty()) ticks.push_back(low);
  return ticks;
}

std::vector<double> MakeLogTicks(double low, double high, int wanted) {
  if (!(low > 0.0) || !(low < high) || !std::isfinite(high)) return {low};
  const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
  const double decades = std::log10(high / low);
  std::vector<double> ticks;
  if (decades < 3.0) {
    for (int e = first - 1; e <= last; ++e) {
      for (const double m : {1.0, 2.0, 5.0}) {
        const double tick = m * std::pow(10.0, e);
        if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) ticks.push_back(tick);
      }
    }
    if (ticks.size() < 2) return MakeTicks(low, high, wanted);
    return ticks;
  }
  const int every = std::max(1, static_cast<int>(std::ceil(decades / std::max(wanted, 1))));
  for (int e = first; e <= last; ++e) {
    if ((e - first) % every == 0) ticks.push_back(std::pow(10.0, e));
  }
  return ticks;
}

TickLabels MakeTickLabels(const std::vector<double>& ticks) {
  TickLabels labels;
  double largest = 0.0;
  for (const double tick : ticks) largest = std::max(largest, std::abs(tick));
  if (largest > 0.0 && std::isfinite(largest) && (largest >= 1e5 || largest < 1e-2)) {
    labels.exponent = 3 * static_cast<int>(std::floor(std::log10(largest) / 3.0));
  }
  const double scale = std::pow(10.0, labels.exponent);
  const double step = ticks.size() > 1 ? std::abs(ticks[1] - ticks[0]) / scale : 0.0;
  int decimals = 2;
  if (step > 0.0) {
    decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
  }
  for (const double tick : ticks) {
    const double value = tick / scale;
    std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
    const bool zero = text.find_first_not_of("0.") == std::string::npos;
    labels.texts.push_back((value < 0.0 && !zero ? "−" : "") + text);
  }
  return labels;
}

std::vector<std::string> MakeLogTickLabels(const std::vector<double>& ticks) {
  std::vector<std::string> texts;
  for (const double tick : ticks) {
    const double exponent = std::log10(tick);
    const bool power = std::abs(exponent - std::round(exponent)) < 1e-6;
    if (power && (tick < 0.9e-3 || tick > 1.1e4)) {
      texts.push_back(FormatPowerOfTen(static_cast<int>(std::lround(exponent))));
    } else {
      texts.push_back(FormatShort(tick, 3));
    }
  }
  return texts;
}

}  // namespace kingpin::report
