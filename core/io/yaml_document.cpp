#include "core/io/yaml_document.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <istream>
#include <map>
#include <optional>
#include <streambuf>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/node/node.h>
#include <yaml-cpp/parser.h>

#include "core/io/error.h"
#include "core/io/nearest_name.h"
#include "core/io/utf8.h"

namespace kingpin::io {
namespace {

int LineOf(const YAML::Mark& mark) { return mark.line < 0 ? 0 : mark.line + 1; }

class ViewBuffer : public std::streambuf {
 public:
  explicit ViewBuffer(std::string_view text) {
    char* begin = const_cast<char*>(text.data());  // std::streambuf asks for it and only reads
    setg(begin, begin, begin + text.size());
  }
};

// Builds the nodes from the parser's events.
class NodeBuilder : public YAML::EventHandler {
 public:
  explicit NodeBuilder(std::shared_ptr<const std::string> file) : file_(std::move(file)) {}

  NodePointer TakeRoot() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Add(MakeNode(Node::Kind::kNull, mark), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      Fail(LineOf(mark), "an alias inside the node that its anchor names",
           "an alias to a node that is complete");
    }
    Place(found->second, LineOf(mark));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    std::shared_ptr<Node> node = MakeNode(Node::Kind::kScalar, mark);
    node->text = value;
    node->quoted = tag != "?";
    Add(std::move(node), anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Open(MakeNode(Node::Kind::kSequence, mark), anchor);
  }
  void OnSequenceEnd() override { Close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    Open(MakeNode(Node::Kind::kMapping, mark), anchor);
  }
  void OnMapEnd() override {
    MergeInto(open_.back().node.get());
    Close();
  }

 private:
  struct Level {
    std::shared_ptr<Node> node;
    YAML::anchor_t anchor = 0;
    bool has_key = false;
    std::string key;
    int key_line = 0;
    std::map<std::string, int, std::less<>> line_of_key;
    std::vector<std::pair<NodePointer, int>> merged;
  };

  [[noreturn]] void Fail(int line, std::string found, std::string expected,
                         std::string suggestion = {}) const {
    throw InputError(InputProblem{.file = *file_,
                                  .line = line,
                                  .found = std::move(found),
                                  .expected = std::move(expected),
                                  .suggestion = std::move(suggestion)});
  }

  std::shared_ptr<Node> MakeNode(Node::Kind kind, const YAML::Mark& mark) const {
    auto node = std::make_shared<Node>();
    node->kind = kind;
    node->file = file_;
    node->line = LineOf(mark);
    return node;
  }

  void Open(std::shared_ptr<Node> node, YAML::anchor_t anchor) {
    const int line = node->line;
    if (!open_.empty() && open_.back().node->is_mapping() && !open_.back().has_key) {
      Fail(line, DescribeNode(*node) + " as a key", "a plain key");
    }
    if (open_.size() + 1 > kDeepestNesting) FailDepth(line);
    Level& level = open_.emplace_back();
    level.node = std::move(node);
    level.anchor = anchor;
  }

  [[noreturn]] void FailDepth(int line) const {
    Fail(line, fmt::format("more than {} levels of nesting", kDeepestNesting), "a flatter file");
  }

  void Close() {
    Level level = std::move(open_.back());
    open_.pop_back();
    Add(std::move(level.node), level.anchor);
  }

  void Add(std::shared_ptr<Node> node, YAML::anchor_t anchor) {
    const int line = node->line;
    NodePointer complete = std::move(node);
    if (anchor != 0) anchors_[anchor] = complete;
    Place(complete, line);
  }

  void Place(const NodePointer& node, int line) {
    if (open_.empty()) {
      root_ = node;
      return;
    }
    Level& level = open_.back();
    if (level.node->is_mapping() && !level.has_key) {
      if (!node->is_scalar()) Fail(line, DescribeNode(*node) + " as a key", "a plain key");
      level.has_key = true;
      level.key = node->text;
      level.key_line = line;
      return;
    }
    Node& parent = *level.node;
    parent.node_count += node->node_count;
    parent.height = std::max(parent.height, node->height + 1);
    if (parent.node_count > kMostNodes) {
      Fail(line, fmt::format("more than {} values after aliases are expanded", kMostNodes),
           "a smaller file");
    }
    if (parent.height + static_cast<int>(open_.size()) - 1 > kDeepestNesting) FailDepth(line);
    if (parent.is_sequence()) {
      parent.items.push_back(node);
      return;
    }
    level.has_key = false;
    if (node->is_null() && node->line != level.key_line) {
      // The parser notices that nothing stands there only at the next token.
      auto moved = std::make_shared<Node>(*node);
      moved->line = level.key_line;
      PlaceValue(&level, std::move(moved), line);
      return;
    }
    PlaceValue(&level, node, line);
  }

