#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/io/field_text.h"
#include "core/io/nearest_name.h"
#include "core/io/schema_core.h"
#include "core/io/table_reader.h"
#include "core/io/value_reader.h"

namespace kingpin::io {
namespace {

constexpr const char* kCertainties[] = {"P", "S", "D", "K", "E"};

// What a mapping says about all values below it.
struct Provenance {
  std::string source;
  std::string certainty;
  std::string note;
};

class Reader : private ValueReader {
 public:
  Reader(const ReadOptions& options, InputRecord* record)
      : options_(options), used_(options.overrides.size(), false), record_(record) {}

  void ReadRoot(const SchemaCore& schema, const Node& root, void* object) {
    record_->kind = schema.name();
    ReadMapping(schema, root, "", object, Provenance{}, true);
    for (std::size_t i = 0; i < options_.overrides.size(); ++i) {
      if (used_[i]) continue;
      const Override& override_ = options_.overrides[i];
      const Node& node = *override_.value;
      Note(node, override_.path, "a path that is not there", "a key of this input",
           SuggestName(override_.path, known_paths_, "paths"));
    }
    if (!problems_.empty()) {
      // Files in the order read, and the lines of each in order: as a compiler would list them.
      std::stable_sort(problems_.begin(), problems_.end(),
                       [](const InputProblem& a, const InputProblem& b) {
                         return a.file == b.file && a.line < b.line;
                       });
      throw InputError(std::move(problems_));
    }
  }

 private:
  // A value and what was said about it.
  struct Written {
    const Node* value = nullptr;
    Unit unit;  // of bare numbers
    bool has_unit = false;
    ValueOrigin origin;
  };

  class SectionCheck : public Check {
   public:
    SectionCheck(Reader* reader, std::string prefix)
        : reader_(reader), prefix_(std::move(prefix)) {}
    void Fail(std::string_view key, std::string found, std::string expected,
              std::string suggestion) override {
      const std::string path = Join(prefix_, key);
      reader_->Note(reader_->FindPlace(path), path, std::move(found), std::move(expected),
                    std::move(suggestion));
    }
    void Add(std::string_view key, const InputError& error) override {
      for (InputProblem problem : error.problems()) {
        if (problem.file.empty()) {
          problem.key = Join(Join(prefix_, key), problem.key);
          const Place place = reader_->FindPlace(problem.key);
          problem.file = place.file;
          problem.line = place.line;
        }
        reader_->Note(std::move(problem));
      }
    }

   private:
    static std::string Join(const std::string& prefix, std::string_view key) {
      return key.empty() ? prefix : Below(prefix, key);
    }

    Reader* reader_;
    std::string prefix_;
  };

  Place FindPlace(std::string path) const {
    while (true) {
      if (const auto found = places_.find(path); found != places_.end()) return found->second;
      const std::size_t cut = path.find_last_of(".[");
      if (cut == std::string::npos) break;
      path.resize(cut);
    }
    const auto root = places_.find("");
    return root == places_.end() ? Place{} : root->second;
  }

  const Node* FindOverride(const std::string& path) {
    const Node* found = nullptr;
    for (std::size_t i = 0; i < options_.overrides.size(); ++i) {
      if (options_.overrides[i].path != path) continue;
      used_[i] = true;
      found = options_.overrides[i].value.get();
    }
    return found;
  }

  bool HasOverrideBelow(const std::string& path) const {
    return std::any_of(options_.overrides.begin(), options_.overrides.end(),
                       [&path](const Override& override_) {
                         const std::string& other = override_.path;
                         return other.size() > path.size() && other.starts_with(path) &&
                                (other[path.size()] == '.' || other[path.size()] == '[');
                       });
  }

  std::string ReadRemark(const Node& mapping, const std::string& path, std::string_view key,
                         const std::string& inherited) {
    const Node* node = mapping.Find(key);
    if (node == nullptr) return inherited;
    if (!node->is_scalar() || node->text.empty()) {
      Note(*node, Below(path, key), DescribeNode(*node), "a text");
      return inherited;
    }
    if (key == "certainty" && std::none_of(std::begin(kCertainties), std::end(kCertainties),
                                           [node](const char* tag) { return node->text == tag; })) {
      Note(*node, Below(path, key), DescribeNode(*node),
           "P (printed in the paper), S (read in a public source), D (derived), K (general "
           "knowledge) or E (engineering estimate)");
    }
    return node->text;
  }

  Provenance ReadProvenance(const Node& mapping, const std::string& path,
                            const Provenance& inherited) {
    Provenance result;
    result.source = ReadRemark(mapping, path, "source", inherited.source);
    result.certainty = ReadRemark(mapping, path, "certainty", inherited.certainty);
    result.note = ReadRemark(mapping, path, "note", "");
    return result;
  }

