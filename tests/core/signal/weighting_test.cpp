#include "core/signal/weighting.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"

namespace kingpin::signal {
namespace {

using testing::HasSubstr;

constexpr std::array<const char*, 8> kColumns = {"Wb", "Wc", "Wd", "We", "Wg", "Wj", "Wk", "Wh"};

struct Row {
  int band;  // true centre 10^(band/10) Hz
  std::array<double, 8> factor;
};

// Factors at the true band centres, to four digits; they agree with annex B of ISO 8041-1 at all
// points compared (apart from Wg, which is of BS 6841).
constexpr Row kTable[] = {
    {-1, {0.3808, 0.9716, 0.9914, 0.9423, 0.333, 0.4776, 0.4767, 0.01586}},
    {0, {0.3853, 0.991, 1.011, 0.8798, 0.4237, 0.4844, 0.4825, 0.02514}},
    {1, {0.3864, 1, 1.007, 0.7683, 0.5053, 0.4851, 0.4846, 0.03985}},
    {2, {0.3916, 1.006, 0.9707, 0.6372, 0.5855, 0.4832, 0.4935, 0.06314}},
    {3, {0.4168, 1.012, 0.8913, 0.5127, 0.6757, 0.4819, 0.5308, 0.09992}},
    {4, {0.496, 1.017, 0.7733, 0.407, 0.7817, 0.4889, 0.6335, 0.1576}},
    {5, {0.6653, 1.023, 0.6398, 0.3218, 0.8986, 0.5246, 0.8071, 0.2461}},
    {6, {0.885, 1.024, 0.5143, 0.2543, 1.002, 0.6251, 0.9648, 0.3754}},
    {7, {1.026, 1.013, 0.4081, 0.2012, 1.05, 0.7948, 1.039, 0.545}},
    {8, {1.054, 0.9739, 0.3226, 0.1594, 1.009, 0.947, 1.054, 0.7272}},
    {9, {1.026, 0.8941, 0.255, 0.1263, 0.8939, 1.016, 1.037, 0.8731}},
    {10, {0.9745, 0.7762, 0.2017, 0.1002, 0.7499, 1.03, 0.9884, 0.9514}},
    {11, {0.9042, 0.6425, 0.1597, 0.07954, 0.611, 1.026, 0.8989, 0.9576}},
    {12, {0.8144, 0.5166, 0.1266, 0.06314, 0.4908, 1.019, 0.7743, 0.8958}},
    {13, {0.7088, 0.4098, 0.1004, 0.05011, 0.3918, 1.012, 0.6373, 0.782}},
    {14, {0.5973, 0.3236, 0.07958, 0.03975, 0.3116, 1.006, 0.5103, 0.6471}},
    {15, {0.4906, 0.2549, 0.06299, 0.03147, 0.2471, 1, 0.4031, 0.5192}},
    {16, {0.395, 0.2002, 0.04965, 0.02481, 0.195, 0.9911, 0.316, 0.4111}},
    {17, {0.3118, 0.1557, 0.03872, 0.01935, 0.1521, 0.972, 0.2451, 0.3244}},
    {18, {0.2389, 0.1182, 0.02946, 0.01473, 0.1158, 0.9304, 0.1857, 0.256}},
    {19, {0.1734, 0.08538, 0.0213, 0.01065, 0.08373, 0.8465, 0.1339, 0.2024}},
    {20, {0.1154, 0.05665, 0.01414, 0.007071, 0.05561, 0.7075, 0.08873, 0.1602}},
    {21, {0.06929, 0.03394, 0.008478, 0.004239, 0.03334, 0.5338, 0.05311, 0.127}},
    {22, {0.03818, 0.01868, 0.004668, 0.002334, 0.01835, 0.37, 0.02922, 0.1007}},
    {23, {0.01999, 0.009772, 0.002442, 0.001221, 0.009603, 0.2437, 0.01528, 0.07988}},
    {24, {0.0102, 0.004987, 0.001246, 0.0006232, 0.004901, 0.1565, 0.007795, 0.06338}},
    {25, {0.005154, 0.002518, 0.0006293, 0.0003147, 0.002475, 0.09951, 0.003935, 0.05026}},
    {26, {0.002591, 0.001266, 0.0003164, 0.0001582, 0.001244, 0.06297, 0.001978, 0.0398}},
    {27, {0.0013, 0.000635, 0.0001587, 7.937e-05, 0.0006243, 0.03978, 0.0009923, 0.03137}},
    {28, {0.000652, 0.0003184, 7.96e-05, 3.98e-05, 0.000313, 0.02511, 0.0004975, 0.02447}},
    {29, {0.0003268, 0.0001596, 3.99e-05, 1.995e-05, 0.0001569, 0.01585, 0.0002494, 0.01862}},
    {30, {0.0001638, 8e-05, 2e-05, 1e-05, 7.865e-05, 0.01, 0.000125, 0.01346}},
};

double RoundToFourDigits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return std::atof(text);
}

TEST(Weighting, EqualsTheWholeTableToItsPrintedDigits) {
  for (const Row& row : kTable) {
    const double frequency = std::pow(10.0, 0.1 * row.band);
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      const double ours = Weighting::Named(kColumns[i]).CalcMagnitude(frequency);
      EXPECT_DOUBLE_EQ(RoundToFourDigits(ours), row.factor[i])
          << kColumns[i] << " at " << frequency << " Hz";
    }
  }
}

