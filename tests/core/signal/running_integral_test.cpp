#include "core/signal/running_integral.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace kingpin::signal {
namespace {

// Of ∫ cos(5 t) dt over the middle half of [0, 1]: the ends, where the order is lower, cancel in
// the difference of two running integrals.
double CalcError(Quadrature rule, std::size_t intervals) {
  const double dt = 1.0 / static_cast<double>(intervals);
  std::vector<double> f(intervals + 1), c(intervals + 1);
  for (std::size_t i = 0; i <= intervals; ++i) f[i] = std::cos(5.0 * dt * double(i));
  UpdateRunningIntegral(rule, dt, f, c);
  const double exact = (std::sin(3.75) - std::sin(1.25)) / 5.0;
  return std::abs(c[3 * intervals / 4] - c[intervals / 4] - exact);
}

TEST(RunningIntegral, HasTheOrderOfItsRule) {
  // Halving the step divides the error by 2^order; the next term changes that by a percent at most.
  EXPECT_NEAR(CalcError(Quadrature::kTrapezoid, 200) / CalcError(Quadrature::kTrapezoid, 400), 4.0,
              0.01);
  EXPECT_NEAR(CalcError(Quadrature::kCubic, 200) / CalcError(Quadrature::kCubic, 400), 16.0, 0.1);
}

TEST(RunningIntegral, TheCubicRuleIsExactForACubic) {
  // f = t³ on steps of 1: ∫_1^2 = 15/4, ∫_2^3 = 65/4.
  const std::vector<double> f = {0.0, 1.0, 8.0, 27.0, 64.0};
  std::vector<double> c(5);
  UpdateRunningIntegral(Quadrature::kCubic, 1.0, f, c);
  EXPECT_DOUBLE_EQ(c[2] - c[1], 15.0 / 4.0);
  EXPECT_DOUBLE_EQ(c[3] - c[2], 65.0 / 4.0);
}

TEST(RunningIntegral, AConstantIsExactAtTheEndsToo) {
  for (const Quadrature rule : {Quadrature::kTrapezoid, Quadrature::kCubic}) {
    for (const std::size_t n : {1u, 2u, 3u, 4u, 7u}) {
      const std::vector<double> f(n, 3.0);
      std::vector<double> c(n);
      UpdateRunningIntegral(rule, 0.5, f, c);
      for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(c[i], 1.5 * double(i), 1e-14) << n;
    }
  }
}

TEST(RunningIntegral, TheAdjointIsTheTransposedMap) {
  // <y, C f> = <Cᵀ y, f> for random f and y.
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const Quadrature rule : {Quadrature::kTrapezoid, Quadrature::kCubic}) {
    for (const std::size_t n : {2u, 3u, 4u, 9u}) {
      std::vector<double> f(n), c(n), y(n), adjoint(n, 0.0);
      for (std::size_t i = 0; i < n; ++i) {
        f[i] = normal(random);
        y[i] = normal(random);
      }
      UpdateRunningIntegral(rule, 0.1, f, c);
      AddRunningIntegralAdjoint(rule, 0.1, y, adjoint);
      double left = 0.0, right = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        left += y[i] * c[i];
        right += adjoint[i] * f[i];
      }
      EXPECT_NEAR(left, right, 1e-14) << n;
    }
  }
}

}  // namespace
}  // namespace kingpin::signal
