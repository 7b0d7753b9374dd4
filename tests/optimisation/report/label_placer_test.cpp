#include "optimisation/report/label_placer.h"

#include <regex>

#include <gtest/gtest.h>

namespace kingpin::report {
namespace {

TEST(LabelPlacer, NamesOfOnePointAreWrittenTogetherAndOnce) {
  LabelPlacer labels(0, 0, 400, 300);
  labels.Add(100, 100, "K");
  labels.Add(102, 101, "L");
  labels.Add(100, 100, "K");
  labels.Add(200, 100, "far");
  labels.Add(100, std::numeric_limits<double>::quiet_NaN(), "nowhere");
  const std::string svg = labels.Draw("halo");
  EXPECT_NE(svg.find(">K, L<"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">far<"), std::string::npos) << svg;
  EXPECT_EQ(svg.find("nowhere"), std::string::npos) << svg;
}

TEST(LabelPlacer, NamesStayInsideTheFrameAndApart) {
  LabelPlacer labels(0, 0, 400, 300);
  // At the top right corner, and three points too near for names on the same side.
  labels.Add(396, 3, "initial");
  labels.Add(100, 100, "step 1");
  labels.Add(108, 104, "step 2");
  labels.Add(116, 100, "OPT2");
  const std::string svg = labels.Draw("halo");
  std::vector<std::pair<double, double>> places;
  const std::regex place(R"re(x="([0-9.]+)" y="([0-9.]+)")re");
  for (auto i = std::sregex_iterator(svg.begin(), svg.end(), place); i != std::sregex_iterator();
       ++i) {
    places.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
  }
  ASSERT_EQ(places.size(), 4u) << svg;
  for (const auto& [x, y] : places) {
    EXPECT_GE(x, 0);
    EXPECT_LE(x, 400);
    EXPECT_GE(y, 8);  // the text stands above its base line
    EXPECT_LE(y, 300);
  }
  for (std::size_t a = 1; a < places.size(); ++a) {
    for (std::size_t b = 1; b < a; ++b) {
      const bool other_row = std::abs(places[a].second - places[b].second) >= 15.9;
      const bool apart = std::abs(places[a].first - places[b].first) >= 25;
      EXPECT_TRUE(other_row || apart) << svg;
    }
  }
}

}  // namespace
}  // namespace kingpin::report
