#include "optimisation/report/ticks.h"

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kingpin::report {
namespace {

TEST(Ticks, AreRoundInsideTheRangeAndEvenlySpaced) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-9.0, 9.0);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int n = 0; n < 2000; ++n) {
    const double size = std::pow(10.0, exponent(random));
    const double low = size * share(random);
    const double high = low + size * (0.01 + std::abs(share(random)));
    const std::vector<double> ticks = MakeTicks(low, high, 6);
    ASSERT_GE(ticks.size(), 3u) << low << " " << high;
    ASSERT_LE(ticks.size(), 11u) << low << " " << high;
    const double step = ticks[1] - ticks[0];
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    // The difference of two ticks loses digits when they are large against the step.
    const double slack = 1e-12 * std::max(std::abs(low), std::abs(high)) / step + 1e-9;
    EXPECT_TRUE(std::abs(mantissa - 1) < slack * 10 || std::abs(mantissa - 2) < slack * 10 ||
                std::abs(mantissa - 5) < slack * 10 || std::abs(mantissa - 10) < slack * 10)
        << mantissa;
    for (size_t i = 0; i < ticks.size(); ++i) {
      EXPECT_GE(ticks[i], low);
      EXPECT_LE(ticks[i], high);
      if (i > 0) {
        EXPECT_NEAR(ticks[i] - ticks[i - 1], step, slack * step);
      }
    }
  }
}

TEST(Ticks, LabelsOfDifferentTicksDiffer) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> exponent(-9.0, 9.0);
  for (int n = 0; n < 1000; ++n) {
    const double size = std::pow(10.0, exponent(random));
    const std::vector<double> ticks = MakeTicks(-0.37 * size, 0.81 * size, 6);
    const TickLabels labels = MakeTickLabels(ticks);
    ASSERT_EQ(labels.texts.size(), ticks.size());
    EXPECT_EQ(std::set<std::string>(labels.texts.begin(), labels.texts.end()).size(), ticks.size());
    EXPECT_EQ(labels.exponent % 3, 0);
    for (const std::string& text : labels.texts) EXPECT_NE(text, "−0.0");
  }
}

TEST(Ticks, LargeValuesMoveTheirPowerIntoTheTitle) {
  const TickLabels labels = MakeTickLabels({0.0, 1e7, 2e7});
  EXPECT_EQ(labels.exponent, 6);
  EXPECT_EQ(labels.texts, (std::vector<std::string>{"0", "10", "20"}));
}

TEST(Ticks, LogarithmicTicksStayInRange) {
  for (const double high : {2.0, 30.0, 1e3, 1e7, 1e30}) {
    const std::vector<double> ticks = MakeLogTicks(0.5, high, 5);
    EXPECT_GE(ticks.size(), 2u) << high;
    EXPECT_LE(ticks.size(), 12u) << high;
    for (const double tick : ticks) {
      EXPECT_GE(tick, 0.5 * (1 - 1e-6));
      EXPECT_LE(tick, high * (1 + 1e-6));
    }
  }
  EXPECT_EQ(MakeLogTickLabels({0.01, 1.0, 100.0, 1e6}),
            (std::vector<std::string>{"0.01", "1", "100", "10⁶"}));
}

TEST(Ticks, ImpossibleRangesGiveOneTick) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(MakeTicks(1.0, 1.0, 5).size(), 1u);
  EXPECT_EQ(MakeTicks(nan, 1.0, 5).size(), 1u);
  EXPECT_EQ(MakeTicks(-1.7e308, 1.7e308, 5).size(), 1u);
  EXPECT_EQ(MakeLogTicks(-1.0, 1.0, 5).size(), 1u);
  EXPECT_LE(MakeTicks(1e16, 1e16 + 2.0, 5).size(), 5u);
}

}  // namespace
}  // namespace kingpin::report
