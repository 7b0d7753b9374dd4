// docs/mechanisms.md as a reader follows it: files saved under the names in their first lines,
// commands typed, and what is printed compared with the page.
#include <cmath>
#include <cstdlib>

#include "tests/apps/program.h"

namespace kingpin {
namespace {

struct Block {
  std::string language, text;
  int line = 0;
};

std::vector<Block> ReadBlocks(const fs::path& page) {
  std::vector<Block> blocks;
  std::ifstream file(page);
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (!line.starts_with("```")) {
      if (inside) blocks.back().text += line + '\n';
      continue;
    }
    inside = !inside;
    if (inside) blocks.push_back({line.substr(3), "", number});
  }
  return blocks;
}

// Words are the same; numbers agree to 2 % or are both small enough to be rounding.
void ExpectSamePrint(const std::string& printed, const std::string& shown,
                     const std::string& what) {
  std::istringstream left(printed), right(shown);
  std::string a, b;
  while (true) {
    const bool has_a = static_cast<bool>(left >> a), has_b = static_cast<bool>(right >> b);
    ASSERT_EQ(has_a, has_b) << what << "\nprinted:\n" << printed << "\nshown:\n" << shown;
    if (!has_a) return;
    char *end_a = nullptr, *end_b = nullptr;
    const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
    if (end_a == a.c_str() || end_b == b.c_str()) {
      EXPECT_EQ(a, b) << what;
      continue;
    }
    EXPECT_STREQ(end_a, end_b) << what;
    const bool both_small = std::abs(x) < 1e-6 && std::abs(y) < 1e-6;
    EXPECT_TRUE(both_small || std::abs(x - y) <= 0.02 * std::abs(y))
        << what << ": " << a << ", " << b;
  }
}

class Documentation : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    fs::create_directories(folder_ / "bin");
    fs::create_symlink(KINGPIN_PROGRAM, folder_ / "bin/kingpin");
    fs::create_symlink(KINGPIN_FOUR_BAR, folder_ / "bin/four_bar");
  }

  // `$ COMMAND` and the lines below it.
  void FollowCommands(const Block& block) const {
    std::istringstream lines(block.text);
    std::string command, shown;
    const auto run = [&] {
      if (command.empty()) return;
      const std::string place = fmt::format("docs/mechanisms.md:{}: {}", block.line, command);
      const fs::path out = folder_ / "printed";
      const int status =
          std::system(fmt::format("cd '{0}' && PATH='{0}/bin':\"$PATH\" && {{ {1}; }} >'{2}' 2>&1",
                                  folder_.string(), command, out.string())
                          .c_str());
      EXPECT_TRUE(WIFEXITED(status)) << place;
      ExpectSamePrint(WithoutSanitizerNotes(ReadAll(out)), shown, place);
      shown.clear();
    };
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("$ ")) {
        run();
        command = line.substr(2);
      } else {
        shown += line + '\n';
      }
    }
    run();
  }
};

TEST_F(Documentation, MechanismsPageRunsAsPrinted) {
  int files = 0, commands = 0, programs = 0;
  for (const Block& block : ReadBlocks(fs::path(KINGPIN_SOURCE_DIR) / "docs/mechanisms.md")) {
    if (block.language == "yaml" || block.language == "xml") {
      // "# NAME: ..." or "<!-- NAME: ..."
      const size_t begin = block.text.find_first_not_of("#<!- "), end = block.text.find(':');
      ASSERT_NE(end, std::string::npos) << block.line;
      Write(block.text.substr(begin, end - begin), block.text);
      ++files;
    } else if (block.language == "cpp") {
      EXPECT_EQ(block.text,
                ReadAll(fs::path(KINGPIN_SOURCE_DIR) / "examples/mechanisms/four_bar.cpp"));
      ++programs;
    } else {
      ASSERT_EQ(block.language, "sh") << block.line;
      FollowCommands(block);
      ++commands;
    }
  }
  EXPECT_EQ(files, 4);
  EXPECT_EQ(programs, 1);
  EXPECT_EQ(commands, 6);
  // what the page promises beside the printed lines
  for (const char* name : {"signals.csv", "summary.json", "report.html"}) {
    EXPECT_TRUE(fs::exists(folder_ / "results/four_bar_simulate" / name)) << name;
  }
  const nlohmann::json modes = nlohmann::json::parse(ReadAll(folder_ / "arm.json"));
  EXPECT_EQ(Run("modes arm.yaml -o arm.html").status, 0);
  EXPECT_NE(ReadAll(folder_ / "arm.html").find("compliance: elbow_motor to elbow"),
            std::string::npos);
  for (const char* key : {"A", "B", "C", "D", "inputs", "outputs", "frequency_responses"}) {
    EXPECT_TRUE(modes.contains(key)) << key;
  }
}

// Every key of the schema stands in docs/formats.md as `kingpin schema` prints it.
TEST_F(Documentation, EveryKeyOfAMechanismFileIsInFormats) {
  const Outcome schema = Run("schema mechanism --markdown");
  ASSERT_EQ(schema.status, 0);
  const std::string formats = ReadAll(fs::path(KINGPIN_SOURCE_DIR) / "docs/formats.md");
  std::istringstream lines(schema.output);
  int keys = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    std::string key = line.substr(3, line.find('`', 3) - 3);
    // within a section: what stands behind NAME. or [i].
    const size_t cut = key.find_last_of('.');
    if (cut != std::string::npos) key = key.substr(cut + 1);
    EXPECT_NE(formats.find('`' + key + '`'), std::string::npos) << line;
    ++keys;
  }
  EXPECT_GT(keys, 100);
}

// A page that a browser shows without network, with everything the run has.
TEST_F(Documentation, TheReportOfAMechanismHoldsItsPlots) {
  const Outcome outcome = Run(
      fmt::format("simulate '{}/examples/mechanisms/stick_slip.yaml' -o out", KINGPIN_SOURCE_DIR));
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string page = ReadAll(folder_ / "out/report.html");
  for (const char* text : {"<h1>block on a belt</h1>", "Degrees of freedom", "Coordinates",
                           "Energy, momentum and residuals", "Reactions", "Dry friction", "sticks",
                           "slides backwards", "<svg", "</html>"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(page.find("http://"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace kingpin
