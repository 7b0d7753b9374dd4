#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "optimisation/report/bar_chart.h"
#include "optimisation/report/bode_chart.h"
#include "optimisation/report/line_chart.h"
#include "optimisation/report/plot_area.h"
#include "optimisation/report/scatter_chart.h"
#include "tests/optimisation/report/html_check.h"

namespace kingpin::report {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

void ExpectSound(const std::string& html) {
  const check::Document document = check::ReadDocument(html);
  EXPECT_TRUE(document.problems.empty()) << document.problems[0] << "\n" << html.substr(0, 2000);
  for (const check::Element& e : document.elements) {
    for (const auto& [name, value] : e.attributes) {
      EXPECT_EQ(value.find("nan"), std::string::npos) << e.name << " " << name << "=" << value;
      EXPECT_EQ(value.find("inf"), std::string::npos) << e.name << " " << name << "=" << value;
    }
  }
}

LineChart MakeChart(std::vector<double> x, std::vector<double> y, Scale scale = Scale::kLinear) {
  LineChart chart;
  chart.title = "Title";
  chart.x = {.name = "Time", .unit = "s"};
  chart.y = {.name = "Force", .unit = "kN", .scale = scale};
  chart.series = {{.name = "one", .x = std::move(x), .y = std::move(y), .markers = true}};
  return chart;
}

TEST(Chart, BadDataStillGiveASoundDrawing) {
  const std::vector<std::pair<std::vector<double>, std::vector<double>>> data = {
      {{}, {}},
      {{1.0}, {2.0}},
      {{0.0}, {0.0}},
      {{0, 1, 2}, {kNan, kNan, kNan}},
      {{0, 1, 2}, {kInf, -kInf, 1.0}},
      {{kNan, kInf, 2}, {1, 2, 3}},
      {{0, 1, 2}, {1e308, -1e308, 1.0}},
      {{0, 1, 2}, {1e-300, 2e-300, 0.0}},
      {{0, 1, 2}, {5, 5, 5}},
      {{0, 0, 0}, {1, 2, 3}},
      {{0, 1, 2, 3}, {1, 2}},
      {{2, 1, 0}, {1, 2, 3}},
      {{0, 1e9, 2e18}, {-3, 4, 1e12}},
  };
  for (const auto& [x, y] : data) {
    for (const Scale scale : {Scale::kLinear, Scale::kLog}) {
      LineChart chart = MakeChart(x, y, scale);
      ExpectSound(DrawLineChart(chart));
      chart.x.scale = Scale::kLog;
      chart.series[0].steps = true;
      chart.series[0].labels = {"a", "b", "c"};
      chart.bands = {{"band", x, y, y}};
      chart.reference_lines = {{true, 1.0, "v"}, {false, kNan, "h"}};
      ExpectSound(DrawLineChart(chart));
    }
  }
}

TEST(Chart, NothingToDrawIsSaid) {
  EXPECT_NE(DrawLineChart(MakeChart({0, 1}, {kNan, kNan})).find("no data to draw"),
            std::string::npos);
  EXPECT_EQ(DrawLineChart(MakeChart({0, 1}, {1, 2})).find("no data to draw"), std::string::npos);
}

TEST(Chart, AxesCarryTheirUnits) {
  const std::string html = DrawLineChart(MakeChart({0, 1}, {1, 2}));
  EXPECT_NE(html.find("Time [s]"), std::string::npos);
  EXPECT_NE(html.find("Force [kN]"), std::string::npos);
  EXPECT_NE(DrawLineChart(MakeChart({0, 1}, {1e7, 2e7})).find("Force [10⁶ kN]"), std::string::npos);
}

TEST(Chart, AGapInterruptsTheLine) {
  const auto count_moves = [](const LineChart& chart) {
    const check::Document document = check::ReadDocument(DrawLineChart(chart));
    long moves = 0;
    for (const check::Element& e : document.elements) {
      const auto d = e.attributes.find("d");
      if (e.attributes.count("data-name") == 0 || d == e.attributes.end()) continue;
      moves += std::count(d->second.begin(), d->second.end(), 'M');
    }
    return moves;
  };
  EXPECT_EQ(count_moves(MakeChart({0, 1, 2, 3, 4}, {1, 2, 3, 4, 5})), 1);
  EXPECT_EQ(count_moves(MakeChart({0, 1, 2, 3, 4}, {1, 2, kNan, 4, 5})), 2);
}

TEST(Chart, LongHistoriesStaySmall) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 200000; ++i) {
    x.push_back(5e-6 * i);
    y.push_back(std::sin(0.01 * i));
  }
  LineChart chart = MakeChart(x, y);
  chart.series[0].markers = false;
  EXPECT_LT(DrawLineChart(chart).size(), 40000u);
}

