#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

/// The program run as a user runs it, each test in a folder of its own.
namespace kingpin {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;
  std::string output, errors;
};

inline std::string ReadAll(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The address sanitizer remarks that it cannot follow fibres; that is not the program's text.
inline std::string WithoutSanitizerNotes(const std::string& text) {
  std::string kept;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("==")) kept += line + '\n';
  }
  return kept;
}

class Program : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        (std::string("program_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// `wrapper` is a command that runs the program.
  Outcome Run(const std::string& arguments, const std::string& wrapper = "") const {
    const fs::path out = folder_ / "stdout", err = folder_ / "stderr";
    const std::string command =
        fmt::format("cd '{}' && {} '{}' {} >'{}' 2>'{}'", folder_.string(), wrapper,
                    KINGPIN_PROGRAM, arguments, out.string(), err.string());
    const int raw = std::system(command.c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, ReadAll(out),
            WithoutSanitizerNotes(ReadAll(err))};
  }

  nlohmann::json Summary(const std::string& folder) const {
    return nlohmann::json::parse(ReadAll(folder_ / folder / "summary.json"));
  }

  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return name;
  }

  /// A study of paper set C that takes a second.
  std::string WriteStudy() const {
    return Write("quick.yaml", fmt::format(R"(kind: study
name: quick
measures: {{preset: paper_set}}
cases:
  - name: case 2
    model: {{paper_set: {}/examples/paper/set_C.json}}
    variables:
      r_L: {{lower: 0.2 m, upper: 0.4 m}}
      x_tr: {{lower: -0.1825 m, upper: -0.0825 m}}
    curves:
      assistance: {{fraction: 10 %}}
    stages:
      - {{name: step 1, free: [r_L, x_tr], algorithm: nelder_mead, max_evaluations: 60}}
      - {{name: step 2, start: step 1, free: [assistance], algorithm: slsqp, max_evaluations: 60}}
    pareto: {{free: [r_L, x_tr], population: 8, generations: 3}}
    printed:
      - {{stage: initial, table: Table 3, gamma_1: 19243.9}}
)",
                                           KINGPIN_SOURCE_DIR));
  }

  fs::path folder_;
};

}  // namespace kingpin
