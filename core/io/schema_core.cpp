#include "core/io/schema_core.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"

namespace kingpin::io {
namespace {

Unit ParseSiUnit(std::string_view text) {
  Unit unit = ParseUnit(text);
  if (!unit.is_si()) {
    throw std::logic_error(fmt::format("a schema's unit must be SI, not '{}'", text));
  }
  return unit;
}

NodePointer WithFile(const NodePointer& node, const std::shared_ptr<const std::string>& file) {
  auto copy = std::make_shared<Node>(*node);
  copy->file = file;
  copy->line = 0;
  for (NodePointer& item : copy->items) item = WithFile(item, file);
  for (Node::Entry& entry : copy->entries) entry.value = WithFile(entry.value, file);
  return copy;
}

}  // namespace

void FieldSpec::SetUnit(std::string_view text) { unit = ParseSiUnit(text); }

void FieldSpec::AddColumn(ColumnSpec column) {
  column_units.push_back(ParseSiUnit(column.unit));
  columns.push_back(std::move(column));
}

FieldBuilder& FieldBuilder::Min(double limit) {
  field_->min = limit;
  field_->min_is_open = false;
  field_->range_is_of_type = false;
  return *this;
}

FieldBuilder& FieldBuilder::Max(double limit) {
  field_->max = limit;
  field_->max_is_open = false;
  field_->range_is_of_type = false;
  return *this;
}

FieldBuilder& FieldBuilder::Above(double limit) {
  Min(limit);
  field_->min_is_open = true;
  return *this;
}

FieldBuilder& FieldBuilder::Below(double limit) {
  Max(limit);
  field_->max_is_open = true;
  return *this;
}

FieldBuilder& FieldBuilder::Default(std::string_view text) {
  try {
    field_->default_node = ParseYaml(text, "default of " + field_->key);
  } catch (const InputError& error) {
    throw std::logic_error(error.what());
  }
  field_->default_text = std::string(text);
  field_->required = false;
  return *this;
}

FieldBuilder& FieldBuilder::Default(double value) {
  return Default(FormatQuantity(value, field_->unit.text));
}

FieldBuilder& FieldBuilder::Optional() {
  field_->required = false;
  return *this;
}

FieldBuilder& FieldBuilder::Count(std::size_t min, std::size_t max) {
  field_->min_count = min;
  field_->max_count = max;
  return *this;
}

FieldBuilder& FieldBuilder::Increasing() {
  field_->increasing = true;
  return *this;
}

FieldBuilder& FieldBuilder::Monotone() {
  field_->monotone = true;
  return *this;
}

FieldBuilder& FieldBuilder::OneOf(std::vector<std::string> names) {
  for (std::string& name : names) field_->options.push_back({std::move(name), {}});
  return *this;
}

FieldBuilder& FieldBuilder::OnlyIf(std::string choice_key, std::vector<std::string> options) {
  field_->condition_key = std::move(choice_key);
  field_->condition_options = std::move(options);
  return *this;
}

SchemaCore::SchemaCore(std::string name, std::string description)
    : name_(std::move(name)), description_(std::move(description)) {}

FieldSpec& SchemaCore::AddField(std::string key, FieldKind kind, std::string description) {
  for (const char* reserved : {"kind", "source", "certainty", "note"}) {
    if (key == reserved) {
      throw std::logic_error(fmt::format("schema {}: the key '{}' is reserved", name_, key));
    }
  }
  for (const FieldSpec& field : fields_) {
    if (field.key == key) {
      throw std::logic_error(fmt::format("schema {}: the key '{}' stands there twice", name_, key));
    }
  }
  FieldSpec& field = fields_.emplace_back();
  field.key = std::move(key);
  field.kind = kind;
  field.description = std::move(description);
  return field;
}

void SchemaCore::AddCheck(std::function<void(const void*, Check&)> check) {
  checks_.push_back(std::move(check));
}

Override ParseOverride(std::string_view text) {
  const auto fail = [&](std::string found, std::string expected) {
    throw InputError(InputProblem{.file = "command line",
                                  .key = "--set",
                                  .found = std::move(found),
                                  .expected = std::move(expected)});
  };
  const std::size_t equals = text.find('=');
  const auto trim = [](std::string_view part) {
    while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
    while (!part.empty() && part.back() == ' ') part.remove_suffix(1);
    return part;
  };
  const std::string_view path = trim(text.substr(0, equals));
  if (equals == std::string_view::npos || path.empty() || trim(text.substr(equals + 1)).empty()) {
    fail(fmt::format("'{}'", text), "path=value, such as 'steering.rack.mass=3 kg'");
  }
  NodePointer node;
  try {
    node = ParseYaml(text.substr(equals + 1), "command line");
  } catch (const InputError&) {
    fail(fmt::format("'{}'", text), "a value after '=' that is YAML");
  }
  static const auto kCommandLine = std::make_shared<const std::string>("command line");
  return Override{std::string(path), WithFile(node, kCommandLine)};
}

}  // namespace kingpin::io
