#include "core/math/cubic_spline.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/math/dual.h"
#include "core/math/pack.h"
#include "tests/floating_point_traps.h"

namespace kingpin::math {
namespace {

constexpr int kNodes = 7;
constexpr std::array<double, kNodes> kX = {-0.9, -0.5, -0.35, 0.05, 0.4, 0.6, 1.1};
constexpr std::array<double, kNodes> kF = {-2.1, -0.7, -0.6, 0.1, 0.15, 1.9, 2.0};

template <class S>
using Spline = CubicSpline<S, 16>;

Spline<double> MakeNatural() { return Spline<double>::MakeNatural(kNodes, kX.data(), kF.data()); }
Spline<double> MakeMonotone() { return Spline<double>::MakeMonotone(kNodes, kX.data(), kF.data()); }

// The natural spline from its definition: all 4 (n − 1) coefficients in powers of x − x_k from one
// dense system.
double EvaluateDense(double x) {
  constexpr int kPieces = kNodes - 1;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(4 * kPieces, 4 * kPieces);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(4 * kPieces);
  int row = 0;
  for (int k = 0; k < kPieces; ++k) {
    const double h = kX[static_cast<size_t>(k) + 1] - kX[static_cast<size_t>(k)];
    a(row, 4 * k) = 1;
    b(row++) = kF[static_cast<size_t>(k)];
    for (int p = 0; p < 4; ++p) a(row, 4 * k + p) = std::pow(h, p);
    b(row++) = kF[static_cast<size_t>(k) + 1];
    if (k + 1 == kPieces) break;
    for (int p = 1; p < 4; ++p) a(row, 4 * k + p) = p * std::pow(h, p - 1);
    a(row++, 4 * (k + 1) + 1) = -1;
    for (int p = 2; p < 4; ++p) a(row, 4 * k + p) = p * (p - 1) * std::pow(h, p - 2);
    a(row++, 4 * (k + 1) + 2) = -2;
  }
  const double last = kX[kNodes - 1] - kX[kNodes - 2];
  a(row++, 2) = 2;
  a(row, 4 * (kPieces - 1) + 2) = 2;
  a(row, 4 * (kPieces - 1) + 3) = 6 * last;
  const Eigen::VectorXd c = a.fullPivLu().solve(b);
  int k = 0;
  while (k + 1 < kPieces && x > kX[static_cast<size_t>(k) + 1]) ++k;
  const double t = x - kX[static_cast<size_t>(k)];
  return c(4 * k) + t * (c(4 * k + 1) + t * (c(4 * k + 2) + t * c(4 * k + 3)));
}

TEST(NaturalSpline, EqualsTheDenseSolutionOfItsDefinition) {
  const auto spline = MakeNatural();
  for (double x = kX.front(); x <= kX.back(); x += 0.0137) {
    EXPECT_NEAR(spline(x), EvaluateDense(x), 1e-12) << x;
  }
}

TEST(NaturalSpline, HasContinuousFirstAndSecondDerivatives) {
  const auto spline = MakeNatural();
  for (double x : kX) {
    // The slope is exact, so only its own change over 2e-7 (curvature about 50) remains: 1e-5.
    EXPECT_NEAR(spline.CalcSlope(x - 1e-9), spline.CalcSlope(x + 1e-9), 1e-6);
    const double e = 1e-5;
    const double below = (spline.CalcSlope(x - e) - spline.CalcSlope(x - 2 * e)) / e;
    const double above = (spline.CalcSlope(x + 2 * e) - spline.CalcSlope(x + e)) / e;
    // Third derivatives reach 1e3: curvature moves by 3e-2 over 3e-5.
    EXPECT_NEAR(below, above, 5e-2) << x;
  }
}

TEST(NaturalSpline, GoesOnLinearlyOutsideWithZeroCurvatureAtItsEnds) {
  const auto spline = MakeNatural();
  for (double end : {kX.front(), kX.back()}) {
    const double sign = end < 0 ? -1 : 1;
    const double slope = spline.CalcSlope(end);
    EXPECT_NEAR(spline(end + sign * 3), spline(end) + sign * 3 * slope, 1e-12);
    EXPECT_NEAR(spline.CalcSlope(end + sign * 100), slope, 1e-13);
    EXPECT_NEAR((spline.CalcSlope(end) - spline.CalcSlope(end - sign * 1e-6)) / 1e-6, 0, 1e-2);
  }
}

TEST(MonotoneSpline, StaysBetweenItsNodesAndNeverTurns) {
  const auto spline = MakeMonotone();
  double before = spline(-3.0);
  for (double x = -3; x <= 3; x += 1e-3) {
    EXPECT_GE(spline(x), before - 1e-14) << x;
    before = spline(x);
  }
  for (size_t k = 0; k < kX.size(); ++k) EXPECT_NEAR(spline(kX[k]), kF[k], 1e-14);
}

TEST(MonotoneSpline, HasZeroSlopeAtALocalExtremeOfTheNodes) {
  const std::array<double, 4> x = {0, 1, 2, 3}, f = {0, 2, 1, 1};
  const auto spline = Spline<double>::MakeMonotone(4, x.data(), f.data());
  EXPECT_EQ(spline.CalcSlope(1.0), 0);
  EXPECT_EQ(spline.CalcSlope(2.0), 0);
  for (double t = 2; t <= 3; t += 0.1) EXPECT_DOUBLE_EQ(spline(t), 1.0);
}

TEST(Spline, RepeatsAStraightLineExactly) {
  const std::array<double, 3> x = {-1, 0, 2}, f = {-3, 0, 6};
  for (const auto& spline : {Spline<double>::MakeNatural(3, x.data(), f.data()),
                             Spline<double>::MakeMonotone(3, x.data(), f.data())}) {
    for (double t : {-5.0, -0.3, 0.0, 0.7, 9.0}) EXPECT_NEAR(spline(t), 3 * t, 1e-14);
  }
}

TEST(Spline, WithoutNodesIsZero) {
  const Spline<double> none;
  EXPECT_EQ(none(1.0), 0);
  EXPECT_EQ(none.CalcSlope(1.0), 0);
  EXPECT_EQ(none.CalcIntegral(1.0), 0);
}

TEST(Spline, DerivativeInTheArgumentIsExactAlsoAtNodesAndOutside) {
  using D = Dual<double, 1>;
  for (const auto& spline : {MakeNatural(), MakeMonotone()}) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> any(-2, 2);
    for (int i = 0; i < 200; ++i) {
      const double x = i < kNodes ? kX[static_cast<size_t>(i)] : any(random);
      const D value = spline(D::MakeVariable(x, 0));
      EXPECT_NEAR(value.v, spline(x), 1e-14);
      EXPECT_NEAR(value.d[0], spline.CalcSlope(x), 1e-12) << x;
      // Central difference of a cubic: error h²/6 S''' <= 1e-10/6 · 1e3, plus the kink of S''' at
      // nodes.
      const double difference = (spline(x + 1e-5) - spline(x - 1e-5)) / 2e-5;
      EXPECT_NEAR(value.d[0], difference, i < kNodes ? 2e-3 : 1e-6) << x;
    }
  }
}

TEST(Spline, DerivativesInTheNodeValuesAreExact) {
  using D = Dual<double, kNodes>;
  for (bool natural : {true, false}) {
    const auto make = [&](const auto* f) {
      using S = std::remove_cvref_t<decltype(*f)>;
      return natural ? Spline<S>::MakeNatural(kNodes, kX.data(), f)
                     : Spline<S>::MakeMonotone(kNodes, kX.data(), f);
    };
    D f[kNodes];
    for (int k = 0; k < kNodes; ++k) f[k] = D::MakeVariable(kF[static_cast<size_t>(k)], k);
    const auto dual = make(f);
    for (double x : {-1.4, -0.62, -0.1, 0.05, 0.21, 0.58, 0.9, 1.6}) {
      const D value = dual(D(x));
      for (int k = 0; k < kNodes; ++k) {
        std::array<double, kNodes> up = kF, down = kF;
        const double h = 1e-6;
        up[static_cast<size_t>(k)] += h;
        down[static_cast<size_t>(k)] -= h;
        const double difference = (make(up.data())(x) - make(down.data())(x)) / (2 * h);
        // Differences: rounding 1e-16/h = 1e-10, and curvature of the monotone slopes h² · 1e3.
        EXPECT_NEAR(value.d[k], difference, 2e-8) << natural << ' ' << x << ' ' << k;
      }
    }
  }
}

TEST(Spline, IntegralIsTheAreaUnderIt) {
  for (const auto& spline : {MakeNatural(), MakeMonotone()}) {
    for (double x : {-1.7, -0.6, 0.0, 0.3, 0.9, 2.5}) {
      // The anchor is the node nearest to zero, 0.05. Simpson is exact on cubics between nodes; the
      // few panels with a node inside leave 1e-10.
      const int n = 20000;
      const double a = 0.05, h = (x - a) / n;
      double sum = spline(a) + spline(x);
      for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4 : 2) * spline(a + i * h);
      EXPECT_NEAR(spline.CalcIntegral(x), sum * h / 3, 1e-9) << x;
    }
  }
}