  // Returns whether everything in the mapping was right.
  bool ReadMapping(const SchemaCore& schema, const Node& node, const std::string& path,
                   void* object, const Provenance& inherited, bool is_root) {
    places_[path] = Place{node.file_name(), node.line};
    const std::size_t problems_before = problems_.size();
    if (!node.is_mapping() && !node.is_null()) {
      Note(node, path, DescribeNode(node), fmt::format("a mapping: {}", schema.description()));
      return false;
    }
    std::vector<std::string> keys;
    for (const FieldSpec& field : schema.fields()) keys.push_back(field.key);
    for (const Node::Entry& entry : node.entries) {
      if (entry.key == "kind" && is_root) continue;
      if (entry.key == "source" || entry.key == "certainty" || entry.key == "note") continue;
      if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
      Note(Place{entry.value->file_name(), entry.line}, Below(path, entry.key), "an unknown key",
           fmt::format("a key of '{}'", schema.name()), SuggestName(entry.key, keys, "keys"));
    }
    if (is_root) CheckKind(schema, node, path.empty());
    const Provenance provenance = ReadProvenance(node, path, inherited);

    std::map<std::string, std::string> choices;  // of this mapping, for OnlyIf
    for (const FieldSpec& field : schema.fields()) {
      try {
        ReadField(field, node, path, object, provenance, &choices);
      } catch (const FieldIsWrong&) {
        continue;
      }
    }
    if (problems_.size() == problems_before) {
      SectionCheck context(this, path);
      for (const auto& check : schema.checks()) check(object, context);
    }
    return problems_.size() == problems_before;
  }

  void CheckKind(const SchemaCore& schema, const Node& node, bool is_required) {
    const Node* kind = node.Find("kind");
    if (kind == nullptr) {
      if (is_required) {
        Note(node, "kind", "nothing", fmt::format("'kind: {}'", schema.name()),
             "the first key of an input file says what it describes");
      }
    } else if (!kind->is_scalar() || kind->text != schema.name()) {
      Note(*kind, "kind", DescribeNode(*kind), fmt::format("'{}'", schema.name()));
    }
  }

  void ReadField(const FieldSpec& field, const Node& mapping, const std::string& prefix,
                 void* object, const Provenance& provenance,
                 std::map<std::string, std::string>* choices) {
    const std::string path = Below(prefix, field.key);
    known_paths_.push_back(path);
    const Node* node = FindOverride(path);
    if (node == nullptr) {
      for (const Node::Entry& entry : mapping.entries) {
        if (entry.key != field.key) continue;
        node = entry.value.get();
        places_[path] = Place{node->file_name(), entry.line};
      }
    } else {
      places_[path] = Place{node->file_name(), node->line};
    }
    const bool is_nested = field.kind == FieldKind::kSection || field.kind == FieldKind::kList ||
                           field.kind == FieldKind::kMap;
    if (!field.condition_key.empty()) {
      const auto choice = choices->find(field.condition_key);
      // A choice that is itself wrong decides nothing.
      if (choice == choices->end()) {
        throw FieldIsWrong{};
      }
      const auto& allowed = field.condition_options;
      if (std::find(allowed.begin(), allowed.end(), choice->second) == allowed.end()) {
        if (node == nullptr) return;
        Fail(*node, path, is_nested ? "a key" : DescribeNode(*node),
             fmt::format("nothing, because '{}' is '{}'", field.condition_key, choice->second),
             fmt::format("it belongs to {}: {}", field.condition_key, Join(allowed)));
      }
    }
    if (node == nullptr) {
      if (field.default_node) {
        node = field.default_node.get();
      } else if (field.kind == FieldKind::kSection &&
                 (HasOverrideBelow(path) || (!field.required && !field.stays_absent))) {
        Node empty;
        empty.file = mapping.file;
        empty.line = mapping.line;
        ReadMapping(*field.schema, empty, path, field.child(object, ""), provenance, false);
        return;
      } else if (field.required) {
        Fail(mapping, path, "nothing", Describe(field));
      } else {
        return;
      }
    }
    switch (field.kind) {
      case FieldKind::kSection:
        return ReadSection(field, *node, path, object, provenance);
      case FieldKind::kList:
        return ReadList(field, *node, path, object, provenance);
      case FieldKind::kMap:
        return ReadMap(field, *node, path, object, provenance);
      default:
        break;
    }
    if (node->is_null() && field.kind != FieldKind::kRaw) {
      Fail(*node, path, "nothing", Describe(field));
    }
    const bool is_default = node == field.default_node.get();
    Written written = Unwrap(field, *node, path, provenance);
    if (is_default) {
      written.origin = ValueOrigin{};
    } else {
      const bool from_command_line = node->line == 0 && node->file_name() == "command line";
      written.origin.kind =
          from_command_line ? ValueOrigin::Kind::kCommandLine : ValueOrigin::Kind::kFile;
      written.origin.file = node->file_name();
      written.origin.line = node->line;
      // What a file says about its values does not hold for one from elsewhere.
      if (node->file_name() != mapping.file_name() && !node->is_mapping()) {
        written.origin.source.clear();
        written.origin.certainty.clear();
      }
    }
    ValueRecord record{.path = path,
                       .value = {},
                       .numbers = {},
                       .unit = field.unit.text,
                       .text = is_default ? field.default_text : FormatNode(*written.value),
                       .description = field.description,
                       .origin = written.origin};
    FieldValue value;
    try {
      value = ReadValue(field, written, path, &record);
    } catch (const FieldIsWrong&) {
      if (is_default) {
        throw std::logic_error(fmt::format("the default of '{}' is not valid: {}", path,
                                           FormatProblem(problems_.back())));
      }
      throw;
    }
    if (field.kind == FieldKind::kChoice) (*choices)[field.key] = value.text;
    field.assign(object, value);
    record_->values.push_back(std::move(record));
  }

