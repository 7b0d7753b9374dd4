#include "core/io/input_kinds.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/io/error.h"
#include "core/io/output_file.h"
#include "tests/core/io/example_schema.h"

namespace kingpin::io {
namespace {

TEST(InputKinds, AFileSaysWhatItIs) {
  InputKinds kinds;
  bool is_checked = false;
  kinds.Add<example::Steering>(example::MakeSchema(), [&is_checked](const example::Steering& read) {
    is_checked = read.rack.mass == 2.0;
  });
  EXPECT_THROW(kinds.Add(example::MakeSchema()), std::logic_error);
  const auto file = std::filesystem::temp_directory_path() /
                    ("kingpin-kinds-" + std::to_string(::getpid()) + ".yaml");
  const auto message = [&](const char* text) -> std::string {
    WriteFileAtomically(file, text);
    try {
      kinds.Detect(file).read(file, {});
    } catch (const InputError& error) {
      std::string what = error.what();
      return what.replace(0, file.string().size(), "FILE");
    }
    return "";
  };
  EXPECT_EQ(message("kind: steering\nrack: {mass: 2 kg}\n"), "");
  EXPECT_TRUE(is_checked);
  EXPECT_EQ(message("\nkind: stering\n"),
            "FILE:2: kind: found 'stering', expected a kind of input at the top of the file, such "
            "as 'kind: car'; did you mean 'steering'?");
  EXPECT_EQ(message("rack: 3\n"),
            "FILE:1: kind: found nothing, expected a kind of input at the top of the file, such as "
            "'kind: car'; known kinds: steering");
  EXPECT_EQ(message("- 3\n"),
            "FILE:1: found a list, expected a mapping that begins with its kind, such as 'kind: "
            "car'");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace kingpin::io
