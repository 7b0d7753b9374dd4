#include "tests/apps/program.h"

// The verbs that look at input: check, schema.
namespace kingpin {
namespace {

using testing::HasSubstr;

const std::string kRoot = KINGPIN_SOURCE_DIR;

TEST_F(Program, CheckPrintsEveryValueWithUnitAndOrigin) {
  const std::string file = WriteStudy();
  const Outcome text = Run("check " + file + " --set duration='1500 ms'");
  ASSERT_EQ(text.status, 0) << text.errors;
  EXPECT_THAT(text.output, HasSubstr("quick.yaml:8"));
  EXPECT_THAT(text.output, testing::ContainsRegex("duration +1.5 s +1500 ms +command line"));
  const Outcome json = Run("check " + file + " --json");
  ASSERT_EQ(json.status, 0) << json.errors;
  EXPECT_EQ(nlohmann::json::parse(json.output)["kind"], "study");
  const Outcome quiet = Run("check " + file + " --quiet");
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.output + quiet.errors, "");
  ASSERT_EQ(Run("check " + file + " -o echo.txt").output, "");
  EXPECT_THAT(ReadAll(folder_ / "echo.txt"), HasSubstr("quick.yaml:8"));
}

TEST_F(Program, CheckTakesTheFoldersThatOtherVerbsTake) {
  const Outcome both = Run("check " + kRoot + "/examples/c_segment --json");
  ASSERT_EQ(both.status, 0) << both.errors;
  const auto json = nlohmann::json::parse(both.output);
  ASSERT_EQ(json.size(), 2);
  EXPECT_EQ(json[0]["kind"], "study");
  EXPECT_EQ(json[1]["kind"], "scenario");
  EXPECT_EQ(Run("check " + kRoot + "/models/data/cars/c_segment --quiet").status, 0);
  const Outcome none = Run("check .");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("expected study.yaml, scenario.yaml or car.yaml"));
}

// What `study` would reject, `check` rejects, with the line of the key to blame, and `study` does
// before any work.
TEST_F(Program, CheckFindsWhatStudyWouldReject) {
  const std::string head = fmt::format(R"(kind: study
name: broken
measures: {{preset: paper_set}}
cases:
  - name: one
    model: {{paper_set: {}/examples/paper/set_C.json}}
    variables:
      r_L: {{lower: 0.2 m, upper: 0.4 m}}
      x_tr: {{lower: -0.1825 m, upper: -0.0825 m}}
    curves:
      assistance: {{fraction: 10 %, odd: false}}
    stages:
      - {{name: step 1, free: [r_L]}}
)",
                                       kRoot);
  const struct {
    std::string before, after, message;
  } cases[] = {
      {"name: step 1, free", "name: step 1, start: stp 0, free",
       "broken.yaml:13: cases[0].stages[0].start: found 'stp 0', expected the name of an earlier "
       "stage of the case"},
      {"free: [r_L]", "free: [r_l]",
       "broken.yaml:13: cases[0].stages[0].free: found 'r_l', expected the name of a design "
       "variable or curve; did you mean 'r_L'?"},
      {"free: [r_L]", "free: [longitudinal]",
       "broken.yaml:11: cases[0].curves.longitudinal: found nothing, expected how far the node "
       "values may move"},
      {"free: [r_L]", "free: [y_tr]",
       "broken.yaml:8: cases[0].variables.y_tr: found nothing, expected a lower and an upper "
       "bound"},
      {"free: [r_L]}", "free: [r_L]}\n      - {name: step 1}",
       "broken.yaml:14: cases[0].stages[1].name: found 'step 1' a second time"},
      {"free: [r_L]}", "free: [r_L]}\n    pareto: {free: [r_L, xtr]}",
       "broken.yaml:14: cases[0].pareto.free: found 'xtr', expected the name of a design variable "
       "or curve; did you mean 'x_tr'?"},
      {"lower: 0.2 m", "lower: 0.3 m",
       "broken.yaml:8: cases[0].variables.r_L: found start 0.25 m, expected a start within 0.3 .. "
       "0.4 m"},
      {"odd: false", "odd: true",
       "broken.yaml:11: cases[0].curves.assistance: found a curve that is not odd"},
      {"name: broken", "name: broken\nsample_interval: 0.3 ms",
       "broken.yaml:3: sample_interval: found 0.0003, expected a whole fraction of the duration"},
      {"name: broken", "name: broken\nduration: 10 ms",
       "broken.yaml:3: duration: found 0.01 s: the pulses of set C begin later"},
      {"preset: paper_set", "preset: paper_set, f1: 50 Hz, f2: 20 Hz",
       "broken.yaml:3: measures.f2: found 20, expected a frequency above f1"},
      {"free: [r_L]}",
       "free: [r_L]}\n    load_cases:\n      - name: late\n        pulses:\n          - {shape: "
       "half_sine, peak: 1 kN, start: 1 s, duration: 20 ms}",
       "broken.yaml:17: cases[0].load_cases[0].pulses[0].start: found 1 s: the pulse of load case "
       "'late' begins when the run is over, expected less than the duration, 1 s"},
      {"free: [r_L]}",
       "free: [r_L]}\n    load_cases:\n      - {name: flat, pulses: [{shape: half_sine, peak: 0, "
       "start: 0, duration: 20 ms}]}",
       "broken.yaml:15: cases[0].load_cases[0]: found load case 'flat' without any force"},
  };
  for (const auto& c : cases) {
    std::string text = head;
    text.replace(text.find(c.before), c.before.size(), c.after);
    Write("broken.yaml", text);
    for (const char* verb : {"check", "study", "optimise"}) {
      const Outcome outcome = Run(std::string(verb) + " broken.yaml");
      EXPECT_EQ(outcome.status, 2) << verb << ": " << c.after;
      EXPECT_THAT(outcome.errors, HasSubstr("kingpin: " + c.message)) << verb << ": " << c.after;
      EXPECT_FALSE(fs::exists(folder_ / "results")) << verb << ": " << c.after;
    }
  }
}

// What all cases inherit stands in one place and is reported once, with that place.
TEST_F(Program, AMistakeThatCasesInheritIsReportedOnce) {
  const Outcome outcome =
      Run("check " + kRoot + "/examples/c_segment/study.yaml --set variables.r_L.lower=0.35");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("study.yaml:24: variables.r_L: found start 0.33 m"));
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
}

TEST_F(Program, SchemaListsKindsAndPrintsEachAsJsonSchemaAndTable) {
  const Outcome kinds = Run("schema");
  ASSERT_EQ(kinds.status, 0) << kinds.errors;
  for (const std::string kind : {"study", "scenario", "car", "car_body", "front_suspension",
                                 "rear_suspension", "steering", "driveline", "tyres"}) {
    EXPECT_THAT(kinds.output, HasSubstr(kind + ": "));
    const Outcome outcome = Run("schema " + kind);
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    const auto json = nlohmann::json::parse(outcome.output);
    EXPECT_EQ(json["properties"]["kind"]["const"], kind);
    EXPECT_THAT(Run("schema " + kind + " --markdown").output, HasSubstr("| key | takes |"));
  }
  ASSERT_EQ(Run("schema car -o car.schema.json").output, "");
  EXPECT_TRUE(nlohmann::json::parse(ReadAll(folder_ / "car.schema.json")).contains("$schema"));
  const Outcome unknown = Run("schema studdy");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("did you mean 'study'?"));
}

}  // namespace
}  // namespace kingpin