TEST(AxisMap, LimitsLandOnThePixelsGiven) {
  AxisMap linear({.min = 2.0, .max = 6.0}, {}, 0.0, 5);
  linear.SetPixels(100.0, 300.0);
  EXPECT_DOUBLE_EQ(linear.ToPixel(2.0), 100.0);
  EXPECT_DOUBLE_EQ(linear.ToPixel(5.0), 250.0);
  // Fixed limits hold whatever the data are, also beside them.
  for (const double v : {-50.0, 4.0, 900.0}) {
    const AxisMap fixed({.min = 2.0, .max = 6.0}, {v}, 0.05, 5);
    EXPECT_EQ(fixed.low(), 2.0);
    EXPECT_EQ(fixed.high(), 6.0);
    EXPECT_EQ(AxisMap({.min = 2.0}, {v, v + 1.0}, 0.05, 5).low(), 2.0);
    EXPECT_EQ(AxisMap({.max = 2.0}, {v, v + 1.0}, 0.05, 5).high(), 2.0);
    EXPECT_GT(AxisMap({.min = 2.0}, {v, v + 1.0}, 0.05, 5).high(), 2.0);
  }
  AxisMap logarithmic({.scale = Scale::kLog, .min = 1.0, .max = 100.0}, {3.0}, 0.0, 5);
  logarithmic.SetPixels(0.0, 200.0);
  EXPECT_NEAR(logarithmic.ToPixel(10.0), 100.0, 1e-9);  // rounding of two logarithms
  EXPECT_TRUE(std::isnan(logarithmic.ToPixel(0.0)));
  EXPECT_TRUE(std::isnan(logarithmic.ToPixel(-1.0)));
}

TEST(BodeChart, PhaseOfTwoLagsRunsThroughWithoutJumps) {
  std::vector<std::complex<double>> h;
  for (int i = 0; i <= 400; ++i) {
    const std::complex<double> s(0.0, std::pow(10.0, -2.0 + 0.01 * i));
    h.push_back(1.0 / ((1.0 + s) * (1.0 + s) * (1.0 + s)));
  }
  const std::vector<double> phase = CalcUnwrappedPhaseDegrees(h);
  // Third-order lag: -3 atan(w), by closed form at the last frequency of 100 rad/s.
  EXPECT_NEAR(phase.back(), -3.0 * std::atan(100.0) * 180.0 / std::numbers::pi, 1e-9);
  for (size_t i = 1; i < phase.size(); ++i) EXPECT_LT(std::abs(phase[i] - phase[i - 1]), 5.0);
}

TEST(BodeChart, BadResponsesStillGiveASoundDrawing) {
  BodeChart chart;
  chart.title = "H";
  chart.unit = "N/N";
  ExpectSound(DrawBodeChart(chart));
  chart.series = {{.name = "a", .frequency_hz = {1, 2, 3}, .response = {0.0, {kNan, 0.0}, kInf}}};
  ExpectSound(DrawBodeChart(chart));
  chart.series = {{.name = "a", .frequency_hz = {1.0}, .response = {{0.5, 0.5}}}};
  ExpectSound(DrawBodeChart(chart));
}

TEST(BarChart, ZeroMissingAndHugeBarsAreSound) {
  BarChart chart;
  chart.title = "Γ_1";
  chart.categories = {"r_L", "<b>"};
  ExpectSound(DrawBarChart(chart));
  chart.series = {{.name = "<i>", .values = {kNan, kInf}}, {.name = "b", .values = {-1e300, 0.0}}};
  ExpectSound(DrawBarChart(chart));
  chart.limit = 2.0;
  ExpectSound(DrawBarChart(chart));
}

TEST(ParetoChart, TheStaircaseNeverPromisesMoreThanItsPoints) {
  // Less is better in both: between two points the worse y holds.
  ParetoFront front;
  front.front = {{1.0, 1.0, ""}, {0.0, 2.0, ""}};
  const check::Document document = check::ReadDocument(DrawParetoChart(front, 540.0));
  std::string path;
  for (const check::Element& e : document.elements) {
    if (e.attributes.count("data-name") > 0) path = e.attributes.at("d");
  }
  double x[3];
  double y[3];
  ASSERT_EQ(std::sscanf(path.c_str(), "M%lf,%lfL%lf,%lfL%lf,%lf", &x[0], &y[0], &x[1], &y[1], &x[2],
                        &y[2]),
            6);
  EXPECT_EQ(y[0], y[1]);  // first along x at the larger y ...
  EXPECT_EQ(x[1], x[2]);  // ... then down (larger pixel) to the lower one
  EXPECT_LT(y[1], y[2]);
}

}  // namespace
}  // namespace kingpin::report