  void PlaceValue(Level* level_pointer, const NodePointer& node, int line) {
    Level& level = *level_pointer;
    Node& parent = *level.node;
    if (level.key == "<<") {
      level.merged.emplace_back(node, line);
      return;
    }
    const auto [known, is_new] = level.line_of_key.emplace(level.key, level.key_line);
    if (!is_new) {
      throw InputError(
          InputProblem{.file = *file_,
                       .line = level.key_line,
                       .key = MakePath(),
                       .found = "the key a second time",
                       .expected = "each key once",
                       .suggestion = fmt::format("it stands in line {} already", known->second)});
    }
    parent.entries.push_back(Node::Entry{level.key, level.key_line, node});
  }

  // Of the key that was read last, e.g. `load_cases[1].speed`.
  std::string MakePath() const {
    std::string path;
    for (const Level& level : open_) {
      if (level.node->is_mapping()) {
        path += (path.empty() ? "" : ".") + level.key;
      } else {
        path += fmt::format("[{}]", level.node->items.size());
      }
    }
    return path;
  }

  // Merge keys: what the mapping says itself wins over what is merged, earlier merges over later.
  void MergeInto(Node* node) {
    Level& level = open_.back();
    for (const auto& [value, line] : level.merged) {
      std::vector<NodePointer> sources = {value};
      if (value->is_sequence()) sources = value->items;
      for (const NodePointer& source : sources) {
        if (!source->is_mapping()) {
          Fail(line, DescribeNode(*source) + " to merge", "an alias of a mapping after '<<:'");
        }
        for (const Node::Entry& entry : source->entries) {
          if (level.line_of_key.emplace(entry.key, entry.line).second) {
            node->entries.push_back(entry);
          }
        }
      }
    }
  }

  std::shared_ptr<const std::string> file_;
  std::vector<Level> open_;
  std::map<YAML::anchor_t, NodePointer> anchors_;
  NodePointer root_;
};

void AppendNode(const Node& node, std::size_t longest, std::string* text) {
  if (text->size() > longest) return;
  switch (node.kind) {
    case Node::Kind::kNull:
      *text += "~";
      return;
    case Node::Kind::kScalar:
      *text += node.text;
      return;
    case Node::Kind::kSequence:
      *text += "[";
      for (std::size_t i = 0; i < node.items.size() && text->size() <= longest; ++i) {
        if (i > 0) *text += ", ";
        AppendNode(*node.items[i], longest, text);
      }
      *text += "]";
      return;
    case Node::Kind::kMapping:
      *text += "{";
      for (std::size_t i = 0; i < node.entries.size() && text->size() <= longest; ++i) {
        if (i > 0) *text += ", ";
        *text += node.entries[i].key + ": ";
        AppendNode(*node.entries[i].value, longest, text);
      }
      *text += "}";
      return;
  }
}

// Whether line `last` (counted from 0) or one before it is indented by a tab.
bool HasTabBefore(std::string_view text, int last) {
  for (int line = 0; line <= last && !text.empty(); ++line) {
    const std::size_t indented = text.find_first_not_of(' ');
    if (indented != std::string_view::npos && text[indented] == '\t') return true;
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return false;
    text.remove_prefix(end + 1);
  }
  return false;
}

}  // namespace

const Node* Node::Find(std::string_view key) const {
  for (const Entry& entry : entries) {
    if (entry.key == key) return entry.value.get();
  }
  return nullptr;
}

std::string DescribeNode(const Node& node) {
  switch (node.kind) {
    case Node::Kind::kNull:
      return "nothing";
    case Node::Kind::kScalar:
      return fmt::format("'{}'", FormatNode(node, 60));
    case Node::Kind::kSequence:
      return "a list";
    case Node::Kind::kMapping:
      return "a mapping";
  }
  return {};
}

std::string FormatNode(const Node& node, std::size_t longest) {
  std::string text;
  AppendNode(node, longest, &text);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  if (text.size() > longest) {
    text.resize(longest);
    // Do not cut a character of several bytes in two.
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) {
      text.pop_back();
    }
    if (!text.empty() && static_cast<unsigned char>(text.back()) >= 0xC0) text.pop_back();
    text += "...";
  }
  return text;
}

