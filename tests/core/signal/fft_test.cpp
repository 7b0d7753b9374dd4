#include "core/signal/fft.h"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace kingpin::signal {
namespace {

using Complex = std::complex<double>;

std::vector<double> MakeNoise(std::size_t size, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> record(size);
  for (double& x : record) x = normal(random);
  return record;
}

// The definition, with the phase reduced modulo n so that it stays exact.
std::vector<Complex> CalcBySums(const std::vector<double>& record) {
  const std::size_t n = record.size();
  std::vector<Complex> spectrum(n / 2 + 1);
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      const double phase = -2.0 * std::numbers::pi * static_cast<double>(i * k % n) / double(n);
      spectrum[k] += record[i] * std::polar(1.0, phase);
    }
  }
  return spectrum;
}

// Lengths: trivial ones, powers, odd ones, 4 | n, one with the factors 7, 11 and 13, and primes and
// products with a prime that go through the chirp.
class RealFftOfLength : public testing::TestWithParam<std::size_t> {};

TEST_P(RealFftOfLength, EqualsTheDefiningSums) {
  const auto record = MakeNoise(GetParam(), 1);
  RealFft fft(record.size());
  std::vector<Complex> spectrum(fft.spectrum_size());
  fft.UpdateSpectrum(record, spectrum);
  const auto expected = CalcBySums(record);
  ASSERT_EQ(spectrum.size(), expected.size());
  // Rounding of sums of n terms of size one, times a few.
  const double tolerance = 2e-15 * (10.0 + static_cast<double>(record.size()));
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(std::abs(spectrum[k] - expected[k]), 0.0, tolerance) << "line " << k;
  }
}

TEST_P(RealFftOfLength, TheInverseGivesTheRecordBack) {
  const auto record = MakeNoise(GetParam(), 2);
  RealFft fft(record.size());
  std::vector<Complex> spectrum(fft.spectrum_size());
  std::vector<double> back(record.size());
  fft.UpdateSpectrum(record, spectrum);
  fft.UpdateRecord(spectrum, back);
  for (std::size_t i = 0; i < record.size(); ++i) EXPECT_NEAR(back[i], record[i], 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Lengths, RealFftOfLength,
                         testing::Values(1, 2, 3, 4, 5, 6, 7, 8, 12, 30, 61, 100, 122, 127, 244,
                                         1000, 1001, 1009));

TEST(RealFft, IgnoresThePartsOfTheSpectrumThatNoRealRecordHas) {
  for (const std::size_t n : {8u, 10u, 122u}) {
    RealFft fft(n);
    std::vector<Complex> spectrum(fft.spectrum_size(), Complex(1.0));
    std::vector<double> clean(n), odd(n);
    fft.UpdateRecord(spectrum, clean);
    spectrum.front() += Complex(0.0, 3.0);
    spectrum.back() += Complex(0.0, 5.0);
    fft.UpdateRecord(spectrum, odd);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(odd[i], clean[i], 1e-14) << n;
  }
}

TEST(RealFft, RefusesSpansOfAWrongSize) {
  EXPECT_THROW(RealFft(0), std::invalid_argument);
  RealFft fft(8);
  std::vector<double> record(7);
  std::vector<Complex> spectrum(5);
  EXPECT_THROW(fft.UpdateSpectrum(record, spectrum), std::invalid_argument);
  EXPECT_THROW(fft.UpdateRecord(spectrum, record), std::invalid_argument);
}

TEST(CalcFastLength, IsTheNextMultipleOfFourWithSmallFactors) {
  EXPECT_EQ(CalcFastLength(1), 4u);
  EXPECT_EQ(CalcFastLength(1000), 1000u);
  EXPECT_EQ(CalcFastLength(1001), 1024u);
  EXPECT_EQ(CalcFastLength(7), 8u);
}

}  // namespace
}  // namespace kingpin::signal