  void ReadSection(const FieldSpec& field, const Node& node, const std::string& path, void* object,
                   const Provenance& provenance) {
    if (!field.may_be_file || !node.is_scalar()) {
      ReadMapping(*field.schema, node, path, field.child(object, ""), provenance, false);
      return;
    }
    const std::filesystem::path file = Resolve(node);
    NodePointer root;
    try {
      root = ReadYaml(file);
    } catch (const InputError& error) {
      // The place that names the file is what the user must see first.
      const InputProblem& problem = error.problem();
      if (problem.line > 0) Fail(node, path, error);
      Fail(node, path, fmt::format("'{}': {}", file.string(), problem.found), problem.expected,
           problem.suggestion);
    }
    files_.push_back(root);
    record_->files.push_back(file);
    ReadMapping(*field.schema, *root, path, field.child(object, ""), Provenance{}, true);
  }

  void ReadList(const FieldSpec& field, const Node& node, const std::string& path, void* object,
                const Provenance& provenance) {
    if (!node.is_sequence()) Fail(node, path, DescribeNode(node), Describe(field));
    CheckCount(field, node, node.items.size(), path, kEntries);
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      const std::string item_path = fmt::format("{}[{}]", path, i);
      const Node* replaced = FindOverride(item_path);
      const Node& item = replaced == nullptr ? *node.items[i] : *replaced;
      ReadMapping(*field.schema, item, item_path, field.child(object, ""), provenance, false);
    }
  }

  void ReadMap(const FieldSpec& field, const Node& node, const std::string& path, void* object,
               const Provenance& provenance) {
    if (!node.is_mapping()) Fail(node, path, DescribeNode(node), Describe(field));
    CheckCount(field, node, node.entries.size(), path, kEntries);
    for (const Node::Entry& entry : node.entries) {
      const std::string item_path = Below(path, entry.key);
      const Node* replaced = FindOverride(item_path);
      const Node& item = replaced == nullptr ? *entry.value : *replaced;
      ReadMapping(*field.schema, item, item_path, field.child(object, entry.key), provenance,
                  false);
    }
  }

  // Takes `{value: ..., source: ...}` apart.
  Written Unwrap(const FieldSpec& field, const Node& node, const std::string& path,
                 const Provenance& inherited) {
    Written written;
    written.value = &node;
    written.unit = field.unit;
    written.origin.source = inherited.source;
    written.origin.certainty = inherited.certainty;
    if (!node.is_mapping() || field.kind == FieldKind::kRaw) return written;
    const bool is_table = field.kind == FieldKind::kTable;
    const bool takes_unit = field.kind == FieldKind::kQuantities;
    std::vector<std::string> keys = {"source", "certainty", "note"};
    if (is_table) {
      keys.insert(keys.begin(), {"rows", "units", "file"});
    } else {
      keys.insert(keys.begin(), "value");
      if (takes_unit) keys.insert(keys.begin() + 1, "unit");
    }
    for (const Node::Entry& entry : node.entries) {
      if (std::find(keys.begin(), keys.end(), entry.key) == keys.end()) {
        Fail(*entry.value, Below(path, entry.key), "an unknown key",
             fmt::format("{}, or a mapping of it with its source", Describe(field)),
             SuggestName(entry.key, keys, "keys"));
      }
    }
    const Provenance provenance = ReadProvenance(node, path, inherited);
    written.origin.source = provenance.source;
    written.origin.certainty = provenance.certainty;
    written.origin.note = provenance.note;
    if (is_table) {
      const bool has_rows = node.Find("rows") != nullptr;
      if (has_rows == (node.Find("file") != nullptr)) {
        Fail(node, path, has_rows ? "both 'rows' and 'file'" : "neither 'rows' nor 'file'",
             "one of them");
      }
      return written;  // the table reader looks at the mapping itself
    }
    written.value = node.Find("value");
    if (written.value == nullptr || written.value->is_null()) {
      Fail(node, path, "no 'value'", Describe(field));
    }
    if (const Node* unit = node.Find("unit"); unit != nullptr) {
      written.unit = ReadUnit(*unit, Below(path, "unit"), field.unit);
    }
    return written;
  }

