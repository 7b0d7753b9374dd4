#include "core/math/pack.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/floating_point_traps.h"

namespace kingpin::math {
namespace {

using Lanes = Pack<double, 4, isa::Portable>;
using One = Pack<double, 1, isa::Portable>;

Lanes MakeLanes(double a, double b, double c, double d) {
  const double values[] = {a, b, c, d};
  return Lanes::Load(values);
}

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Across the ends of the polynomials at 0.1 and 0.25, and at large angles.
TEST(Pack, SineAndCosineMinusOneAreExactToRounding) {
  for (double x : {0.0, 1e-9, -0.03, 0.0999, 0.1001, -0.2, 0.26, -1.5, 3.0}) {
    Lanes s, c1;
    SinCosMinusOne(MakeLanes(x, 0.01, -x, 0.5 * x), s, c1);
    One one_s, one_c1;
    SinCosMinusOne(One(x), one_s, one_c1);
    EXPECT_NEAR(s.get(0), std::sin(x), 2 * kEpsilon * std::abs(x)) << x;
    EXPECT_NEAR(c1.get(0), std::cos(x) - 1.0, 2 * kEpsilon) << x;
    EXPECT_NEAR(one_s.get(0), std::sin(x), 2 * kEpsilon * std::abs(x)) << x;
    EXPECT_NEAR(one_c1.get(0), std::cos(x) - 1.0, 2 * kEpsilon) << x;
    EXPECT_EQ(s.get(2), -s.get(0));
    EXPECT_EQ(c1.get(2), c1.get(0));
  }
}

TEST(Pack, InverseSquareRootNearOneIsExactToRounding) {
  for (double u : {0.0, 1e-12, 0.003, 0.00499, 0.00501, -0.00499, -0.02, 0.5, 8.0}) {
    const Lanes y = InverseSqrtNearOne(MakeLanes(u, 1e-4, -0.001, 0.004));
    const double exact = 1.0 / std::sqrt(1.0 + u);
    EXPECT_NEAR(y.get(0), exact, 2 * kEpsilon * exact) << u;
    EXPECT_NEAR(InverseSqrtNearOne(One(u)).get(0), exact, 2 * kEpsilon * exact) << u;
  }
}

// A lane beyond a polynomial's range takes another formula; its neighbours must not notice.
TEST(Pack, LanesDoNotDependOnTheirNeighbours) {
  const WithoutTraps nan_is_the_subject;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Lanes s, c1, s_alone, c1_alone;
  SinCosMinusOne(MakeLanes(0.07, 0.2, 2.0, nan), s, c1);
  SinCosMinusOne(MakeLanes(0.07, 0.01, 0.02, 0.03), s_alone, c1_alone);
  EXPECT_EQ(s.get(0), s_alone.get(0));
  EXPECT_EQ(c1.get(0), c1_alone.get(0));
  EXPECT_TRUE(std::isnan(s.get(3)) && std::isnan(c1.get(3)));
  const Lanes y = InverseSqrtNearOne(MakeLanes(0.002, 0.4, nan, 0.0));
  EXPECT_EQ(y.get(0), InverseSqrtNearOne(Lanes(0.002)).get(0));
  EXPECT_EQ(y.get(3), 1.0);
  EXPECT_TRUE(std::isnan(y.get(2)));
}

}  // namespace
}  // namespace kingpin::math
