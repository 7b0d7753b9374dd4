#include "core/io/yaml_document.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/io/error.h"

namespace kingpin::io {
namespace {

std::string Message(const std::string& text) {
  try {
    ParseYaml(text, "a.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(YamlDocument, EveryNodeKnowsItsLine) {
  const NodePointer root =
      ParseYaml("a: 1\n\nb:\n  - x\n  - {c: 2,\n     d: 3}\ne:\nf: 4\n", "a.yaml");
  EXPECT_EQ(root->Find("a")->line, 1);
  const Node* list = root->Find("b");
  EXPECT_EQ(list->items[0]->line, 4);
  EXPECT_EQ(list->items[1]->Find("d")->line, 6);
  EXPECT_EQ(root->Find("e")->line, 7);
  EXPECT_TRUE(root->Find("e")->is_null());
  EXPECT_EQ(root->Find("f")->file_name(), "a.yaml");
  EXPECT_EQ(root->Find("g"), nullptr);
}

TEST(YamlDocument, MergedKeysYieldToTheMappingsOwn) {
  const NodePointer root = ParseYaml(
      "base: &base {a: 1, b: 2}\nother: {<<: *base, b: 3}\n"
      "both: {<<: [*base, {a: 9, c: 4}]}\n",
      "a.yaml");
  EXPECT_EQ(root->Find("other")->Find("a")->text, "1");
  EXPECT_EQ(root->Find("other")->Find("b")->text, "3");
  EXPECT_EQ(root->Find("both")->Find("a")->text, "1");
  EXPECT_EQ(root->Find("both")->Find("c")->text, "4");
}

TEST(YamlDocument, AliasesCountAsOftenAsTheyAreUsed) {
  const NodePointer root = ParseYaml("a: &a [1, 2, 3]\nb: [*a, *a]\n", "a.yaml");
  // Root, a and its three, b and twice a with its three; keys do not count.
  EXPECT_EQ(root->node_count, 1u + 4u + 1u + 8u);
  EXPECT_EQ(root->height, 4);
}

TEST(YamlDocument, NestingByAliasesIsLimitedToo) {
  std::string text = "a0: &a0 [1]\n";
  for (int i = 1; i < 80; ++i) {
    text += fmt::format("a{0}: &a{0} [*a{1}]\n", i, i - 1);
  }
  EXPECT_EQ(Message(text),
            "a.yaml:63: found more than 64 levels of nesting, expected a flatter file");
}

TEST(YamlDocument, DuplicateKeysNameTheirPath) {
  EXPECT_EQ(Message("cases:\n  - a: 1\n  - b: {c: 1}\n    b: 2\n"),
            "a.yaml:4: cases[1].b: found the key a second time, expected each key once; it stands "
            "in line 3 already");
}

TEST(YamlDocument, HugeTextIsRefused) {
  EXPECT_EQ(Message(std::string(kLargestInputFile + 1, ' ')),
            "a.yaml: found 16777217 bytes, expected at most 16777216 bytes");
}

TEST(YamlDocument, QuotedTextIsMarked) {
  const NodePointer root = ParseYaml("a: '1'\nb: 1\n", "a.yaml");
  EXPECT_TRUE(root->Find("a")->quoted);
  EXPECT_FALSE(root->Find("b")->quoted);
}

TEST(YamlDocument, FormatIsFlowStyleAndShort) {
  const NodePointer root = ParseYaml("a: [1, {b: 2}]\n", "a.yaml");
  EXPECT_EQ(FormatNode(*root), "{a: [1, {b: 2}]}");
  EXPECT_EQ(FormatNode(*root, 6), "{a: [1...");
}

}  // namespace
}  // namespace kingpin::io
