#include "core/signal/resample.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace kingpin::signal {
namespace {

/// A grid over [0, 1] whose intervals vary smoothly between 0.4 and 1.6 times their mean.
std::vector<double> MakeStretchedGrid(std::size_t intervals) {
  std::vector<double> time(intervals + 1);
  const double turn = 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i <= intervals; ++i) {
    const double u = double(i) / double(intervals);
    time[i] = u + 0.6 / turn * std::sin(turn * u);
  }
  time.back() = 1.0;
  return time;
}

double CalcLargestError(Interpolant interpolant, std::size_t intervals) {
  const auto time = MakeStretchedGrid(intervals);
  std::vector<double> value, probe;
  for (const double t : time) value.push_back(std::sin(20.0 * t));
  for (int i = 0; i <= 5000; ++i) probe.push_back(i / 5000.0);
  const auto result = MakeResampled(time, value, probe, interpolant);
  double error = 0.0;
  for (std::size_t i = 0; i < probe.size(); ++i) {
    error = std::max(error, std::abs(result[i] - std::sin(20.0 * probe[i])));
  }
  return error;
}

TEST(Resample, HasTheOrderOfTheInterpolant) {
  // Order 2; and 3 at the least for the cubic, whose largest error sits at the ends of the record.
  EXPECT_NEAR(std::log2(CalcLargestError(Interpolant::kLinear, 100) /
                        CalcLargestError(Interpolant::kLinear, 200)),
              2.0, 0.1);
  EXPECT_GT(std::log2(CalcLargestError(Interpolant::kCubic, 100) /
                      CalcLargestError(Interpolant::kCubic, 200)),
            2.9);
}

TEST(Resample, TheCubicIsExactForParabolasOnAnyGrid) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> gap(0.1, 2.0);
  std::vector<double> time = {-1.0}, value, probe;
  while (time.size() < 20) time.push_back(time.back() + gap(random));
  for (const double t : time) value.push_back(3.0 - 2.0 * t + 0.5 * t * t);
  for (double t = time.front(); t < time.back(); t += 0.01) probe.push_back(t);
  const auto result = MakeResampled(time, value, probe, Interpolant::kCubic);
  for (std::size_t i = 0; i < probe.size(); ++i) {
    EXPECT_NEAR(result[i], 3.0 - 2.0 * probe[i] + 0.5 * probe[i] * probe[i], 1e-10);
  }
}

TEST(Resample, GoesThroughTheSamplesAndHoldsTheEnds) {
  const std::vector<double> time = {0.0, 1.0, 1.5, 4.0}, value = {1.0, -2.0, 5.0, 0.0};
  const std::vector<double> probe = {-1.0, 0.0, 1.0, 1.5, 4.0, 9.0};
  const std::vector<double> expected = {1.0, 1.0, -2.0, 5.0, 0.0, 0.0};
  for (const Interpolant interpolant : {Interpolant::kLinear, Interpolant::kCubic}) {
    EXPECT_EQ(MakeResampled(time, value, probe, interpolant), expected);
  }
}

TEST(MakeUniform, LeavesAUniformRecordAsItIs) {
  std::vector<double> time, value;
  for (int i = 0; i < 334; ++i) {
    time.push_back(std::round(i * 1e6 / 300.0) / 1e6);  // 300 Hz, printed with six decimals
    value.push_back(i % 7);
  }
  const UniformRecord record = MakeUniform(time, value, Interpolant::kCubic);
  EXPECT_FALSE(record.resampled);
  EXPECT_EQ(record.value, value);
  EXPECT_NEAR(record.time_step, 1.0 / 300.0, 1e-8);
}

TEST(MakeUniform, KeepsTheShortStepsOfAVariableStepRecord) {
  std::vector<double> time, value;
  for (double t = 0.0; t < 1.0; t += (t > 0.4 && t < 0.5) ? 0.5e-3 : 2e-3) {
    time.push_back(t);
    value.push_back(std::exp(-1e5 * (t - 0.45) * (t - 0.45)));
  }
  const UniformRecord record = MakeUniform(time, value, Interpolant::kCubic);
  EXPECT_TRUE(record.resampled);
  EXPECT_LE(record.time_step, 0.5e-3 * (1 + 1e-9));
  // The nearest sample is at most half a step off the top, whose curvature is 2e5.
  EXPECT_NEAR(*std::max_element(record.value.begin(), record.value.end()), 1.0,
              0.5 * 2e5 * 0.25e-3 * 0.25e-3);
}

TEST(MakeUniform, TakesTheStepThatIsAskedFor) {
  const std::vector<double> time = {0.0, 0.3, 1.0}, value = {0.0, 0.3, 1.0};
  const UniformRecord record = MakeUniform(time, value, Interpolant::kLinear, 1e-3);
  EXPECT_DOUBLE_EQ(record.time_step, 1e-3);
  ASSERT_EQ(record.value.size(), 1001u);
  EXPECT_NEAR(record.value[777], 0.777, 1e-15);
}

}  // namespace
}  // namespace kingpin::signal
