#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace {

std::string RunCommand(const std::string& command) {
  std::string output;
  if (std::FILE* pipe = popen(command.c_str(), "r")) {
    std::array<char, 4096> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr) {
      output += line.data();
    }
    pclose(pipe);
  }
  return output;
}

// The linker keeps one of several weak symbols of a name. A weak symbol of a kernel that does not
// name its instruction set could therefore run on a machine that lacks it.
TEST(KernelSymbols, EveryWeakSymbolNamesItsInstructionSet) {
  if (RunCommand("nm --version 2>/dev/null").empty()) GTEST_SKIP() << "nm is not installed";
  for (const std::string isa : {"Portable", "Avx2", "Avx512"}) {
    const std::filesystem::path folder = std::filesystem::path(KINGPIN_BINARY_DIR) / "models" /
                                         "CMakeFiles" / ("kingpin_models_" + isa + ".dir") /
                                         "planar";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no object files in " << folder;
    std::string symbols;
    for (const char* kernel : {"batch", "runge_kutta", "adams", "adams_tangent", "events"}) {
      const std::filesystem::path object = folder / (std::string(kernel) + "_kernel.cpp.o");
      const std::string found = RunCommand("nm -C '" + object.string() + "'");
      ASSERT_FALSE(found.empty()) << object;
      symbols += found;
    }
    size_t begin = 0;
    while (begin < symbols.size()) {
      const size_t end = symbols.find('\n', begin);
      const std::string line = symbols.substr(begin, end - begin);
      begin = end + 1;
      // Address, kind, name; W, V and u may be merged by the linker.
      const bool weak = line.size() > 19 && (line[17] == 'W' || line[17] == 'V' || line[17] == 'u');
      // Sanitizers and the run-time library add data and reference symbols of their own.
      if (!weak || line.find("kingpin") == std::string::npos) continue;
      EXPECT_NE(line.find("isa::" + isa), std::string::npos) << line;
    }
  }
}

}  // namespace
