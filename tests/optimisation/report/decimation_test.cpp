#include "optimisation/report/decimation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kingpin::report {
namespace {

TEST(Decimation, ExtremesAndEndsSurvive) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 40.0);
  std::vector<PixelPoint> points;
  points.reserve(100000);
  for (int i = 0; i < 100000; ++i) points.push_back({500.0 * i / 100000.0, noise(random)});
  points[4711].y = 900.0;
  points[77777].y = -900.0;
  const auto pieces = DecimateLine(points, 1.0);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_LE(pieces[0].size(), 4u * 501u);
  const auto [low, high] =
      std::minmax_element(pieces[0].begin(), pieces[0].end(),
                          [](const PixelPoint& a, const PixelPoint& b) { return a.y < b.y; });
  EXPECT_EQ(low->y, -900.0);
  EXPECT_EQ(high->y, 900.0);
  EXPECT_EQ(pieces[0].front().x, points.front().x);
  EXPECT_EQ(pieces[0].back().x, points.back().x);
  EXPECT_TRUE(std::is_sorted(pieces[0].begin(), pieces[0].end(),
                             [](const PixelPoint& a, const PixelPoint& b) { return a.x < b.x; }));
}

TEST(Decimation, FewPointsStayAsTheyAre) {
  const std::vector<PixelPoint> points = {{0, 1}, {10, 2}, {20, -3}};
  const auto pieces = DecimateLine(points, 1.0);
  ASSERT_EQ(pieces.size(), 1u);
  ASSERT_EQ(pieces[0].size(), 3u);
  EXPECT_EQ(pieces[0][2].y, -3.0);
}

TEST(Decimation, GapsSplitTheLine) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto pieces =
      DecimateLine({{0, nan}, {1, 1}, {2, 2}, {3, nan}, {4, nan}, {5, 5}, {6, nan}}, 1.0);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].size(), 2u);
  EXPECT_EQ(pieces[1].size(), 1u);
  EXPECT_TRUE(DecimateLine({}, 1.0).empty());
}

}  // namespace
}  // namespace kingpin::report
