#include "core/signal/spectrum.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace kingpin::signal {
namespace {

TEST(AmplitudeSpectrum, ASineOfWholePeriodsIsOneLineOfItsAmplitude) {
  std::vector<double> record(1000);
  for (std::size_t i = 0; i < record.size(); ++i) {
    record[i] = 0.5 + 3.0 * std::sin(2.0 * std::numbers::pi * 40.0 * 1e-3 * double(i) + 0.7);
  }
  const Spectrum spectrum = MakeAmplitudeSpectrum(record, 1e-3);
  ASSERT_EQ(spectrum.value.size(), 501u);
  EXPECT_DOUBLE_EQ(spectrum.frequency[40], 40.0);
  EXPECT_DOUBLE_EQ(spectrum.frequency.back(), 500.0);
  for (std::size_t k = 0; k < spectrum.value.size(); ++k) {
    EXPECT_NEAR(spectrum.value[k], k == 0 ? 0.5 : (k == 40 ? 3.0 : 0.0), 1e-12) << k;
  }
}

TEST(EnergySpectrum, HoldsTheEnergyOfTheRecord) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const std::size_t n : {512u, 777u}) {
    std::vector<double> record(n);
    double energy = 0.0;
    for (double& x : record) {
      x = normal(random);
      energy += 2e-3 * x * x;
    }
    const Spectrum spectrum = MakeEnergySpectrum(record, 2e-3);
    double sum = 0.0;
    for (const double value : spectrum.value) sum += value / (2e-3 * double(n));
    EXPECT_NEAR(sum, energy, 1e-12 * energy);
  }
}

}  // namespace
}  // namespace kingpin::signal
