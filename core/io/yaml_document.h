#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// YAML with positions. The text is read event by event into nodes of our own, so that every node
/// knows its file and line, and hostile text ends in a message:
///
/// - a duplicate key, a key that is not plain text, and a second document are errors;
/// - anchors, aliases and merge keys (`<<`) work; an alias inside its own anchor is an error, and
/// so
///   is a document that aliases blow up to more than 200 000 nodes;
/// - more than 64 levels of nesting and files above 16 MiB are errors.
///
/// Everything is thrown as InputError with file and line.
namespace kingpin::io {

inline constexpr int kDeepestNesting = 64;
inline constexpr std::size_t kMostNodes = 200000;
inline constexpr std::size_t kLargestInputFile = std::size_t{16} << 20;

struct Node;
using NodePointer = std::shared_ptr<const Node>;

struct Node {
  enum class Kind { kNull, kScalar, kSequence, kMapping };

  struct Entry {
    std::string key;
    int line = 0;
    NodePointer value;
  };

  Kind kind = Kind::kNull;
  bool quoted = false;  ///< a scalar in quotes, which is text even if it reads `1`
  std::string text;     ///< of a scalar
  std::vector<NodePointer> items;
  std::vector<Entry> entries;
  std::shared_ptr<const std::string> file;  ///< as the user named it
  int line = 0;                             ///< counted from 1; 0 on the command line
  std::size_t node_count = 1;               ///< with all aliases expanded
  int height = 1;                           ///< levels of nesting below and with this node

  bool is_null() const { return kind == Kind::kNull; }
  bool is_scalar() const { return kind == Kind::kScalar; }
  bool is_sequence() const { return kind == Kind::kSequence; }
  bool is_mapping() const { return kind == Kind::kMapping; }
  const std::string& file_name() const { return *file; }

  /// The value of a key of a mapping, or null.
  const Node* Find(std::string_view key) const;
};

/// `a mapping`, `a list`, `nothing`, or the text in quotes: for messages.
std::string DescribeNode(const Node& node);

/// The node on one line in flow style, shortened to about `longest` characters.
std::string FormatNode(const Node& node, std::size_t longest = 120);

/// Reads one YAML document from text. `name` stands in messages. Empty text is a null node.
NodePointer ParseYaml(std::string_view text, const std::string& name);

/// Reads a file whole. An absent file, a directory, an unreadable one and one above `largest` bytes
/// each have a message of their own.
std::string ReadTextFile(const std::filesystem::path& path,
                         std::size_t largest = kLargestInputFile);

/// Reads a YAML file; one without content is an error.
NodePointer ReadYaml(const std::filesystem::path& path);

}  // namespace kingpin::io
