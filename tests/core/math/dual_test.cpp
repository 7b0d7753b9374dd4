#include "core/math/dual.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kingpin::math {
namespace {

using D = Dual<double, 2>;

TEST(Dual, CarriesTheDerivativesOfEveryOperation) {
  const D x = D::MakeVariable(0.7, 0), y = D::MakeVariable(-1.3, 1);
  const auto expect = [](const D& r, double v, double dx, double dy) {
    EXPECT_NEAR(r.v, v, 1e-15);
    EXPECT_NEAR(r.d[0], dx, 1e-15);
    EXPECT_NEAR(r.d[1], dy, 1e-15);
  };
  expect(x + y, -0.6, 1, 1);
  expect(x - y, 2.0, 1, -1);
  expect(x * y, -0.91, -1.3, 0.7);
  expect(x / y, 0.7 / -1.3, 1 / -1.3, -0.7 / 1.69);
  expect(2.0 * x + 1.0, 2.4, 2, 0);
  expect(1.0 - x, 0.3, -1, 0);
  expect(1.0 / x, 1 / 0.7, -1 / 0.49, 0);
  expect(x / 2.0, 0.35, 0.5, 0);
  expect(-y, 1.3, 0, -1);
  expect(Sqrt(x), std::sqrt(0.7), 0.5 / std::sqrt(0.7), 0);
  expect(Exp(y), std::exp(-1.3), 0, std::exp(-1.3));
  expect(Abs(y), 1.3, 0, -1);
  expect(Min(x, y), -1.3, 0, 1);
  expect(Max(x, y), 0.7, 1, 0);
  expect(Select(x < y, x, y), -1.3, 0, 1);
  D s, c;
  SinCos(x, s, c);
  expect(s, std::sin(0.7), std::cos(0.7), 0);
  expect(c, std::cos(0.7), -std::sin(0.7), 0);
  EXPECT_EQ(Value(x), 0.7);
}

TEST(Dual, AConstantHasNoDerivatives) {
  const D one = 1.0;
  EXPECT_EQ(one.d[0], 0);
  EXPECT_EQ(one.d[1], 0);
}

}  // namespace
}  // namespace kingpin::math
