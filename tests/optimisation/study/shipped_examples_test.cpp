#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/io/yaml_document.h"
#include "models/parameters/input_kinds.h"
#include "optimisation/study/study_schema.h"
#include "tests/core/io/json_schema_checker.h"

namespace kingpin::study {
namespace {

// Two routes: the reader with all its checks, and the exported JSON schema as an editor applies it.
// Mechanisms are no kind of input that a study's folder knows.
TEST(ShippedExamples, FitTheReaderAndTheExportedSchema) {
  io::InputKinds kinds;
  parameters::AddInputKinds(&kinds);
  AddInputKinds(&kinds);
  int count = 0;
  const std::filesystem::path root = std::filesystem::path(KINGPIN_SOURCE_DIR) / "examples";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".yaml") continue;
    if (entry.path().parent_path().filename() == "mechanisms") continue;
    ++count;
    const io::InputKind& kind = kinds.Detect(entry.path());
    EXPECT_FALSE(kind.read(entry.path(), {}).values.empty()) << entry.path();
    EXPECT_EQ(io::FindSchemaViolation(io::Json::parse(io::FormatJsonSchema(*kind.schema)),
                                      io::MakeJson(*io::ReadYaml(entry.path()))),
              "")
        << entry.path();
  }
  EXPECT_GE(count, 3);
}

// An editor loads it with every file.
TEST(ShippedSchemas, StaySmall) {
  io::InputKinds kinds;
  parameters::AddInputKinds(&kinds);
  AddInputKinds(&kinds);
  for (const io::InputKind& kind : kinds.kinds()) {
    EXPECT_LT(io::FormatJsonSchema(*kind.schema).size(), 150000u) << kind.name;
  }
}

}  // namespace
}  // namespace kingpin::study
