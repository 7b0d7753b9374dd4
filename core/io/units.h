#pragma once

#include <array>
#include <string>
#include <string_view>

/// Quantities as users write them: a number, which is SI, or a number with a unit.
///
///     1250            35 km/h          4.5e4 N*m/rad      60 N m/rad       20 ms
///     1.05 N m/deg    0.57 kg m^2      8 %                3 kN             12 l/min
///
/// A unit is a product of symbols, each with an exponent: `N m`, `N*m`, `N·m`, `kg m^2`, `kg m²`,
/// `m/s2`, `1/s`, `m s^-1`, `m/s^1.75`. `/` divides by the one symbol or parenthesis that follows;
/// `N/m s` could mean two things and is an error (write `N s/m` or `N/(m s)`).
/// Prefixes u (or µ), m, c, d, k, M and G go before m, g, s, N, Nm, Pa, J, W, Hz, bar, l, A, V,
/// ohm, rad. Symbols without a prefix: kg, t, min, h, deg (°), rev, rpm, kph, mph, in, ft, lb, lbf,
/// psi,
/// %, Nmm, Ns, Nms.
///
/// **Angles.** The radian and the cycle are carried as dimensions of their own, so that 1.05 N
/// m/deg and 60 N m/rad are told apart from a torque, and Hz from rad/s. Rule: they **may be left
/// out, never added**. Where N m/rad is expected, `60 N m` is accepted and means per radian; `1/s`
/// is accepted for rad/s and for Hz. Where a torque is expected, `60 N m/rad` is an error; where
/// rad/s is expected, `5 Hz` is an error (it would be off by 2π), and so is `5 rad/s` for a
/// frequency.
namespace kingpin::io {

/// Standard gravity, exact by definition (ISO 80000-3) [m/s^2].
inline constexpr double kStandardGravity = 9.80665;

/// Exponents in quarters (so that the vibration dose's m/s^1.75 is exact) of metre, kilogram,
/// second, ampere, radian and cycle.
struct Dimension {
  enum Base { kLength, kMass, kTime, kCurrent, kAngle, kCycle, kCount };
  std::array<int, kCount> quarters{};

  friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// A unit and how to reach SI: value · numerator / denominator. Kept as a fraction so that `20 ms`
/// is the very double 0.02, and not the rounded product of 20 and the rounded 0.001.
struct Unit {
  std::string text;  ///< as written
  Dimension dimension;
  double numerator = 1.0;
  double denominator = 1.0;

  double ToSi(double value) const { return value * numerator / denominator; }
  double FromSi(double value) const { return value * denominator / numerator; }
  bool is_si() const { return numerator == 1.0 && denominator == 1.0; }
};

/// Reads a unit such as `N m/rad`; empty, `1` and `-` are dimensionless.
/// Throws InputError (without file and line) for unknown symbols, with the nearest one suggested.
Unit ParseUnit(std::string_view text);

/// Whether a value in `found` may stand where `expected` is asked: equal but for radians and cycles
/// left out.
bool IsUsableAs(const Dimension& found, const Dimension& expected);

/// Reads a finite number without a unit, independent of the locale. Throws InputError (without file
/// and line) for anything else: text after the number, NaN, infinity, a decimal comma, overflow.
double ParseNumber(std::string_view text);

/// Reads a quantity and gives its value in SI. A bare number is SI. Throws InputError (without file
/// and line) as ParseNumber and ParseUnit do, and when the dimension is not `expected`'s.
double ParseQuantity(std::string_view text, const Unit& expected);

/// What a quantity of this unit is, for messages: `a speed in m/s, such as '35 km/h'`.
std::string DescribeQuantity(const Unit& unit);

/// Shortest text that reads back as the same double.
std::string FormatNumber(double value);

/// `FormatNumber(value) + unit`, e.g. `0.02 s`; no unit for a dimensionless one.
std::string FormatQuantity(double value, std::string_view unit);

}  // namespace kingpin::io
