#include "core/io/utf8.h"

#include <string>

#include <gtest/gtest.h>

#include "core/io/error.h"
#include "core/io/yaml_document.h"

namespace kingpin::io {
namespace {

TEST(Utf8, TextIsTakenUpToItsFirstWrongByte) {
  for (const char* good :
       {"", "abc", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
        "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF", "\xEF\xBB\xBFkind: a", "µ ° ²"}) {
    EXPECT_EQ(FindInvalidUtf8(good), std::nullopt) << good;
  }
  // bytes of the middle, overlong forms, surrogates, beyond U+10FFFF, cut short
  for (const char* bad :
       {"\x80", "\xBF", "\xC0\x80", "\xC1\xBF", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF",
        "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF", "\xC3", "\xC3x", "\xE2\x82", "\xE2\x82x",
        "\xF0\x90\x80", "\xF0\x90\x80x", "\xE4r"}) {
    EXPECT_EQ(FindInvalidUtf8(std::string("µm") + bad), 3U) << bad;
  }
}

TEST(Utf8, YamlInAnotherEncodingIsAnErrorWithItsLine) {
  try {
    ParseYaml("kind: car\nname: B\xFCrstner\n", "car.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "car.yaml:2: found the byte 0xFC, which is no UTF-8, expected a text file in "
                 "UTF-8");
  }
}

}  // namespace
}  // namespace kingpin::io
