#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "core/signal/weighting.h"

namespace kingpin {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string output, errors;
};

class Metrics : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  /// Time, rim acceleration in m/s² and mm/s² and g, wheel acceleration in rad/s² (radius 0.2 m).
  std::string WriteRecord(int samples, const std::function<double(int)>& time,
                          const std::function<double(double)>& acceleration) const {
    std::string text = "time,rim,rim_mm,rim_g,wheel,torque,rack\ns,m/s^2,mm/s^2,g,rad/s^2,N m,kN\n";
    for (int i = 0; i < samples; ++i) {
      const double t = time(i), a = acceleration(t);
      text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", t, a,
                          1e3 * a, a / 9.80665, a / 0.2, -2.0 * a, 3.0 * a);
    }
    return Write("signals.csv", text);
  }

  Outcome Run(const std::string& arguments) const {
    const std::string errors = (folder_ / "errors.txt").string();
    const std::string command =
        fmt::format("'{}' metrics {} 2>'{}'", KINGPIN_PROGRAM, arguments, errors);
    Outcome outcome;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> buffer;
    for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
      outcome.output.append(buffer.data(), n);
    }
    outcome.status = WEXITSTATUS(pclose(pipe));
    std::stringstream text;
    text << std::ifstream(errors).rdbuf();
    outcome.errors = text.str();
    return outcome;
  }

  nlohmann::json Evaluate(const std::string& arguments) const {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
    return nlohmann::json::parse(outcome.output);
  }

  fs::path folder_;
};

double CalcMillisecond(int i) { return 1e-3 * i; }
double CalcSine(double t) { return 3.0 * std::sin(2.0 * std::numbers::pi * 25.0 * t); }

TEST_F(Metrics, OfASineAreItsClosedForms) {
  const std::string file = WriteRecord(1001, CalcMillisecond, CalcSine);
  const auto json = Evaluate(file + " --channel rim");
  // 40 samples a period, a sample on every peak.
  EXPECT_NEAR(json["gamma_1"], 6000.0, 1e-8);
  EXPECT_NEAR(json["gamma_5"], 3000.0 / std::sqrt(2.0), 0.01);
  const double weight = signal::Weighting::Named("Wh").CalcMagnitude(25.0);
  EXPECT_NEAR(json["gamma_3"], 1500.0 * weight, 1e-6);
  EXPECT_NEAR(Evaluate(file + " --channel rim --weighting none")["gamma_3"], 1500.0, 1e-6);
  EXPECT_NEAR(Evaluate(file + " --channel rim --weighting W_d --gamma3-without-root")["gamma_3"],
              std::pow(1500.0 * signal::Weighting::Named("Wd").CalcMagnitude(25.0), 2), 1e-4);
  EXPECT_NEAR(json["companions"]["unweighted"]["crest_factor"], std::sqrt(2.0), 1e-5);
  EXPECT_THAT(json["conventions"]["gamma_2"].get<std::string>(), HasSubstr("window of 0.6 s"));
  EXPECT_EQ(json["units"]["gamma_1"], "mm/s^2");
}

TEST_F(Metrics, AreTheSameInEveryUnit) {
  const std::string file = WriteRecord(1001, CalcMillisecond, CalcSine);
  const auto json = Evaluate(file + " --channel rim");
  for (const char* other : {"--channel rim_mm", "--channel rim_g", "--channel wheel --radius 0.2",
                            "--channel wheel --radius '20 cm'"}) {
    const auto same = Evaluate(file + " " + other);
    for (const char* key : {"gamma_1", "gamma_2", "gamma_3", "gamma_4", "gamma_5"}) {
      const double expected = json[key];
      EXPECT_NEAR(same[key], expected, 1e-12 * expected) << other << " " << key;
    }
  }
}

TEST_F(Metrics, NonUniformTimeIsResampledAndSaidSo) {
  const auto knock = [](double t) {
    return t < 0.1 ? 0.0
                   : 9.0 * std::exp(-6.0 * (t - 0.1)) * std::pow(std::sin(50.0 * (t - 0.1)), 3);
  };
  const auto uniform = Evaluate(WriteRecord(
                                    2001, [](int i) { return 5e-4 * i; }, knock) +
                                " --channel rim");
  const auto stretched =
      Evaluate(WriteRecord(
                   1501,
                   [](int i) {
                     const double u = i / 1500.0;
                     return i == 1500 ? 1.0 : u + 0.1 * std::sin(2.0 * std::numbers::pi * u);
                   },
                   knock) +
               " --channel rim");
  EXPECT_EQ(uniform["record"]["sampling"], "as in the file");
  EXPECT_THAT(stretched["record"]["sampling"].get<std::string>(),
              HasSubstr("resampled from 1501 samples: piecewise cubic"));
  // Interpolation error (ω h)³ of a few 1e-5, with ω up to 150 rad/s and h up to 1.1 ms.
  for (const char* key : {"gamma_1", "gamma_2", "gamma_3", "gamma_4", "gamma_5"}) {
    const double expected = uniform[key];
    EXPECT_NEAR(stretched[key], expected, 5e-4 * expected) << key;
  }
}

