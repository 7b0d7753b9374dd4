#include "tests/apps/program.h"

namespace kingpin {
namespace {

using testing::HasSubstr;

TEST_F(Program, ValidateListsCasesWithTheirSources) {
  const Outcome list = Run("validate --list");
  ASSERT_EQ(list.status, 0) << list.errors;
  EXPECT_THAT(list.output, HasSubstr("A03  Andrews' squeezer"));
  EXPECT_THAT(list.output, HasSubstr("Hairer and Wanner"));
}

TEST_F(Program, ValidateRunsTheCasesAskedFor) {
  const Outcome text = Run("validate --case B01 --case A01");
  ASSERT_EQ(text.status, 0) << text.errors;
  EXPECT_THAT(text.output, HasSubstr("allowed  pass"));
  EXPECT_THAT(text.output, HasSubstr("checks of 2 cases pass"));
  const Outcome json = Run("validate --case B01 --json");
  ASSERT_EQ(json.status, 0) << json.errors;
  const auto parsed = nlohmann::json::parse(json.output);
  ASSERT_EQ(parsed.size(), 1);
  EXPECT_EQ(parsed[0]["case"], "B01");
  for (const auto& check : parsed[0]["checks"]) {
    EXPECT_TRUE(check["pass"].get<bool>());
    EXPECT_LE(check["error"].get<double>(), check["allowed"].get<double>());
  }
  const Outcome quiet = Run("validate --case B01 --quiet");
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.output + quiet.errors, "");
}

TEST_F(Program, ValidateNamesTheKnownCases) {
  const Outcome wrong = Run("validate --case B02");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("found 'B02', expected the name of a case"));
}

}  // namespace
}  // namespace kingpin
