// Any text, read as YAML and through a schema with a field of every kind: ends in values or in an
// InputError that names the file, never in a crash, a hang or another exception. What was read can
// be echoed.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/io/error.h"
#include "core/io/schema.h"
#include "tests/core/io/example_schema.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kingpin;
  static const auto schema = io::example::MakeSchema();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  io::InputRecord record;
  try {
    io::ReadText(schema, text, "fuzz.yaml", {}, &record);
  } catch (const io::InputError& error) {
    for (const io::InputProblem& problem : error.problems()) {
      if (problem.file.empty() || (problem.found.empty() && problem.expected.empty())) std::abort();
    }
  }
  if (io::FormatRecordAsText(record).empty() || io::FormatRecordAsJson(record).empty())
    std::abort();
  try {
    io::ParseOverride(text);
  } catch (const io::InputError&) {
  }
  return 0;
}
