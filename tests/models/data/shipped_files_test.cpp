#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/io/input_kinds.h"
#include "core/io/yaml_document.h"
#include "models/parameters/input_kinds.h"
#include "tests/core/io/json_schema_checker.h"

namespace kingpin::io {
namespace {

// Two routes: the reader, and the exported JSON schema as an editor applies it. The studies and
// scenarios of examples/ are in tests/optimisation/study/shipped_examples_test.cpp.
TEST(ShippedFiles, FitTheReaderAndTheExportedSchema) {
  InputKinds kinds;
  parameters::AddInputKinds(&kinds);
  int count = 0;
  const std::filesystem::path root = std::filesystem::path(KINGPIN_SOURCE_DIR) / "models" / "data";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    const InputKind& kind = kinds.Detect(entry.path());
    EXPECT_FALSE(kind.read(entry.path(), {}).values.empty()) << entry.path();
    EXPECT_EQ(FindSchemaViolation(Json::parse(FormatJsonSchema(*kind.schema)),
                                  MakeJson(*ReadYaml(entry.path()))),
              "")
        << entry.path();
  }
  EXPECT_GE(count, 7);
}

}  // namespace
}  // namespace kingpin::io