  FieldValue ReadValue(const FieldSpec& field, const Written& written, const std::string& path,
                       ValueRecord* record) {
    FieldValue value;
    const Node& node = *written.value;
    switch (field.kind) {
      case FieldKind::kQuantity:
        value.number = ReadQuantity(node, field.unit, path, Describe(field));
        CheckRange(field, node, value.number, field.unit, path);
        record->numbers = {value.number};
        record->value = FormatNumber(value.number);
        break;
      case FieldKind::kInteger:
        value.number = ReadInteger(field, node, path);
        CheckRange(field, node, value.number, field.unit, path);
        record->numbers = {value.number};
        record->value = fmt::format("{:.0f}", value.number);
        break;
      case FieldKind::kBoolean:
        value.boolean = ReadBoolean(field, node, path);
        record->value = value.boolean ? "true" : "false";
        break;
      case FieldKind::kText:
        value.text = ReadText(field, node, path);
        record->value = value.text;
        break;
      case FieldKind::kTexts:
        if (!node.is_sequence()) Fail(node, path, DescribeNode(node), Describe(field));
        CheckCount(field, node, node.items.size(), path, kEntries);
        for (std::size_t i = 0; i < node.items.size(); ++i) {
          value.texts.push_back(ReadText(field, *node.items[i], fmt::format("{}[{}]", path, i)));
        }
        record->value = fmt::format("[{}]", Join(value.texts));
        break;
      case FieldKind::kChoice:
        value.text = ReadText(field, node, path);
        for (std::size_t i = 0; i < field.options.size(); ++i) {
          if (field.options[i].name == value.text) value.choice = i;
        }
        record->value = value.text;
        break;
      case FieldKind::kFile: {
        if (!node.is_scalar() || node.text.empty()) {
          Fail(node, path, DescribeNode(node), Describe(field));
        }
        const std::filesystem::path file = Resolve(node);
        std::error_code ignored;
        if (!std::filesystem::exists(file, ignored)) {
          Fail(node, path, fmt::format("'{}', which does not exist", file.string()),
               "an existing file");
        }
        value.text = file.string();
        record->value = value.text;
        record_->files.push_back(file);
        break;
      }
      case FieldKind::kQuantities:
        ReadQuantities(field, written, path, &value);
        record->numbers = value.numbers;
        record->value = FormatNumbers(value.numbers);
        break;
      case FieldKind::kTable:
        ReadTable(field, node, path, *this, &value, &record_->files);
        FillTableRecord(field, value, record);
        break;
      case FieldKind::kRaw:
        value.node = std::make_shared<const Node>(node);
        record->value = FormatNode(node);
        break;
      case FieldKind::kSection:
      case FieldKind::kList:
      case FieldKind::kMap:
        break;  // read elsewhere
    }
    return value;
  }

  void ReadQuantities(const FieldSpec& field, const Written& written, const std::string& path,
                      FieldValue* value) {
    const Node& node = *written.value;
    if (!node.is_sequence()) Fail(node, path, DescribeNode(node), Describe(field));
    CheckCount(field, node, node.items.size(), path, kNumbers);
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      const Node& item = *node.items[i];
      const std::string item_path = fmt::format("{}[{}]", path, i);
      const double number =
          ReadQuantity(item, written.unit, item_path, DescribeQuantity(field.unit));
      CheckRange(field, item, number, field.unit, item_path);
      if (field.increasing && i > 0 && !(number > value->numbers.back())) {
        Fail(item, item_path, DescribeNode(item), "more than the number before it");
      }
      value->numbers.push_back(number);
    }
  }

  const ReadOptions& options_;
  std::vector<bool> used_;
  InputRecord* record_;
  std::vector<std::string> known_paths_;
  std::map<std::string, Place> places_;
  std::vector<NodePointer> files_;
};

}  // namespace

void ReadInto(const SchemaCore& schema, const NodePointer& root, const ReadOptions& options,
              void* object, InputRecord* record) {
  InputRecord unwanted;
  Reader reader(options, record == nullptr ? &unwanted : record);
  reader.ReadRoot(schema, *root, object);
}

void ReadInto(const SchemaCore& schema, const std::filesystem::path& path,
              const ReadOptions& options, void* object, InputRecord* record) {
  InputRecord unwanted;
  if (record == nullptr) record = &unwanted;
  const NodePointer root = ReadYaml(path);
  record->files.insert(record->files.begin(), path);
  ReadInto(schema, root, options, object, record);
}

}  // namespace kingpin::io
