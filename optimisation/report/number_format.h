#pragma once

#include <string>
#include <vector>

namespace kingpin::report {

/// Numbers for people: fixed notation from 1e-4 to 1e6 with thin gaps from 10 000 on, else
/// 1.23×10⁻⁵; a true minus sign; NaN is an en dash.
std::string FormatNumber(double value, int significant = 4);

/// As FormatNumber, without the zeros at the end: for bounds and other values that were typed.
std::string FormatShort(double value, int significant = 6);

/// Several numbers of one row with the same number of decimals: as many as the largest needs for
/// `significant` digits. Rows that span more than three decades fall back to FormatNumber.
class RowFormat {
 public:
  explicit RowFormat(const std::vector<double>& values, int significant = 4);
  std::string Format(double value) const;

 private:
  int significant_;
  int decimals_ = -1;  ///< -1: FormatNumber
};

/// Fixed decimals, with gaps and a true minus sign.
std::string FormatFixed(double value, int decimals);

/// A ratio: 0.734, 1.02, 12.8, 113.
std::string FormatRatio(double ratio);

/// A ratio as a signed change: 0.66 as −34 %, 1.004 as +0.4 %.
std::string FormatChange(double ratio);

/// 4332 as 4332, 12500 as 12 500; negative (unknown) as an en dash.
std::string FormatCount(long count);

/// 0.012 as 12 ms, 15.8 as 15.8 s, 310 as 5 min 10 s.
std::string FormatDuration(double seconds);

/// 10^n with raised digits.
std::string FormatPowerOfTen(int exponent);

}  // namespace kingpin::report
