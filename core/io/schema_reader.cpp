#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/io/csv.h"
#include "core/io/error.h"
#include "core/io/nearest_name.h"
#include "core/io/schema_core.h"

namespace kingpin::io {
namespace {

constexpr std::size_t kMostProblems = 50;
constexpr const char* kCertainties[] = {"P", "S", "D", "K", "E"};

std::string Join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::vector<std::string> NamesOf(const std::vector<FieldSpec::Option>& options) {
  std::vector<std::string> names;
  names.reserve(options.size());
  for (const FieldSpec::Option& option : options) names.push_back(option.name);
  return names;
}

struct Noun {
  const char* singular;
  const char* plural;
};
constexpr Noun kEntries = {"entry", "entries"};
constexpr Noun kNumbers = {"number", "numbers"};
constexpr Noun kRows = {"row", "rows"};

std::string Count(std::size_t count, const Noun& noun) {
  return fmt::format("{} {}", count, count == 1 ? noun.singular : noun.plural);
}

// What a mapping says about all values below it.
struct Provenance {
  std::string source;
  std::string certainty;
  std::string note;
};

// Thrown inside the reader to leave one field; what was wrong is noted already.
struct FieldIsWrong {};

class Reader {
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
  struct Place {
    std::string file;
    int line = 0;
  };

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
        if (reader_->problems_.size() < kMostProblems) reader_->problems_.push_back(problem);
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