// Two routes to every value: the piece that a random walk was last found on, and the walk over all
// segments from the anchor. Lane 0 holds the natural spline, lane 1 the monotone one.
TEST(SplinePiece, FollowsARandomWalkOnTheSpline) {
  using Lanes = Pack<double, 2, isa::Portable>;
  const Spline<double> splines[] = {MakeNatural(), MakeMonotone()};
  SplineSegments<Lanes, 16> segments;
  static_assert(sizeof(segments) == 2 * sizeof(splines[0].segments()));
  const double* from[] = {reinterpret_cast<const double*>(&splines[0].segments()),
                          reinterpret_cast<const double*>(&splines[1].segments())};
  Lanes* to = reinterpret_cast<Lanes*>(&segments);
  for (size_t i = 0; i < sizeof(segments) / sizeof(Lanes); ++i) {
    for (int lane = 0; lane < 2; ++lane) to[i].set(lane, from[lane][i]);
  }
  SplinePiece<Lanes> piece;
  std::mt19937_64 random(7);
  std::normal_distribution<double> step(0.0, 0.2);
  double x[2] = {0.0, 0.3};
  for (int i = 0; i < 2000; ++i) {
    for (double& value : x) {
      value = 0.98 * value + step(random);
      // Nodes themselves, too.
      if (i % 50 == 0) value = kX[static_cast<size_t>(i / 50 % kNodes)];
    }
    Lanes slope;
    const Lanes value =
        EvaluatePiece<2, true>(splines[0].shape(), segments, Lanes::Load(x), piece, slope);
    for (int lane = 0; lane < 2; ++lane) {
      // Rounding of values and slopes of the order of 10.
      EXPECT_NEAR(value.get(lane), splines[lane](x[lane]), 1e-13) << x[lane];
      EXPECT_NEAR(slope.get(lane), splines[lane].CalcSlope(x[lane]), 1e-12) << x[lane];
    }
  }
}

TEST(SplinePiece, KeepsNanToItsLaneAndRecovers) {
  const WithoutTraps nan_is_the_subject;
  using Lanes = Pack<double, 2, isa::Portable>;
  SplineSegments<Lanes, 16> none{};
  SplinePiece<Lanes> piece;
  Lanes slope;
  const double bad[] = {std::nan(""), 1.0};
  const Lanes value = EvaluatePiece<2, true>({}, none, Lanes::Load(bad), piece, slope);
  EXPECT_TRUE(std::isnan(value.get(0)));
  EXPECT_EQ(value.get(1), 0.0);
  EXPECT_EQ((EvaluatePiece<2, true>({}, none, Lanes(2.0), piece, slope)).get(0), 0.0);
}

}  // namespace
}  // namespace kingpin::math
