#include "tests/apps/program.h"

// The verbs that run something: study, optimise, simulate, modes.
namespace kingpin {
namespace {

using testing::HasSubstr;

/// Writes a scenario: paper set A with another lateral stiffness over a half sine.
std::string WriteScenario(const fs::path& folder, const std::string& lateral_stiffness) {
  std::ofstream(folder / "scenario.yaml") << fmt::format(R"(kind: scenario
name: half sine
model: {{paper_set: {}/examples/paper/set_A.json}}
design: {{lateral_stiffness: {}}}
load_cases:
  - name: strip
    pulses:
      - {{shape: half_sine, peak: 3 kN, start: 0.1 s, duration: 20 ms}}
)",
                                                         KINGPIN_SOURCE_DIR, lateral_stiffness);
  return "scenario.yaml";
}

TEST_F(Program, AStudyWritesReportSummaryManifestAndSignals) {
  const Outcome outcome = Run("study " + WriteStudy() + " -o out");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("Table 3"));
  EXPECT_THAT(outcome.output, HasSubstr("report.html"));
  EXPECT_EQ(outcome.errors, "");  // no progress in a pipe
  EXPECT_THAT(ReadAll(folder_ / "out/report.html"), HasSubstr("<svg"));
  const nlohmann::json summary = Summary("out");
  const auto& designs = summary["cases"][0]["designs"];
  ASSERT_EQ(designs.size(), 3);
  EXPECT_LT(designs[1]["sum_of_ratios"].get<double>(), 5.0);
  EXPECT_LE(designs[2]["sum_of_ratios"].get<double>(), 5.0);
  EXPECT_FALSE(summary["cases"][0]["pareto"].empty());
  const nlohmann::json manifest = nlohmann::json::parse(ReadAll(folder_ / "out/manifest.json"));
  EXPECT_FALSE(manifest.empty());
  const std::string signals = ReadAll(folder_ / "out/case_2/step_1/set_C.csv");
  EXPECT_EQ(signals.substr(0, 5), "time,");
}

TEST_F(Program, AStudyIsTheSameForAnyNumberOfThreads) {
  const std::string file = WriteStudy();
  ASSERT_EQ(Run("study " + file + " -o one --threads 1").status, 0);
  ASSERT_EQ(Run("study " + file + " -o three --threads 3").status, 0);
  nlohmann::json one = Summary("one"), three = Summary("three");
  for (nlohmann::json* summary : {&one, &three}) {
    summary->erase("seconds");
    for (auto& design : (*summary)["cases"][0]["designs"]) {
      if (design.contains("search")) design["search"].erase("seconds");
    }
  }
  EXPECT_EQ(one, three);
}

TEST_F(Program, SimulatedSignalsGiveTheSameMeasuresAsTheSummary) {
  const std::string root = KINGPIN_SOURCE_DIR;
  const Outcome run = Run("simulate " + root + "/examples/c_segment -o out --quiet");
  ASSERT_EQ(run.status, 0) << run.errors;
  const Outcome metrics = Run("metrics out/signals.csv --channel steering.wheel.rim_acceleration");
  ASSERT_EQ(metrics.status, 0) << metrics.errors;
  const nlohmann::json again = nlohmann::json::parse(metrics.output);
  const nlohmann::json summary = Summary("out");
  for (int k = 1; k <= 5; ++k) {
    const std::string key = "gamma_" + std::to_string(k);
    const double value = summary["measures"][key]["value"].get<double>();
    EXPECT_NEAR(again[key].get<double>(), value, 1e-9 * value) << key;
  }
}

TEST_F(Program, TheDefaultAgreesWithCvodeOnTheShippedCarWithDryFriction) {
  const std::string scenario = std::string(KINGPIN_SOURCE_DIR) + "/examples/c_segment";
  ASSERT_EQ(Run("simulate " + scenario + " -o fast").status, 0);
  ASSERT_EQ(Run("simulate " + scenario + " -o cvode --set method=cvode").status, 0);
  const nlohmann::json fast = Summary("fast"), cvode = Summary("cvode");
  for (int k = 1; k <= 5; ++k) {
    const std::string key = "gamma_" + std::to_string(k);
    const double value = cvode["measures"][key]["value"].get<double>();
    EXPECT_NEAR(fast["measures"][key]["value"].get<double>(), value, 1e-6 * value) << key;
  }
}

