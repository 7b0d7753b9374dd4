#include "optimisation/report/number_format.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kingpin::report {
namespace {

TEST(NumberFormat, KeepsSignificantDigits) {
  EXPECT_EQ(FormatNumber(3.14159), "3.142");
  EXPECT_EQ(FormatNumber(-0.0825), "−0.08250");
  EXPECT_EQ(FormatNumber(39518.2), "39\u202f518");
  EXPECT_EQ(FormatNumber(0.0), "0");
  EXPECT_EQ(FormatNumber(2.25e7), "2.250×10⁷");
  EXPECT_EQ(FormatNumber(3.5e-8, 2), "3.5×10⁻⁸");
}

TEST(NumberFormat, RoundingMayCarryIntoANewDigit) {
  EXPECT_EQ(FormatNumber(9.9999), "10.00");
  EXPECT_EQ(FormatNumber(999999.7), "1.000×10⁶");
}

TEST(NumberFormat, WhatIsNoNumberIsADash) {
  EXPECT_EQ(FormatNumber(std::numeric_limits<double>::quiet_NaN()), "–");
  EXPECT_EQ(FormatNumber(-std::numeric_limits<double>::infinity()), "−∞");
  EXPECT_EQ(FormatCount(-1), "–");
}

TEST(NumberFormat, ShortNumbersLoseTheirZeros) {
  EXPECT_EQ(FormatShort(0.2), "0.2");
  EXPECT_EQ(FormatShort(100.0), "100");
  EXPECT_EQ(FormatShort(20000.0), "20\u202f000");
}

TEST(NumberFormat, RatiosAndChanges) {
  EXPECT_EQ(FormatRatio(0.7338), "0.734");
  EXPECT_EQ(FormatRatio(113.29), "113");
  EXPECT_EQ(FormatChange(0.66), "−34\u202f%");
  EXPECT_EQ(FormatChange(1.031), "+3.1\u202f%");
  EXPECT_EQ(FormatChange(1.0), "±0.0\u202f%");
}

TEST(NumberFormat, ARowHasOneNumberOfDecimals) {
  const RowFormat row({1190.0, 917.53, 750.9});
  EXPECT_EQ(row.Format(1190.0), "1190");
  EXPECT_EQ(row.Format(917.53), "918");
  const RowFormat small({0.702, 0.0613});
  EXPECT_EQ(small.Format(0.0613), "0.0613");
  // Values too far apart for one number of decimals keep their digits.
  const RowFormat wide({1e5, 1e-3});
  EXPECT_EQ(wide.Format(1e-3), "0.001000");
}

TEST(NumberFormat, Durations) {
  EXPECT_EQ(FormatDuration(0.243), "243 ms");
  EXPECT_EQ(FormatDuration(15.8), "15.8 s");
  EXPECT_EQ(FormatDuration(310.0), "5 min 10 s");
}

}  // namespace
}  // namespace kingpin::report