  void Note(const Place& place, const std::string& path, std::string found, std::string expected,
            std::string suggestion = {}) {
    if (problems_.size() >= kMostProblems) return;
    problems_.push_back(InputProblem{.file = place.file,
                                     .line = place.line,
                                     .key = path,
                                     .found = std::move(found),
                                     .expected = std::move(expected),
                                     .suggestion = std::move(suggestion)});
  }
  void Note(const Node& node, const std::string& path, std::string found, std::string expected,
            std::string suggestion = {}) {
    Note(Place{node.file_name(), node.line}, path, std::move(found), std::move(expected),
         std::move(suggestion));
  }
  [[noreturn]] void Fail(const Node& node, const std::string& path, std::string found,
                         std::string expected, std::string suggestion = {}) {
    Note(node, path, std::move(found), std::move(expected), std::move(suggestion));
    throw FieldIsWrong{};
  }
  // An error from elsewhere gets the place and the path it lacks.
  [[noreturn]] void Fail(const Node& node, const std::string& path, const InputError& error) {
    for (InputProblem problem : error.problems()) {
      if (problem.file.empty()) {
        problem.file = node.file_name();
        problem.line = node.line;
      }
      if (problem.key.empty()) problem.key = path;
      if (problems_.size() < kMostProblems) problems_.push_back(std::move(problem));
    }
    throw FieldIsWrong{};
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

  static std::string Below(const std::string& path, std::string_view key) {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
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

  Unit ReadUnit(const Node& node, const std::string& path, const Unit& expected) {
    if (!node.is_scalar()) Fail(node, path, DescribeNode(node), "a unit");
    Unit unit;
    try {
      unit = ParseUnit(node.text);
    } catch (const InputError& error) {
      Fail(node, path, error);
    }
    if (!IsUsableAs(unit.dimension, expected.dimension)) {
      Fail(node, path, DescribeNode(node), "a unit for " + DescribeQuantity(expected));
    }
    // A bare number in a unit without radians still means the dimension that is expected.
    unit.dimension = expected.dimension;
    return unit;
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
        ReadTable(field, node, path, &value);
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

  double ReadQuantity(const Node& node, const Unit& unit, const std::string& path,
                      const std::string& expected) {
    if (!node.is_scalar()) Fail(node, path, DescribeNode(node), expected);
    try {
      return ParseQuantity(node.text, unit);
    } catch (const InputError& error) {
      Fail(node, path, error);
    }
  }

  double ReadInteger(const FieldSpec& field, const Node& node, const std::string& path) {
    if (!node.is_scalar()) Fail(node, path, DescribeNode(node), Describe(field));
    double number = 0.0;
    try {
      number = ParseNumber(node.text);
    } catch (const InputError&) {
      Fail(node, path, DescribeNode(node), Describe(field));
    }
    if (number != std::floor(number)) Fail(node, path, DescribeNode(node), Describe(field));
    return number;
  }

  bool ReadBoolean(const FieldSpec& field, const Node& node, const std::string& path) {
    if (node.is_scalar()) {
      for (const char* yes : {"true", "yes", "on", "True", "Yes", "On"}) {
        if (node.text == yes) return true;
      }
      for (const char* no : {"false", "no", "off", "False", "No", "Off"}) {
        if (node.text == no) return false;
      }
    }
    Fail(node, path, DescribeNode(node), Describe(field));
  }

  std::string ReadText(const FieldSpec& field, const Node& node, const std::string& path) {
    if (!node.is_scalar() || node.text.empty()) {
      Fail(node, path, DescribeNode(node),
           field.kind == FieldKind::kTexts && field.options.empty() ? "a text" : Describe(field));
    }
    const std::vector<std::string> names = NamesOf(field.options);
    if (!names.empty() && std::find(names.begin(), names.end(), node.text) == names.end()) {
      const std::string nearest = FindNearestName(node.text, names);
      Fail(node, path, DescribeNode(node), "one of " + Join(names),
           nearest.empty() ? "" : fmt::format("did you mean '{}'?", nearest));
    }
    return node.text;
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

  void ReadTable(const FieldSpec& field, const Node& node, const std::string& path,
                 FieldValue* value) {
    value->columns.assign(field.columns.size(), {});
    const Node* rows = &node;
    std::vector<Unit> units = field.column_units;
    if (node.is_mapping()) {
      if (const Node* file = node.Find("file"); file != nullptr) {
        if (const Node* extra = node.Find("units"); extra != nullptr) {
          Fail(*extra, Below(path, "units"), "units beside a file", "the units in the file itself");
        }
        ReadTableFile(field, *file, Below(path, "file"), value);
        return;
      }
      rows = node.Find("rows");
      if (const Node* given = node.Find("units"); given != nullptr) {
        if (!given->is_sequence() || given->items.size() != units.size()) {
          Fail(*given, Below(path, "units"), DescribeNode(*given),
               fmt::format("a list of {} units", units.size()));
        }
        for (std::size_t j = 0; j < units.size(); ++j) {
          units[j] = ReadUnit(*given->items[j], fmt::format("{}.units[{}]", path, j), units[j]);
        }
      }
    }
    if (!rows->is_sequence()) Fail(*rows, path, DescribeNode(*rows), Describe(field));
    CheckCount(field, *rows, rows->items.size(), path, kRows);
    for (std::size_t i = 0; i < rows->items.size(); ++i) {
      const Node& row = *rows->items[i];
      const std::string row_path = fmt::format("{}[{}]", path, i);
      if (!row.is_sequence() || row.items.size() != units.size()) {
        Fail(row, row_path,
             row.is_sequence() ? fmt::format("a row of {}", row.items.size()) : DescribeNode(row),
             fmt::format("a row of {}: {}", units.size(), DescribeColumns(field)));
      }
      std::vector<double> cells;
      for (std::size_t j = 0; j < units.size(); ++j) {
        cells.push_back(ReadQuantity(*row.items[j], units[j], fmt::format("{}[{}]", row_path, j),
                                     DescribeQuantity(field.column_units[j])));
      }
      CheckRow(field, cells, *value, Place{row.file_name(), row.line}, row_path);
      for (std::size_t j = 0; j < units.size(); ++j) value->columns[j].push_back(cells[j]);
    }
  }

  void ReadTableFile(const FieldSpec& field, const Node& node, const std::string& path,
                     FieldValue* value) {
    if (!node.is_scalar() || node.text.empty()) {
      Fail(node, path, DescribeNode(node), "the name of a CSV file");
    }
    const std::filesystem::path file = Resolve(node);
    try {
      const CsvTable table = ReadCsv(file);
      record_->files.push_back(file);
      std::vector<const CsvColumn*> columns;
      for (std::size_t j = 0; j < field.columns.size(); ++j) {
        const CsvColumn* column = table.Find(field.columns[j].name);
        // Names may differ, but then the file must have these columns and no other.
        if (column == nullptr && table.columns.size() == field.columns.size()) {
          column = &table.columns[j];
        }
        if (column == nullptr) {
          Fail(node, path,
               fmt::format("'{}' without a column '{}'", file.string(), field.columns[j].name),
               DescribeColumns(field));
        }
        columns.push_back(column);
      }
      for (std::size_t i = 0; i < table.lines.size(); ++i) {
        std::vector<double> cells;
        for (std::size_t j = 0; j < columns.size(); ++j) {
          Unit unit = field.column_units[j];
          if (table.has_units) {
            unit = ParseUnit(columns[j]->unit);
            if (!IsUsableAs(unit.dimension, field.column_units[j].dimension)) {
              throw InputError(InputProblem{.file = file.string(),
                                            .line = 2,
                                            .key = columns[j]->name,
                                            .found = fmt::format("unit '{}'", columns[j]->unit),
                                            .expected = DescribeQuantity(field.column_units[j])});
            }
          }
          cells.push_back(unit.ToSi(columns[j]->values[i]));
        }
        CheckRow(field, cells, *value, Place{file.string(), table.lines[i]}, path);
        for (std::size_t j = 0; j < columns.size(); ++j) value->columns[j].push_back(cells[j]);
      }
    } catch (const InputError& error) {
      if (error.problem().line > 0) Fail(node, path, error);
      Fail(node, path, fmt::format("'{}': {}", file.string(), error.problem().found),
           error.problem().expected, error.problem().suggestion);
    }
    CheckCount(field, node, value->columns[0].size(), path, kRows);
  }

  void CheckRow(const FieldSpec& field, const std::vector<double>& cells, const FieldValue& value,
                const Place& place, const std::string& path) {
    if (value.columns[0].empty()) return;
    const auto fail = [&](std::size_t j, const char* expected) {
      Note(place, path,
           fmt::format("{} {} after {}", field.columns[j].name,
                       FormatQuantity(cells[j], field.columns[j].unit),
                       FormatQuantity(value.columns[j].back(), field.columns[j].unit)),
           expected);
      throw FieldIsWrong{};
    };
    if (field.increasing && !(cells[0] > value.columns[0].back())) {
      fail(0, "a first column that increases from row to row");
    }
    for (std::size_t j = 1; field.monotone && j < cells.size(); ++j) {
      if (cells[j] < value.columns[j].back()) fail(j, "a curve that never falls");
    }
  }

  void CheckCount(const FieldSpec& field, const Node& node, std::size_t count,
                  const std::string& path, const Noun& what) {
    if (count >= field.min_count && count <= field.max_count) return;
    std::string expected;
    if (field.min_count == field.max_count) {
      expected = Count(field.min_count, what);
    } else if (count < field.min_count) {
      expected = "at least " + Count(field.min_count, what);
    } else {
      expected = "at most " + Count(field.max_count, what);
    }
    Fail(node, path, Count(count, what), expected);
  }

  void CheckRange(const FieldSpec& field, const Node& node, double value, const Unit& unit,
                  const std::string& path) {
    const bool low = field.min && (field.min_is_open ? !(value > *field.min) : value < *field.min);
    const bool high = field.max && (field.max_is_open ? !(value < *field.max) : value > *field.max);
    if (!low && !high) return;
    std::string found = DescribeNode(node);
    const std::string si = FormatQuantity(value, unit.text);
    if (found != fmt::format("'{}'", si) && found != fmt::format("'{}'", FormatNumber(value))) {
      found += fmt::format(" ({})", si);
    }
    Fail(node, path, found, DescribeRange(field));
  }

  static std::string DescribeRange(const FieldSpec& field) {
    std::string text;
    if (field.min) {
      text += fmt::format("{} {}", field.min_is_open ? "more than" : "at least",
                          FormatQuantity(*field.min, field.unit.text));
    }
    if (field.max) {
      text += fmt::format("{}{} {}", text.empty() ? "" : " and ",
                          field.max_is_open ? "less than" : "at most",
                          FormatQuantity(*field.max, field.unit.text));
    }
    return text;
  }

  static std::string DescribeColumns(const FieldSpec& field) {
    std::string text;
    for (const ColumnSpec& column : field.columns) {
      text += fmt::format("{}{} [{}]", text.empty() ? "" : ", ", column.name, column.unit);
    }
    return text;
  }

  static std::string Describe(const FieldSpec& field) {
    switch (field.kind) {
      case FieldKind::kQuantity:
        return DescribeQuantity(field.unit);
      case FieldKind::kInteger:
        return "a whole number";
      case FieldKind::kBoolean:
        return "true or false";
      case FieldKind::kText:
        return field.options.empty() ? "a text" : "one of " + Join(NamesOf(field.options));
      case FieldKind::kTexts:
        return field.options.empty() ? "a list of texts"
                                     : "a list from " + Join(NamesOf(field.options));
      case FieldKind::kChoice:
        return "one of " + Join(NamesOf(field.options));
      case FieldKind::kFile:
        return "the name of a file";
      case FieldKind::kQuantities:
        if (field.min_count == field.max_count) {
          return fmt::format("a list of {} numbers in {}", field.min_count, UnitName(field));
        }
        return fmt::format("a list of numbers in {}", UnitName(field));
      case FieldKind::kTable:
        return "a list of rows of " + DescribeColumns(field);
      case FieldKind::kSection:
        return field.may_be_file
                   ? fmt::format("a mapping or the name of a file: {}", field.description)
                   : fmt::format("a mapping: {}", field.description);
      case FieldKind::kList:
        return fmt::format("a list of mappings: {}", field.description);
      case FieldKind::kMap:
        return fmt::format("a mapping of names: {}", field.description);
      case FieldKind::kRaw:
        return field.description;
    }
    return {};
  }

  static std::string UnitName(const FieldSpec& field) {
    return field.unit.text.empty() ? "1" : field.unit.text;
  }

  static std::string FormatNumbers(const std::vector<double>& numbers) {
    std::string text = "[";
    for (const double number : numbers) {
      text += (text.size() == 1 ? "" : ", ") + FormatNumber(number);
    }
    return text + "]";
  }

  static void FillTableRecord(const FieldSpec& field, const FieldValue& value,
                              ValueRecord* record) {
    record->value = "[";
    for (std::size_t i = 0; i < value.columns[0].size(); ++i) {
      std::vector<double> row;
      for (const std::vector<double>& column : value.columns) row.push_back(column[i]);
      record->value += (i == 0 ? "" : ", ") + FormatNumbers(row);
      record->numbers.insert(record->numbers.end(), row.begin(), row.end());
    }
    record->value += "]";
    record->unit.clear();
    for (const ColumnSpec& column : field.columns) {
      record->unit += (record->unit.empty() ? "" : ", ") + column.unit;
    }
  }

  static std::filesystem::path Resolve(const Node& node) {
    std::filesystem::path file(node.text);
    if (file.is_absolute() || node.file_name() == "command line") return file;
    return (std::filesystem::path(node.file_name()).parent_path() / file).lexically_normal();
  }

  const ReadOptions& options_;
  std::vector<bool> used_;
  InputRecord* record_;
  std::vector<InputProblem> problems_;
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
