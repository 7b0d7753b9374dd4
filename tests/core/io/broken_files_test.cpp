#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/csv.h"
#include "core/io/error.h"
#include "tests/core/io/example_schema.h"

// One file for each kind of mistake, with the message it must end in beside it: NAME.yaml and
// NAME.expected. KINGPIN_UPDATE_EXPECTED=1 writes the messages anew; read the difference before
// committing it.
namespace kingpin::io {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> FindFiles(const std::string& folder, const std::string& extension) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(KINGPIN_SOURCE_DIR) / folder)) {
    if (entry.path().extension() == extension) files.push_back(entry.path().filename());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string ReadAll(const fs::path& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Messages name files as the user did: run in their folder, so that they do not depend on where the
// source lies.
class InFolder {
 public:
  explicit InFolder(const std::string& folder) : before_(fs::current_path()) {
    fs::current_path(fs::path(KINGPIN_SOURCE_DIR) / folder);
  }
  ~InFolder() { fs::current_path(before_); }

 private:
  fs::path before_;
};

void Compare(const fs::path& file, const std::string& message) {
  fs::path expected = file;
  expected.replace_extension(".expected");
  if (std::getenv("KINGPIN_UPDATE_EXPECTED") != nullptr) std::ofstream(expected) << message << '\n';
  EXPECT_EQ(message + "\n", ReadAll(expected)) << file;
}

TEST(BrokenFiles, EachYamlMistakeHasItsMessage) {
  const std::string folder = "tests/core/io/broken";
  const InFolder in_folder(folder);
  const auto schema = example::MakeSchema();
  int count = 0;
  for (const fs::path& file : FindFiles(folder, ".yaml")) {
    if (file == "rack_of_wrong_unit.yaml") continue;  // included by another one
    ++count;
    try {
      ReadFile(schema, file);
      ADD_FAILURE() << file << " was read without an error";
    } catch (const InputError& error) {
      Compare(file, error.what());
      EXPECT_FALSE(error.problem().file.empty()) << file;
    }
  }
  EXPECT_GT(count, 60);
}

TEST(BrokenFiles, EachCsvMistakeHasItsMessage) {
  const std::string folder = "tests/core/io/broken_csv";
  const InFolder in_folder(folder);
  int count = 0;
  for (const fs::path& file : FindFiles(folder, ".csv")) {
    ++count;
    try {
      ReadSignals(file);
      ADD_FAILURE() << file << " was read without an error";
    } catch (const InputError& error) {
      Compare(file, error.what());
      EXPECT_FALSE(error.problem().file.empty()) << file;
    }
  }
  EXPECT_GT(count, 15);
}

// The parts of a problem one by one, for a few typical ones.
TEST(BrokenFiles, ProblemsHaveTheirParts) {
  const InFolder in_folder("tests/core/io/broken");
  const auto schema = example::MakeSchema();
  const auto read = [&schema](const char* file) -> InputProblem {
    try {
      ReadFile(schema, file);
    } catch (const InputError& error) {
      return error.problem();
    }
    return {};
  };
  const InputProblem key = read("unknown_key.yaml");
  EXPECT_EQ(key.file, "unknown_key.yaml");
  EXPECT_EQ(key.line, 3);
  EXPECT_EQ(key.key, "rack.mas");
  EXPECT_EQ(key.found, "an unknown key");
  EXPECT_EQ(key.suggestion, "did you mean 'mass'?");
  const InputProblem unit = read("wrong_dimension.yaml");
  EXPECT_EQ(unit.line, 3);
  EXPECT_EQ(unit.found, "'35 km' (a length)");
  EXPECT_EQ(unit.expected, "a mass in kg, such as '35 kg'");
  const InputProblem included = read("include_with_mistake.yaml");
  EXPECT_EQ(included.file, "rack_of_wrong_unit.yaml");
  EXPECT_EQ(included.line, 3);
  EXPECT_EQ(included.key, "rack.mass");
}

TEST(BrokenFiles, AllProblemsOfAFileAreReported) {
  const InFolder in_folder("tests/core/io/broken");
  try {
    ReadFile(example::MakeSchema(), "several.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 4u);
    EXPECT_TRUE(std::is_sorted(
        error.problems().begin(), error.problems().end(),
        [](const InputProblem& a, const InputProblem& b) { return a.line < b.line; }));
  }
}

TEST(BrokenFiles, PlacesThatHoldNoFileHaveTheirMessages) {
  const InFolder in_folder("tests/core/io");
  const auto message = [](const char* file) -> std::string {
    try {
      ReadFile(example::MakeSchema(), file);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(message("broken/syntx.yaml"),
            "broken/syntx.yaml: found no file of this name, expected an existing file; did you "
            "mean 'broken/syntax.yaml'?");
  EXPECT_EQ(message("nowhere/a.yaml"),
            "nowhere/a.yaml: found no file of this name, expected an existing file; its folder "
            "'nowhere' does not exist either");
  EXPECT_EQ(message("broken"), "broken: found a directory, expected a file");
}

TEST(BrokenFiles, WrongOverridesHaveTheirMessages) {
  const auto message = [](const char* set) -> std::string {
    try {
      ReadOptions options;
      options.overrides.push_back(ParseOverride(set));
      ReadText(example::MakeSchema(), "kind: steering\nrack: {mass: 2 kg}\n", "a.yaml", options);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(message("rack.mass=3 kg"), "");
  EXPECT_EQ(message("second_rack.mass=3 kg"), "");
  EXPECT_EQ(message("rack.mas=3 kg"),
            "command line: rack.mas: found a path that is not there, expected a key of this input; "
            "did you mean 'rack.mass'?");
  EXPECT_EQ(message("rack.mass=3 m"),
            "command line: rack.mass: found '3 m' (a length), expected a mass in kg, such as "
            "'35 kg'");
  EXPECT_EQ(message("rack.mass"),
            "command line: --set: found 'rack.mass', expected path=value, such as "
            "'steering.rack.mass=3 kg'");
  EXPECT_EQ(message("=3"),
            "command line: --set: found '=3', expected path=value, such as "
            "'steering.rack.mass=3 kg'");
  EXPECT_EQ(message("rack.mass=[3"),
            "command line: --set: found 'rack.mass=[3', expected a value after '=' that is YAML");
}

}  // namespace
}  // namespace kingpin::io
