#include "optimisation/measures/companions.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/io/error.h"

namespace kingpin::measures {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

TEST(VibrationStatistics, ASineHasItsClosedForms) {
  // 3 s of 10 Hz: mean of sin² is 1/2, of sin⁴ 3/8; every 1 s and 0.1 s holds whole periods, 0.125
  // s holds 1.25 of them, at best centred on a peak: mean 1/2 + sin(2.5 π)/(5 π).
  std::vector<double> record;
  for (int i = 0; i <= 3000; ++i) record.push_back(2.0 * std::sin(kTurn * 10.0 * 1e-3 * i));
  const auto statistics = CalcVibrationStatistics(record, 1e-3);
  EXPECT_NEAR(statistics.peak, 2.0, 1e-12);
  EXPECT_NEAR(statistics.rms, std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(statistics.rmq, 2.0 * std::pow(0.375, 0.25), 1e-6);
  EXPECT_NEAR(statistics.vdv, 2.0 * std::pow(0.375 * 3.0, 0.25), 1e-6);
  EXPECT_NEAR(statistics.mtvv, std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(statistics.mtvv_eighth, 2.0 * std::sqrt(0.5 + 1.0 / (5.0 * std::numbers::pi)), 2e-3);
  EXPECT_NEAR(statistics.crest_factor, std::sqrt(2.0), 1e-6);
}

TEST(VibrationStatistics, OfZerosAreZerosAndOfNaNAreNaN) {
  const auto zeros = CalcVibrationStatistics(std::vector<double>(10, 0.0), 0.1);
  EXPECT_EQ(zeros.crest_factor, 0.0);
  EXPECT_EQ(zeros.vdv, 0.0);
  const std::vector<double> bad = {0.0, std::numeric_limits<double>::quiet_NaN(), 1.0};
  EXPECT_TRUE(std::isnan(CalcVibrationStatistics(bad, 0.1).rms));
}

TEST(Extremes, AHalfSineHasItsPeakItsTimeAndItsImpulse) {
  // −3 kN over 20 ms from 0.1 s: impulse −3000 · 2/π · 0.02.
  std::vector<double> record;
  for (int i = 0; i <= 5000; ++i) {
    const double t = 1e-4 * i;
    record.push_back(t > 0.1 && t < 0.12 ? -3000.0 * std::sin(std::numbers::pi * (t - 0.1) / 0.02)
                                         : 0.0);
  }
  const auto extremes = CalcExtremes(record, 1e-4);
  EXPECT_NEAR(extremes.peak, 3000.0, 1e-9);
  EXPECT_NEAR(extremes.time_of_peak, 0.11, 1e-12);
  EXPECT_EQ(extremes.maximum, 0.0);
  EXPECT_NEAR(extremes.minimum, -3000.0, 1e-9);
  EXPECT_NEAR(extremes.peak_to_peak, 3000.0, 1e-9);
  // The kinks at the pulse's ends cost (π dt/d)²/12 of the impulse at most.
  EXPECT_NEAR(extremes.impulse, -3000.0 * 2.0 / std::numbers::pi * 0.02, 38.2 * 2.1e-5);
}

TEST(Companions, AbsentRecordsHaveNoExtremes) {
  const std::vector<double> torque = {0.0, 1.0, -4.0, 0.0};
  const auto companions = CalcCompanions(
      {.rim_acceleration = {}, .torsion_torque = torque, .rack_force = {}, .tie_rod_force = {}},
      0.5);
  ASSERT_TRUE(companions.torsion_torque.has_value());
  EXPECT_EQ(companions.torsion_torque->peak, 4.0);
  EXPECT_EQ(companions.torsion_torque->time_of_peak, 1.0);
  EXPECT_FALSE(companions.rack_force.has_value());
}

TEST(Companions, TheShortWindowSeesTheDecayThatTheLongOneHides) {
  // e^{−λt} from 0.3 s: energy falls to a quarter in ln 4/(2 λ); the window adds its rise before.
  const double decay = 8.0;
  std::vector<double> record;
  for (int i = 0; i <= 10000; ++i) {
    const double t = 1e-4 * i;
    record.push_back(t < 0.3 ? 0.0 : std::exp(-decay * (t - 0.3)));
  }
  const auto companions = CalcCompanions(
      {.rim_acceleration = record, .torsion_torque = {}, .rack_force = {}, .tie_rod_force = {}},
      1e-4);
  // Last crossing at 0.3 + Δ/2 + ln 4/(2λ); first where 1 − e^{−2λs} is a quarter of
  // 1 − e^{−2λΔ}, s after the window's front reached 0.3.
  const double window = 0.05;
  const double rise =
      -std::log(1.0 - 0.25 * (1.0 - std::exp(-2.0 * decay * window))) / (2.0 * decay);
  EXPECT_NEAR(companions.short_decay_time, window + std::log(4.0) / (2.0 * decay) - rise, 1e-4);
}

TEST(Companions, WithoutWeightingTheWeightedNumbersAreThePlainOnes) {
  std::vector<double> record;
  for (int i = 0; i <= 1000; ++i) record.push_back(std::sin(0.1 * i) * std::exp(-0.005 * i));
  const auto companions = CalcCompanions(
      {.rim_acceleration = record, .torsion_torque = {}, .rack_force = {}, .tie_rod_force = {}},
      1e-3, {.weighting = signal::Weighting::Named("none")});
  EXPECT_NEAR(companions.weighted.rms, companions.unweighted.rms, 1e-14);
  EXPECT_NEAR(companions.weighted.vdv, companions.unweighted.vdv, 1e-14);
}

TEST(RoadFeelGain, IsTheMeanOfTheBrokenLine) {
  // |H| = 1 + f: mean over 0..10 Hz is 6, whatever the points.
  const std::vector<double> f = {0.0, 0.3, 4.0, 9.0, 30.0}, h = {1.0, 1.3, 5.0, 10.0, 31.0};
  EXPECT_NEAR(CalcRoadFeelGain(f, h), 6.0, 1e-14);
  EXPECT_NEAR(CalcRoadFeelGain(f, h, 2.0, 3.0), 3.5, 1e-14);
  // Below the first point its value is held.
  const std::vector<double> late = {1.0, 20.0}, flat = {2.0, 2.0};
  EXPECT_NEAR(CalcRoadFeelGain(late, flat), 2.0, 1e-14);
}

TEST(RoadFeelGain, RefusesPointsThatDoNotCoverTheBand) {
  const std::vector<double> f = {0.0, 5.0}, h = {1.0, 1.0};
  try {
    CalcRoadFeelGain(f, h);
    FAIL();
  } catch (const io::InputError& error) {
    EXPECT_STREQ(error.what(),
                 "road feel: found 2 frequencies ending at 5 Hz, expected increasing frequencies "
                 "that cover 0 to 10 Hz");
  }
  EXPECT_THROW(CalcRoadFeelGain({}, {}), io::InputError);
}

}  // namespace
}  // namespace kingpin::measures
