#include "optimisation/report/number_format.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace kingpin::report {
namespace {

constexpr const char* kDash = "–";
constexpr const char* kMinus = "−";
constexpr const char* kThinSpace = "\u202f";

std::string GroupThousands(const std::string& digits) {
  const size_t point = std::min(digits.find('.'), digits.size());
  if (point < 5) return digits;
  std::string out;
  for (size_t i = 0; i < point; ++i) {
    if (i > 0 && (point - i) % 3 == 0) out += kThinSpace;
    out += digits[i];
  }
  return out + digits.substr(point);
}

std::string TrimZeros(std::string digits) {
  if (digits.find('.') == std::string::npos) return digits;
  while (digits.back() == '0') digits.pop_back();
  if (digits.back() == '.') digits.pop_back();
  return digits;
}

std::string FormatDigits(double value, int significant, bool trim) {
  if (std::isnan(value)) return kDash;
  const std::string sign = value < 0 ? kMinus : "";
  if (std::isinf(value)) return sign + "∞";
  if (value == 0.0) return "0";
  significant = std::clamp(significant, 1, 17);
  const double size = std::abs(value);
  // The exponent after rounding, so that 9.9996 becomes 10.00 and not 10.000.
  const std::string scientific = fmt::format("{:.{}e}", size, significant - 1);
  const size_t e = scientific.find('e');
  const int exponent = std::stoi(scientific.substr(e + 1));
  if (exponent >= 6 || exponent < -4) {
    std::string mantissa = scientific.substr(0, e);
    if (trim) mantissa = TrimZeros(mantissa);
    return fmt::format("{}{}×{}", sign, mantissa, FormatPowerOfTen(exponent));
  }
  std::string digits = fmt::format("{:.{}f}", size, std::max(0, significant - 1 - exponent));
  if (trim) digits = TrimZeros(digits);
  return sign + GroupThousands(digits);
}

}  // namespace

std::string FormatPowerOfTen(int exponent) {
  static constexpr const char* kRaised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = "10";
  for (const char c : std::to_string(exponent)) out += c == '-' ? "⁻" : kRaised[c - '0'];
  return out;
}

std::string FormatNumber(double value, int significant) {
  return FormatDigits(value, significant, false);
}

std::string FormatShort(double value, int significant) {
  return FormatDigits(value, significant, true);
}

std::string FormatFixed(double value, int decimals) {
  if (!std::isfinite(value)) return FormatDigits(value, 1, false);
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  return (value < 0 && !zero ? kMinus : "") + GroupThousands(digits);
}

RowFormat::RowFormat(const std::vector<double>& values, int significant)
    : significant_(significant) {
  double largest = 0.0;
  double smallest = std::numeric_limits<double>::infinity();
  for (const double v : values) {
    if (!std::isfinite(v) || v == 0.0) continue;
    largest = std::max(largest, std::abs(v));
    smallest = std::min(smallest, std::abs(v));
  }
  if (largest == 0.0 || largest >= 1e6 || largest < 1e-3 || largest / smallest > 1e3) return;
  const int exponent = static_cast<int>(std::floor(std::log10(largest)));
  decimals_ = std::max(0, significant - 1 - exponent);
}

std::string RowFormat::Format(double value) const {
  return decimals_ < 0 ? FormatNumber(value, significant_) : FormatFixed(value, decimals_);
}

std::string FormatRatio(double ratio) {
  if (!std::isfinite(ratio)) return FormatNumber(ratio);
  if (std::abs(ratio) < 0.01 && ratio != 0.0) return FormatNumber(ratio, 2);
  return FormatNumber(ratio, 3);
}

std::string FormatChange(double ratio) {
  if (!std::isfinite(ratio)) return FormatNumber(ratio);
  const double percent = 100.0 * (ratio - 1.0);
  const double size = std::abs(percent);
  const std::string digits = fmt::format("{:.{}f}", size, size < 9.95 ? 1 : 0);
  if (digits == "0.0") return "±0.0\u202f%";
  return fmt::format("{}{}\u202f%", percent < 0 ? kMinus : "+", GroupThousands(digits));
}

std::string FormatCount(long count) {
  return count < 0 ? kDash : GroupThousands(std::to_string(count));
}

std::string FormatDuration(double seconds) {
  if (!std::isfinite(seconds)) return kDash;
  if (seconds < 1e-3) return FormatNumber(seconds * 1e6, 3) + " µs";
  if (seconds < 1.0) return FormatNumber(seconds * 1e3, 3) + " ms";
  if (seconds < 120.0) return FormatNumber(seconds, 3) + " s";
  const long whole = std::lround(seconds);
  return fmt::format("{} min {} s", FormatCount(whole / 60), whole % 60);
}

}  // namespace kingpin::report
