#include "tests/apps/program.h"

// Where results go, and whose files they may replace.
namespace kingpin {
namespace {

using testing::HasSubstr;

const std::string kCar = std::string(KINGPIN_SOURCE_DIR) + "/examples/c_segment";

TEST_F(Program, EveryVerbHasAPlaceOfItsOwn) {
  const std::string study = WriteStudy();
  ASSERT_EQ(Run("study " + study + " --quiet").status, 0);
  const std::string report = ReadAll(folder_ / "results/quick/report.html");
  ASSERT_FALSE(report.empty());
  Write("quick.yaml", fmt::format("kind: scenario\nname: quick\nmodel: {{paper_set: "
                                  "{}/examples/paper/set_C.json}}\n",
                                  KINGPIN_SOURCE_DIR));
  ASSERT_EQ(Run("simulate quick.yaml --quiet").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "results/quick_simulate/signals.csv"));
  EXPECT_EQ(ReadAll(folder_ / "results/quick/report.html"), report);
  ASSERT_EQ(Run("simulate " + kCar + " --quiet").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "results/c_segment_simulate/summary.json"));
}

TEST_F(Program, AVerbDoesNotReplaceTheResultOfAnother) {
  ASSERT_EQ(Run("simulate " + kCar + " --quiet -o out").status, 0);
  ASSERT_EQ(Run("simulate " + kCar + " --quiet -o out").status, 0);  // its own it does
  const Outcome study = Run("study " + WriteStudy() + " -o out");
  EXPECT_EQ(study.status, 2);
  EXPECT_THAT(study.errors, HasSubstr("out: found a result of 'simulate', expected a new or an "
                                      "empty folder, or an earlier result of 'study'"));
  EXPECT_TRUE(fs::exists(folder_ / "out/signals.csv"));
  // A folder is no file, and a file is no folder.
  EXPECT_THAT(Run("modes " + kCar + " -o out").errors, HasSubstr("Is a directory"));
  ASSERT_EQ(Run("modes " + kCar + " --quiet -o modes.json").status, 0);
  const Outcome simulate = Run("simulate " + kCar + " -o modes.json");
  EXPECT_EQ(simulate.status, 2);
  EXPECT_THAT(simulate.errors, HasSubstr("modes.json: found a file"));
}

// Whatever name the input goes by: -o must not replace it by what was made of it.
TEST_F(Program, AnInputIsNeverReplacedByTheOutput) {
  const std::string examples = std::string(KINGPIN_SOURCE_DIR) + "/examples";
  fs::copy_file(examples + "/urdf/arm.urdf", folder_ / "arm.urdf");
  Write("m.yaml", "kind: mechanism\nurdf: arm.urdf\n");
  Write("states.json", "{}");
  Write("signals.csv", "time,a\ns,m/s^2\n0,0\n0.1,1\n0.2,0\n");
  Write("weights.csv", "frequency,factor\nHz,1\n1,1\n100,1\n");
  Write("scenario.yaml",
        fmt::format("kind: scenario\nname: s\nmodel: {{paper_set: {}/paper/set_C.json}}\n",
                    examples));
  WriteStudy();
  fs::create_symlink("m.yaml", folder_ / "link.yaml");
  fs::create_hard_link(folder_ / "m.yaml", folder_ / "twin.yaml");
  fs::create_directory(folder_ / "sub");
  const std::vector<std::array<std::string, 2>> cases = {
      {"check m.yaml", "m.yaml"},
      {"check m.yaml", "sub/../m.yaml"},
      {"check m.yaml", "link.yaml"},
      {"check m.yaml", "twin.yaml"},
      {"check m.yaml", "arm.urdf"},
      {"modes m.yaml", "m.yaml"},
      {"modes m.yaml", "arm.urdf"},
      {"modes scenario.yaml", "scenario.yaml"},
      {"modes .", "scenario.yaml"},
      {"check .", "scenario.yaml"},
      {"optimise quick.yaml", "quick.yaml"},
      {"urdf arm.urdf", "arm.urdf"},
      {"urdf arm.urdf --evaluate states.json", "states.json"},
      {"urdf arm.urdf --evaluate states.json", "arm.urdf"},
      {"metrics signals.csv", "signals.csv"},
      {"metrics signals.csv --weighting weights.csv", "weights.csv"}};
  for (const auto& [command, output] : cases) {
    const std::string before = ReadAll(folder_ / output);
    ASSERT_FALSE(before.empty()) << output;
    const Outcome outcome = Run(command + " -o " + output);
    EXPECT_EQ(outcome.status, 2) << command << ", " << output;
    EXPECT_THAT(outcome.errors, HasSubstr(fmt::format(
                                    "command line: -o: found '{}', which is the input '", output)))
        << command;
    EXPECT_THAT(outcome.errors, HasSubstr("expected a file that is no input")) << command;
    EXPECT_EQ(ReadAll(folder_ / output), before) << command;
  }
  // beside them it may be written, and over what the verb wrote before
  EXPECT_EQ(Run("check m.yaml -o out.txt").status, 0);
  EXPECT_EQ(Run("check m.yaml -o out.txt").status, 0);
}

TEST_F(Program, NotesInAResultAreKept) {
  ASSERT_EQ(Run("simulate " + kCar + " --quiet -o out").status, 0);
  Write("out/notes.txt", "mine");
  const Outcome again = Run("simulate " + kCar + " --quiet -o out");
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.errors, HasSubstr("found 'notes.txt', which the earlier run did not write"));
  EXPECT_EQ(ReadAll(folder_ / "out/notes.txt"), "mine");
}

}  // namespace
}  // namespace kingpin
