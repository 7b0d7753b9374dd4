#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/error.h"
#include "core/io/input_record.h"
#include "core/io/units.h"
#include "core/io/yaml_document.h"

/// What lies under Schema<T> (core/io/schema.h), without the type that it fills: fields, limits,
/// reading, export. Use schema.h.
namespace kingpin::io {

class SchemaCore;

enum class FieldKind {
  kQuantity,
  kInteger,
  kBoolean,
  kText,
  kTexts,
  kChoice,
  kFile,
  kQuantities,
  kTable,
  kSection,
  kList,
  kMap,
  kRaw,
};

/// One column of a table: its name and SI unit.
struct ColumnSpec {
  std::string name;
  std::string unit;
};

/// A value that was read and checked; only what its kind has is filled.
struct FieldValue {
  double number = 0.0;
  bool boolean = false;
  std::size_t choice = 0;
  std::string text;
  std::vector<std::string> texts;
  std::vector<double> numbers;
  std::vector<std::vector<double>> columns;
  NodePointer node;
};

struct FieldSpec {
  struct Option {
    std::string name;
    std::string description;
  };

  void SetUnit(std::string_view text);
  void AddColumn(ColumnSpec column);

  std::string key;
  std::string description;
  FieldKind kind = FieldKind::kText;
  Unit unit;  ///< in SI
  std::vector<ColumnSpec> columns;
  std::vector<Unit> column_units;
  bool required = true;
  NodePointer default_node;  ///< as a user would write it; null for none
  std::string default_text;
  std::optional<double> min;
  std::optional<double> max;
  bool min_is_open = false;  ///< the limit itself is not allowed
  bool max_is_open = false;
  bool range_is_of_type = false;  ///< the limits only say what the member can hold
  std::size_t min_count = 0;
  std::size_t max_count = static_cast<std::size_t>(-1);
  bool increasing = false;  ///< the first column or the list
  bool monotone = false;    ///< the other columns never fall
  std::vector<Option> options;
  bool may_be_file = false;
  bool stays_absent = false;
  std::string condition_key;  ///< another field of the same mapping, declared before
  std::vector<std::string> condition_options;
  std::shared_ptr<const SchemaCore> schema;
  std::function<void(void*, const FieldValue&)> assign;
  std::function<void*(void*, const std::string&)> child;
};

/// Says more about the field that was just added. Limits are in SI.
class FieldBuilder {
 public:
  explicit FieldBuilder(FieldSpec* field) : field_(field) {}

  FieldBuilder& Positive() { return Above(0.0); }
  FieldBuilder& NonNegative() { return Min(0.0); }
  FieldBuilder& Min(double limit);
  FieldBuilder& Max(double limit);
  FieldBuilder& Above(double limit);
  FieldBuilder& Below(double limit);
  /// A default is written as a user would write it: "150 mm", "hydraulic", "[0, 0, 1]", "true".
  /// Throws std::logic_error when it is not valid YAML.
  FieldBuilder& Default(std::string_view text);
  FieldBuilder& Default(const char* text) { return Default(std::string_view(text)); }
  FieldBuilder& Default(const std::string& text) { return Default(std::string_view(text)); }
  FieldBuilder& Default(double value);
  FieldBuilder& Default(int value) { return Default(static_cast<double>(value)); }
  FieldBuilder& Default(bool value) {
    return Default(value ? std::string_view("true") : std::string_view("false"));
  }
  FieldBuilder& Optional();
  /// Number of elements of a list, or rows of a table.
  FieldBuilder& Count(std::size_t min, std::size_t max = static_cast<std::size_t>(-1));
  /// The list, or a table's first column, increases strictly.
  FieldBuilder& Increasing();
  /// No other column of a table ever falls.
  FieldBuilder& Monotone();
  /// A text, or each of several texts, is one of these.
  FieldBuilder& OneOf(std::vector<std::string> names);
  /// The field belongs to some options of a Choice of the same mapping, declared before: with
  /// another option it must not be given (and keeps the member's initial value).
  FieldBuilder& OnlyIf(std::string choice_key, std::vector<std::string> options);

  FieldSpec* field() { return field_; }

 private:
  FieldSpec* field_;
};

/// Handed to a Schema's Check(): reports what is wrong with values that are right by themselves.
class Check {
 public:
  virtual ~Check() = default;

  /// `key` is a path below the mapping that is checked; its file and line are looked up.
  virtual void Fail(std::string_view key, std::string found, std::string expected,
                    std::string suggestion = {}) = 0;

  /// An error of what the mapping describes (a model that cannot be made, a file it names). Where
  /// the error names no file, its key is taken below `key`, and file and line are looked up.
  virtual void Add(std::string_view key, const InputError& error) = 0;
};

class SchemaCore {
 public:
  SchemaCore(std::string name, std::string description);

  const std::string& name() const { return name_; }
  const std::string& description() const { return description_; }
  const std::deque<FieldSpec>& fields() const { return fields_; }
  const std::vector<std::function<void(const void*, Check&)>>& checks() const { return checks_; }

  /// Throws std::logic_error for a key that is there already or is reserved.
  FieldSpec& AddField(std::string key, FieldKind kind, std::string description);
  void AddCheck(std::function<void(const void*, Check&)> check);

 private:
  std::string name_;
  std::string description_;
  std::deque<FieldSpec> fields_;  // a deque, so that builders stay valid
  std::vector<std::function<void(const void*, Check&)>> checks_;
};

/// A replacement for the value at `path`, with the place it came from in the node itself.
struct Override {
  std::string path;
  NodePointer value;
};

/// Reads `path=value` of `--set`; the value is YAML (`tyre.pressure=2.4 bar`, `joint=[0, 1, 2]`).
/// Throws InputError.
Override ParseOverride(std::string_view text);

struct ReadOptions {
  std::vector<Override> overrides;  ///< the last one for a path wins
};

/// Reads a file (or a parsed document) into `object`, which must be of the schema's type.
void ReadInto(const SchemaCore& schema, const std::filesystem::path& path,
              const ReadOptions& options, void* object, InputRecord* record);
void ReadInto(const SchemaCore& schema, const NodePointer& root, const ReadOptions& options,
              void* object, InputRecord* record);

/// JSON Schema, draft 2020-12, for editors: descriptions, units, ranges, enumerations, no further
/// keys.
std::string FormatJsonSchema(const SchemaCore& schema);

/// A table for people (Markdown): key, what it takes, default, description.
std::string FormatSchemaAsMarkdown(const SchemaCore& schema);

}  // namespace kingpin::io
