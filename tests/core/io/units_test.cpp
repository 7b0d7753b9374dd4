#include "core/io/units.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "tests/floating_point_traps.h"

namespace kingpin::io {
namespace {

constexpr double kPi = std::numbers::pi;

double Parse(std::string_view text, std::string_view unit) {
  return ParseQuantity(text, ParseUnit(unit));
}

std::string Message(std::string_view text, std::string_view unit) {
  try {
    Parse(text, unit);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// Exact equality is meant: a value with a decimal prefix must be the double its SI digits give, as
// the conversion is one multiplication or division by an exact power of ten.
TEST(Units, DecimalPrefixesLoseNoDigit) {
  EXPECT_EQ(Parse("20 ms", "s"), 0.02);
  EXPECT_EQ(Parse("132.5 mm", "m"), 0.1325);
  EXPECT_EQ(Parse("-25mm", "m"), -0.025);
  EXPECT_EQ(Parse("3 kN", "N"), 3000.0);
  EXPECT_EQ(Parse("0.1 MN/m", "N/m"), 1e5);
  EXPECT_EQ(Parse("300 g", "kg"), 0.3);
  EXPECT_EQ(Parse("2.2 t", "kg"), 2200.0);
  EXPECT_EQ(Parse("8 %", "1"), 0.08);
  EXPECT_EQ(Parse("25 N/mm", "N/m"), 25000.0);
  EXPECT_EQ(Parse("207 GPa", "Pa"), 207e9);
  EXPECT_EQ(Parse("2.4 bar", "Pa"), 240000.0);
  EXPECT_EQ(Parse("12 cm^2", "m^2"), 0.0012);
  EXPECT_EQ(Parse("7 1/ms", "1/s"), 7000.0);
}

TEST(Units, QuantitiesOfACarAreRead) {
  EXPECT_DOUBLE_EQ(Parse("35 km/h", "m/s"), 35 / 3.6);
  EXPECT_DOUBLE_EQ(Parse("35kph", "m/s"), 35 / 3.6);
  EXPECT_DOUBLE_EQ(Parse("60 mph", "m/s"), 26.8224);
  EXPECT_DOUBLE_EQ(Parse("4.5e4 N*m/rad", "N m/rad"), 4.5e4);
  EXPECT_DOUBLE_EQ(Parse("60 N m/rad", "N m/rad"), 60.0);
  EXPECT_DOUBLE_EQ(Parse("1.05 N m/deg", "N m/rad"), 1.05 * 180 / kPi);
  EXPECT_DOUBLE_EQ(Parse("4.5e7 Nmm/rad", "N m/rad"), 4.5e4);
  EXPECT_DOUBLE_EQ(Parse("5 Nms/rad", "N m s/rad"), 5.0);
  EXPECT_DOUBLE_EQ(Parse("0.57 kg m^2", "kg m^2"), 0.57);
  EXPECT_DOUBLE_EQ(Parse("0.57 kg m2", "kg m^2"), 0.57);
  EXPECT_DOUBLE_EQ(Parse("0.57 kg\u00b7m\u00b2", "kg m^2"), 0.57);
  EXPECT_DOUBLE_EQ(Parse("12 l/min", "m^3/s"), 12e-3 / 60);
  EXPECT_DOUBLE_EQ(Parse("60 rpm", "rad/s"), 2 * kPi);
  EXPECT_DOUBLE_EQ(Parse("180 deg", "rad"), kPi);
  EXPECT_DOUBLE_EQ(Parse("180\u00b0", "rad"), kPi);
  EXPECT_DOUBLE_EQ(Parse("50 mm/rev", "m/rad"), 0.05 / (2 * kPi));
  EXPECT_DOUBLE_EQ(Parse("3 1/s", "1/s"), 3.0);
  EXPECT_DOUBLE_EQ(Parse("3 s^-1", "1/s"), 3.0);
  EXPECT_DOUBLE_EQ(Parse("2 m/s/s", "m/s^2"), 2.0);
  EXPECT_DOUBLE_EQ(Parse("2 N/(m s)", "N/(m s)"), 2.0);
  EXPECT_DOUBLE_EQ(Parse("1.5 mm/s^1.75", "m/s^1.75"), 0.0015);
  EXPECT_DOUBLE_EQ(Parse("20 mohm", "ohm"), 0.02);
  EXPECT_DOUBLE_EQ(Parse("0.05 N m/A", "N m/A"), 0.05);
  EXPECT_DOUBLE_EQ(Parse("32 psi", "Pa"), 32 * 6894.757293168361);
  EXPECT_DOUBLE_EQ(Parse("5 \u00b5m", "m"), 5e-6);
  EXPECT_DOUBLE_EQ(Parse("+3.5", "m"), 3.5);
  EXPECT_DOUBLE_EQ(Parse("  .5e1  ", "m"), 5.0);
  EXPECT_DOUBLE_EQ(Parse("\u22123 m", "m"), -3.0);
}

TEST(Units, RadiansAndCyclesMayBeLeftOutButNotAdded) {
  EXPECT_EQ(Parse("60 N m", "N m/rad"), 60.0);
  EXPECT_EQ(Parse("2 1/s", "rad/s"), 2.0);
  EXPECT_EQ(Parse("2 1/s", "Hz"), 2.0);
  EXPECT_EQ(
      Message("60 N m/rad", "N m"),
      "found '60 N m/rad' (a torsional stiffness), expected a torque in N m, such as '6 N m'");
  EXPECT_EQ(Message("2 rad/s", "Hz"),
            "found '2 rad/s' (an angular speed), expected a frequency in Hz, such as '45 Hz'");
  EXPECT_EQ(Message("2 Hz", "rad/s"),
            "found '2 Hz' (a frequency), expected an angular speed in rad/s, such as '2 rad/s' or "
            "'60 rpm'; 1 Hz is 6.2832 rad/s");
  EXPECT_NE(Message("3 deg", "1"), "");
  EXPECT_NE(Message("2 Hz", "1/s"), "");
}

TEST(Units, WhatIsNoQuantityHasAMessage) {
  EXPECT_EQ(Message("", "m"),
            "found nothing, expected a length in m, such as '0.35 m' or '350 mm'");
  EXPECT_EQ(Message("nan", "m"), "found 'nan', expected a finite number");
  EXPECT_EQ(Message("-.inf m", "m"), "found '-.inf m', expected a finite number");
  EXPECT_EQ(Message("1e400 m", "m"),
            "found '1e400 m', expected a number between 1e-308 and 1e308 in size, or 0");
  EXPECT_EQ(Message("1 mm mm", "m"),
            "found '1 mm mm' (an area), expected a length in m, such as '0.35 m' or '350 mm'");
  for (const char* text :
       {"m",    "--3 m",  "+-3 m", "3 m^",  "3 m^x",  "3 m^0.3",   "3 m^99", "3 (m",
        "3 m)", "3 m//s", "3 /s",  "3 m *", "3 ()",   "3 m^2^2",   "0x10 m", "1_000 m",
        "3 m,", "3; m",   "3 1/2", "1 2 m", "3 m**2", "3 mm m/s s"}) {
    EXPECT_NE(Message(text, "m"), "") << text;
  }
}

TEST(Units, DeepParenthesesEndInAMessage) {
  EXPECT_NE(Message("3 " + std::string(60, '(') + "m", "m"), "");
  EXPECT_NE(Message("3 " + std::string(5000, '('), "m"), "");
}

// Property: any finite double in any unit reads back. For SI units exactly, as the digits are the
// shortest that do; elsewhere within the two roundings of value · numerator / denominator.
TEST(Units, FormattedQuantitiesReadBack) {
  const WithoutTraps signalling_nans_are_drawn;
  const std::vector<std::string> units = {
      "m",  "mm",      "km",      "kg",   "g",   "s",   "ms",  "rad", "deg",   "rev",    "N",
      "kN", "N m/rad", "N m/deg", "km/h", "rpm", "Hz",  "kHz", "bar", "l/min", "kg m^2", "m/s^1.75",
      "%",  "1/s",     "N s/m",   "N/mm", "psi", "lbf", "mph", "in",  "A",     "mohm"};
  std::mt19937_64 random(20110317);
  for (int i = 0; i < 20000; ++i) {
    const Unit unit = ParseUnit(units[random() % units.size()]);
    Unit expected;
    expected.dimension = unit.dimension;
    double value = 0.0;
    do {
      value = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
      // Away from the ends of the range, where the conversion itself overflows.
    } while (!(std::abs(value) < 1e290 && std::abs(value) > 1e-290));
    const std::string text = fmt::format("{} {}", FormatNumber(value), unit.text);
    const double read = ParseQuantity(text, expected);
    if (unit.is_si()) {
      EXPECT_EQ(read, value) << text;
    } else {
      EXPECT_EQ(read, unit.ToSi(value)) << text;
      EXPECT_NEAR(unit.FromSi(read) / value, 1.0, 1e-15) << text;
    }
  }
}

TEST(Units, FormattingAnSiValueReadsBackExactly) {
  const WithoutTraps signalling_nans_are_drawn;
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    const double value = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
    if (!std::isnormal(value)) continue;
    EXPECT_EQ(Parse(FormatQuantity(value, "N m/rad"), "N m/rad"), value);
  }
}

}  // namespace
}  // namespace kingpin::io
