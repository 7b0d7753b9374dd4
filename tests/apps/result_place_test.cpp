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
