#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

// Which folder may include which, besides itself. The table of the design.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"core", {}},
    {"bodies", {"core"}},
    {"joints", {"core", "bodies"}},
    {"tire", {"core", "bodies", "joints"}},
    {"suspension", {"core", "bodies", "joints"}},
    {"steering", {"core", "bodies", "joints"}},
    {"models", {"core", "bodies", "joints", "tire", "suspension", "steering"}},
    {"optimisation", {"core", "bodies", "joints", "tire", "suspension", "steering", "models"}},
    {"apps",
     {"core", "bodies", "joints", "tire", "suspension", "steering", "models", "optimisation"}},
};

/// "core/io/units.h:12 includes models/planar/parameters.h", for every include that points the
/// wrong way.
std::vector<std::string> FindViolations(const fs::path& root) {
  const std::regex include(R"(^\s*#\s*include\s*["<]([a-z_]+)/([^">]+)[">])");
  std::vector<std::string> violations;
  for (const auto& [folder, allowed] : kMayInclude) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream file(entry.path());
      std::string line;
      for (int number = 1; std::getline(file, line); ++number) {
        std::smatch match;
        if (!std::regex_search(line, match, include)) continue;
        const std::string target = match[1];
        const bool ours = kMayInclude.count(target) > 0 || target == "tests" || target == "bench";
        if (!ours || target == folder || allowed.count(target) > 0) continue;
        violations.push_back(fs::relative(entry.path(), root).string() + ":" +
                             std::to_string(number) + " includes " + target + "/" + match[2].str());
      }
    }
  }
  return violations;
}

TEST(IncludeDirection, NoFolderIncludesOneAboveIt) {
  EXPECT_EQ(FindViolations(KINGPIN_SOURCE_DIR), std::vector<std::string>{});
}

TEST(IncludeDirection, AnIncludeThatPointsUpIsFound) {
  const fs::path root = fs::path(testing::TempDir()) / "include_direction";
  fs::create_directories(root / "core");
  std::ofstream(root / "core" / "wrong.h") << "#pragma once\n#include \"models/planar/model.h\"\n";
  EXPECT_EQ(FindViolations(root),
            std::vector<std::string>{"core/wrong.h:2 includes models/planar/model.h"});
  fs::remove_all(root);
}

}  // namespace