TEST_F(Program, TheManifestSaysHowARunWasIntegrated) {
  const std::string root = KINGPIN_SOURCE_DIR;
  const auto solver = [&](const std::string& arguments) {
    const Outcome outcome = Run("simulate " + arguments + " -o out");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    const auto manifest = nlohmann::json::parse(ReadAll(folder_ / "out/manifest.json"))["solver"];
    const nlohmann::json summary = Summary("out")["solver"];
    EXPECT_EQ(manifest.size(), summary.size());
    for (const auto& [name, number] : summary.items()) EXPECT_EQ(manifest[name], number["value"]);
    return manifest;
  };
  const std::string stiff = WriteScenario(folder_, "5e7 N/m");
  const nlohmann::json fast = solver(stiff);
  EXPECT_LE(fast["step"].get<double>(), 2.5e-4);
  EXPECT_LE(fast["error_estimate"].get<double>(), fast["error_bound"].get<double>());
  const nlohmann::json rk4 = solver(stiff + " --set method=rk4");
  EXPECT_EQ(rk4["step"].get<double>(), 1e-5);
  EXPECT_GT(rk4["steps"].get<double>(), 8e4);
  EXPECT_FALSE(rk4.contains("error_estimate"));
  EXPECT_GT(solver(stiff + " --set method=cvode")["steps"].get<double>(), 100);
}

TEST_F(Program, ARunThatMissesItsErrorBoundFails) {
  const std::string scenario = WriteScenario(folder_, "1.3e9 N/m");
  const Outcome outcome = Run("simulate " + scenario + " -o out");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors,
              testing::AllOf(HasSubstr("exceeds its bound 0.00015"), HasSubstr("method: cvode")));
  EXPECT_FALSE(fs::exists(folder_ / "out/summary.json"));
  const Outcome other = Run("simulate " + scenario + " --set method=cvode -o out");
  EXPECT_EQ(other.status, 0) << other.errors;
}

TEST_F(Program, AStepThatWouldBeIgnoredIsAnError) {
  const std::string scenario = WriteScenario(folder_, "5e7 N/m");
  Outcome outcome = Run("simulate " + scenario + " --set method=cvode --set step='1 ms' -o out");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, testing::AllOf(HasSubstr("step: found"), HasSubstr("cvode")));
  const std::string car = std::string(KINGPIN_SOURCE_DIR) + "/examples/c_segment";
  outcome = Run("simulate " + car + " --set step='1 ms' -o out");  // it has dry friction
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, testing::ContainsRegex("step: found .*, expected at most 1e-05 s"));
}

TEST_F(Program, ModesPrintsATableAndTheStateSpace) {
  const std::string root = KINGPIN_SOURCE_DIR;
  const Outcome outcome = Run("modes " + root + "/examples/c_segment --json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const nlohmann::json json = nlohmann::json::parse(outcome.output);
  EXPECT_GE(json["free"]["modes"].size(), 5);
  EXPECT_GE(json["free"]["model"]["A"].size(), 10);
  EXPECT_EQ(json["held"]["model"]["A"].size(), json["free"]["model"]["A"].size() - 2);
  EXPECT_EQ(json["free"]["modes"][0]["shape"][0]["unit"], "m");
}

TEST_F(Program, UnusableInputEndsWithStatusTwoAndLeavesNothing) {
  const std::string study = WriteStudy();
  const struct {
    std::string arguments, message;
  } cases[] = {
      {"stdy " + study, "did you mean 'study'?"},
      {"study missing.yaml", "missing.yaml"},
      {"study " + study + " --set duration='1 kg'", "expected a time"},
      {"study " + study + " --set cases[0].variables.r_L.lower='0.5 m'",
       "more than the lower bound"},
      {"study " + study + " --set cases[0].variables.r_L.lower='0.3 m'", "start 0.25 m"},
      {"study " + study + " --set cases[0].stages[1].start=step1", "did you mean 'step 1'?"},
      {"study " + study + " --set cases[0].stages[0].free='[r_l]'", "did you mean 'r_L'?"},
      {"study " + study + " -o /proc/kingpin/out", "/proc"},
      {"optimise " + study + " --case 'case 3'", "did you mean 'case 2'?"},
  };
  for (const auto& c : cases) {
    const Outcome outcome = Run(c.arguments + (c.arguments.find("-o ") == std::string::npos &&
                                                       c.arguments.rfind("study", 0) == 0
                                                   ? " -o out"
                                                   : ""));
    EXPECT_EQ(outcome.status, 2) << c.arguments;
    EXPECT_THAT(outcome.errors, HasSubstr(c.message)) << c.arguments;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << c.arguments;
  }
}

}  // namespace
}  // namespace kingpin