TEST(Weighting, EqualsThePublishedPointsOutsideTheTable) {
  const auto wf = Weighting::Named("Wf");
  EXPECT_DOUBLE_EQ(RoundToFourDigits(wf.CalcMagnitude(0.1)), 0.6951);
  EXPECT_DOUBLE_EQ(RoundToFourDigits(wf.CalcMagnitude(std::pow(10.0, -0.8))), 1.004);
  EXPECT_DOUBLE_EQ(RoundToFourDigits(wf.CalcMagnitude(std::pow(10.0, -0.4))), 0.3884);
  const double pi = std::numbers::pi;
  EXPECT_NEAR(Weighting::Named("Wh").CalcMagnitude(500.0 / (2.0 * pi)), 0.20202, 5e-6);
  const std::pair<const char*, double> at_100_rad_per_s[] = {{"Wk", 0.77182}, {"Wb", 0.81256},
                                                             {"Wc", 0.51445}, {"Wd", 0.12608},
                                                             {"We", 0.06287}, {"Wj", 1.01851}};
  for (const auto& [name, value] : at_100_rad_per_s) {
    EXPECT_NEAR(Weighting::Named(name).CalcMagnitude(100.0 / (2.0 * pi)), value, 5e-6) << name;
  }
}

TEST(Weighting, WmIsTheBandLimitedFirstOrderLowPassOfBuildings) {
  // With ω3 = ω4 and Q4 = 1/2, H_t is 1/(1 + s/ω3): |H_t| = 1/√2 at 5.684 Hz, where the band limits
  // give (1 + (0.794/5.68)⁴)^-1/2 (1 + (5.68/100)⁴)^-1/2.
  const double f = 1.0 / (0.028 * 2.0 * std::numbers::pi);
  const double limits = 1.0 / std::sqrt((1.0 + std::pow(std::pow(10.0, -0.1) / f, 4)) *
                                        (1.0 + std::pow(f / 100.0, 4)));
  EXPECT_NEAR(Weighting::Named("Wm").CalcMagnitude(f), limits / std::numbers::sqrt2, 1e-14);
}

TEST(Weighting, TheResponseHasThePhaseOfACausalFilter) {
  // Above its corners Wh is a low pass and lags; far below, its second-order high pass leads by
  // almost π.
  EXPECT_LT(std::arg(Weighting::Named("Wh").CalcResponse(100.0)), 0.0);
  EXPECT_GT(std::arg(Weighting::Named("Wh").CalcResponse(0.1)), 3.0);
  EXPECT_EQ(Weighting::Named("Wh").CalcMagnitude(0.0), 0.0);
}

TEST(Weighting, WsIsTheBrokenLineOfGiacomin) {
  const auto ws = Weighting::Named("W_s");
  EXPECT_DOUBLE_EQ(ws.CalcMagnitude(0.0), 1.0);
  EXPECT_DOUBLE_EQ(ws.CalcMagnitude(4.0), 1.0);
  EXPECT_NEAR(ws.CalcMagnitude(12.6191), 0.5, 1e-4);  // one octave up: −6 dB read as slope −1
  EXPECT_NEAR(ws.CalcMagnitude(50.119), 0.126, 5e-4);
  EXPECT_NEAR(ws.CalcMagnitude(158.0), 0.126, 5e-4);
  EXPECT_NEAR(ws.CalcMagnitude(std::pow(10.0, 2.5)), 0.040, 5e-4);
}