NodePointer ParseYaml(std::string_view text, const std::string& name) {
  const auto fail = [&name](int line, std::string found, std::string expected,
                            std::string suggestion = {}) {
    throw InputError(InputProblem{.file = name,
                                  .line = line,
                                  .found = std::move(found),
                                  .expected = std::move(expected),
                                  .suggestion = std::move(suggestion)});
  };
  if (text.size() > kLargestInputFile) {
    fail(0, fmt::format("{} bytes", text.size()),
         fmt::format("at most {} bytes", kLargestInputFile));
  }
  const auto line_of = [&text](std::size_t at) {
    return 1 +
           static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
  };
  if (const std::size_t at = text.find('\0'); at != std::string_view::npos) {
    fail(line_of(at), "a zero byte", "a text file in UTF-8");
  }
  if (const std::optional<std::size_t> at = FindInvalidUtf8(text)) {
    fail(line_of(*at),
         fmt::format("the byte 0x{:02X}, which is no UTF-8", static_cast<unsigned char>(text[*at])),
         "a text file in UTF-8");
  }
  const auto file = std::make_shared<const std::string>(name);
  NodeBuilder builder(file);
  try {
    ViewBuffer buffer(text);
    std::istream stream(&buffer);
    YAML::Parser parser(stream);
    if (parser.HandleNextDocument(builder)) {
      NodePointer root = builder.TakeRoot();
      NodeBuilder second(file);
      if (parser.HandleNextDocument(second)) {
        const NodePointer other = second.TakeRoot();
        fail(other ? other->line : 0, "a second document", "one document in a file");
      }
      if (root) return root;
    }
  } catch (const YAML::Exception& error) {
    fail(LineOf(error.mark), "a mistake in the YAML (" + error.msg + ")", "YAML 1.2",
         HasTabBefore(text, error.mark.line) ? "indent by blanks, not by tabs" : "");
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // the library lets some through on malformed text
    fail(0, std::string("text that is not YAML (") + error.what() + ")", "YAML 1.2");
  }
  auto empty = std::make_shared<Node>();
  empty->file = file;
  empty->line = 1;
  return empty;
}

std::string ReadTextFile(const std::filesystem::path& path, std::size_t largest) {
  const auto fail = [&path](std::string found, std::string expected, std::string suggestion = {}) {
    throw InputError(InputProblem{.file = path.string(),
                                  .found = std::move(found),
                                  .expected = std::move(expected),
                                  .suggestion = std::move(suggestion)});
  };
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    const int reason = errno;
    if (reason != ENOENT && reason != ENOTDIR) {
      fail(fmt::format("a file that cannot be opened ({})", std::strerror(reason)),
           "a readable file");
    }
    std::error_code ignored;
    const std::filesystem::path parent =
        path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(parent, ignored)) {
      fail("no file of this name", "an existing file",
           fmt::format("its folder '{}' does not exist either", parent.string()));
    }
    std::vector<std::string> names;
    constexpr std::size_t kMostNames = 1000;
    for (auto entry = std::filesystem::directory_iterator(parent, ignored);
         entry != std::filesystem::directory_iterator() && names.size() < kMostNames;
         entry.increment(ignored)) {
      names.push_back(entry->path().filename().string());
    }
    const std::string nearest = FindNearestName(path.filename().string(), names);
    fail("no file of this name", "an existing file",
         nearest.empty()
             ? ""
             : fmt::format("did you mean '{}'?", (path.parent_path() / nearest).string()));
  }
  struct Closer {
    int descriptor;
    ~Closer() { ::close(descriptor); }
  } const closer{descriptor};
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode)) {
    fail("a directory", "a file");
  }
  std::string text;
  std::vector<char> buffer(std::size_t{1} << 16);
  while (true) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      fail(fmt::format("a file that cannot be read ({})", std::strerror(errno)), "a readable file");
    }
    if (count == 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
    if (text.size() > largest) {
      fail(fmt::format("more than {} bytes", largest), fmt::format("at most {} bytes", largest));
    }
  }
}

NodePointer ReadYaml(const std::filesystem::path& path) {
  const std::string text = ReadTextFile(path);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError(InputProblem{
        .file = path.string(), .found = "an empty file", .expected = "a YAML mapping"});
  }
  NodePointer root = ParseYaml(text, path.string());
  if (root->is_null()) {
    throw InputError(
        InputProblem{.file = path.string(), .found = "no values", .expected = "a YAML mapping"});
  }
  return root;
}

}  // namespace kingpin::io