TEST_F(Metrics, OfAPartAreThoseOfTheCutRecord) {
  const std::string file = WriteRecord(2001, CalcMillisecond, CalcSine);
  const auto part = Evaluate(file + " --channel rim --from 0.4 --to '1400 ms' --torque torque");
  EXPECT_EQ(part["record"]["samples"], 1001);
  EXPECT_NEAR(part["gamma_5"], 3000.0 / std::sqrt(2.0), 0.01);
  const double time = part["companions"]["torsion_torque"]["time_of_peak"];
  EXPECT_GE(time, 0.4);
  EXPECT_NEAR(part["companions"]["torsion_torque"]["peak"], 6.0, 1e-9);
}

TEST_F(Metrics, ForcesStandBesideThemInSi) {
  const std::string file = WriteRecord(1001, CalcMillisecond, CalcSine);
  const auto json = Evaluate(file + " --channel rim --rack-force rack --tie-rod-force rack");
  EXPECT_NEAR(json["companions"]["rack_force"]["peak_to_peak"], 18000.0, 1e-6);
  EXPECT_FALSE(json["companions"].contains("torsion_torque"));
}

TEST_F(Metrics, ThePaperSetsConventionIsOneOption) {
  const std::string file = WriteRecord(1001, CalcMillisecond, CalcSine);
  const auto json = Evaluate(file + " --channel rim --paper-set 7.5");
  // One line of amplitude 3 at 25 Hz, weight 16/25.
  EXPECT_NEAR(json["gamma_3"], 7.5 * 9.0 * 0.64 * 0.64, 1e-9);
  EXPECT_EQ(json["units"]["gamma_3"], "m^2/s^4");
}

TEST_F(Metrics, AWeightingCanComeFromATable) {
  const std::string file = WriteRecord(1001, CalcMillisecond, CalcSine);
  const std::string table = Write("w.csv", "frequency,factor\nHz,-\n1,1\n625,0.04\n");
  // Straight in log-log: 25 Hz is half way, factor 0.2.
  EXPECT_NEAR(Evaluate(file + " --channel rim --weighting " + table)["gamma_3"], 300.0, 1e-6);
}

TEST_F(Metrics, AreWrittenToAFileWhenAsked) {
  const std::string file = WriteRecord(11, CalcMillisecond, CalcSine);
  const Outcome outcome =
      Run(fmt::format("{} --channel rim -o '{}'", file, (folder_ / "out.json").string()));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  EXPECT_TRUE(nlohmann::json::parse(std::ifstream(folder_ / "out.json")).contains("gamma_5"));
}

TEST_F(Metrics, UnusableInputEndsWithStatus2AndAMessage) {
  const std::string good = WriteRecord(11, CalcMillisecond, CalcSine);
  const std::string head = "time,rim\ns,m/s^2\n";
  const std::pair<std::string, const char*> cases[] = {
      {"/nowhere/signals.csv", "/nowhere/signals.csv"},
      {good + " --channel rim_mn", "did you mean 'rim_mm'?"},
      {good, "channels: rim, rim_mm, rim_g, wheel, torque, rack"},
      {good + " --channel wheel", "give the radius of the rim, e.g. --radius '185 mm'"},
      {good + " --channel wheel --radius 0", "--radius: found 0 m, expected a positive length"},
      {good + " --channel rim --radius 0.2", "no --radius with a rim acceleration"},
      {good + " --channel torque", "found unit 'N m', expected an acceleration of the rim"},
      {good + " --channel rim --torque rack", "found unit 'kN', expected 'N m'"},
      {good + " --channel rim --window -1", "window: found -1"},
      {good + " --channel rim --window '3 m'", "command line: --window: found '3 m'"},
      {good + " --channel rim --decay-level 2", "decay_level: found 2"},
      {good + " --channel rim --f1 600", "f2: found 500, expected a frequency above f1"},
      {good + " --channel rim --f1 600 --f2 900", "half the rate of the record"},
      {good + " --channel rim --weighting Wx", "expected one of Wb, Wc"},
      {good + " --channel rim --from 3", "the record lasts from 0 to 0.01 s"},
      {good + " --channel rim --step 1e-12", "at most ten million steps"},
      {good + " --channel rim --set a=1", "found '--set', expected an option of 'metrics'"},
      {Write("empty.csv", ""), "empty.csv"},
      {Write("one_row.csv", head + "0,1\n"), "one_row.csv"},
      {Write("backwards.csv", head + "0,1\n0.2,1\n0.1,1\n"), "backwards.csv:5"},
      {Write("nan.csv", head + "0,1\n0.1,nan\n0.2,1\n"), "nan.csv:4"},
      {Write("no_unit.csv", "0,1\n0.1,2\n0.2,1\n"), "write the unit in row 2"},
  };
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(outcome.output, "") << arguments;
    EXPECT_THAT(outcome.errors, HasSubstr(message)) << arguments;
  }
}

}  // namespace
}  // namespace kingpin