TEST(Weighting, ThePaperShapeRisesStaysAndFalls) {
  const auto paper = Weighting::Named("paper");
  EXPECT_DOUBLE_EQ(paper.CalcMagnitude(0.0), 0.0);
  EXPECT_NEAR(paper.CalcMagnitude(2.0), 0.25, 1e-15);
  EXPECT_NEAR(paper.CalcMagnitude(8.0), 1.0, 1e-15);
  EXPECT_NEAR(paper.CalcMagnitude(12.0), 1.0, 1e-15);
  EXPECT_NEAR(paper.CalcMagnitude(64.0), 0.25, 1e-15);
  EXPECT_EQ(Weighting::Named("none").CalcMagnitude(123.0), 1.0);
}

TEST(Weighting, AnUnknownNameIsRefusedWithTheKnownOnes) {
  try {
    Weighting::Named("Wq");
    FAIL();
  } catch (const io::InputError& error) {
    EXPECT_STREQ(error.what(),
                 "weighting: found 'Wq', expected one of Wb, Wc, Wd, We, Wf, Wg, Wh, Wj, Wk, Wm, "
                 "Ws, paper, none, or a CSV file with frequency and factor");
  }
}

class WeightingTable : public testing::Test {
 protected:
  static std::filesystem::path Write(const std::string& text) {
    const auto path = std::filesystem::path(testing::TempDir()) / "weighting.csv";
    std::ofstream(path) << text;
    return path;
  }
  static std::string CalcMessage(const std::string& text) {
    try {
      Weighting::FromFile(Write(text));
    } catch (const io::InputError& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(WeightingTable, IsInterpolatedInLogarithmicAxes) {
  const auto table = Weighting::FromFile(Write("frequency,factor\nkHz,%\n0.001,100\n0.1,1\n"));
  EXPECT_NEAR(table.CalcMagnitude(10.0), 0.1, 1e-14);
  EXPECT_NEAR(table.CalcMagnitude(2.0), 0.5, 1e-14);
  EXPECT_NEAR(table.CalcMagnitude(0.0), 1.0, 1e-14);
  EXPECT_NEAR(table.CalcMagnitude(1000.0), 0.01, 1e-14);
}

TEST_F(WeightingTable, ErrorsNameTheLine) {
  EXPECT_THAT(CalcMessage("1,1\n1,2\n"),
              HasSubstr("weighting.csv:2: weighting: found frequency 1 Hz after 1 Hz, expected "
                        "increasing frequencies"));
  EXPECT_THAT(CalcMessage("1,1\n2,0\n"), HasSubstr("logarithmic axes"));
  EXPECT_THAT(CalcMessage("f,w\nrad/s,-\n1,1\n"), HasSubstr("unit 'rad/s' of the frequency"));
  EXPECT_THAT(CalcMessage("f,w\nHz,m\n1,1\n"), HasSubstr("unit 'm' of the factor"));
  EXPECT_THAT(CalcMessage("1,1,1\n"), HasSubstr("found 3 columns, expected two"));
  EXPECT_THROW(Weighting::FromFile("/nowhere/w.csv"), io::InputError);
}

TEST(MakeWeighted, ASteadySineIsScaledAndShiftedByTheResponse) {
  const auto wh = Weighting::Named("Wh");
  std::vector<double> record(4001);
  for (std::size_t i = 0; i < record.size(); ++i) {
    record[i] = std::sin(2.0 * std::numbers::pi * 30.0 * 1e-3 * double(i));
  }
  const auto weighted = MakeWeighted(wh, record, 1e-3);
  const auto response = wh.CalcResponse(30.0);
  for (std::size_t i = 2000; i < 3000; ++i) {
    const double phase = 2.0 * std::numbers::pi * 30.0 * 1e-3 * double(i) + std::arg(response);
    // By then the start has died out (its slowest part by e^-28 per second); what is left is the
    // step of the filter's phase at the Nyquist frequency, which rings through the record.
    EXPECT_NEAR(weighted[i], std::abs(response) * std::sin(phase), 1e-4);
  }
}

}  // namespace
}  // namespace kingpin::signal
