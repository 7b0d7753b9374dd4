#include "core/io/input_record.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/io/json_text.h"
#include "core/io/units.h"

namespace kingpin::io {
namespace {

const char* NameOf(ValueOrigin::Kind kind) {
  switch (kind) {
    case ValueOrigin::Kind::kDefault:
      return "default";
    case ValueOrigin::Kind::kFile:
      return "file";
    case ValueOrigin::Kind::kCommandLine:
      return "command line";
  }
  return "";
}

std::string ValueWithUnit(const ValueRecord& value) {
  if (value.unit.empty() || value.unit == "1" || value.unit == "-") return value.value;
  return value.numbers.size() == 1 ? fmt::format("{} {}", value.value, value.unit)
                                   : fmt::format("{} [{}]", value.value, value.unit);
}

}  // namespace

std::string FormatOrigin(const ValueOrigin& origin) {
  if (origin.kind != ValueOrigin::Kind::kFile) return NameOf(origin.kind);
  return fmt::format("{}:{}", origin.file, origin.line);
}

const ValueRecord* InputRecord::Find(std::string_view path) const {
  for (const ValueRecord& value : values) {
    if (value.path == path) return &value;
  }
  return nullptr;
}

std::string FormatRecordAsText(const InputRecord& record) {
  constexpr std::size_t kWidestValue = 48;
  std::size_t path_width = 4;
  std::size_t value_width = 5;
  std::size_t text_width = 10;
  for (const ValueRecord& value : record.values) {
    path_width = std::max(path_width, value.path.size());
    value_width = std::max(value_width, std::min(kWidestValue, ValueWithUnit(value).size()));
    text_width = std::max(text_width, std::min(kWidestValue, value.text.size()));
  }
  std::string text = fmt::format("{:<{}}  {:<{}}  {:<{}}  origin\n", "path", path_width, "value",
                                 value_width, "as written", text_width);
  for (const ValueRecord& value : record.values) {
    const ValueOrigin& origin = value.origin;
    text += fmt::format("{:<{}}  {:<{}}  {:<{}}  {}", value.path, path_width, ValueWithUnit(value),
                        value_width, value.text, text_width, FormatOrigin(origin));
    if (!origin.certainty.empty()) text += " [" + origin.certainty + "]";
    if (!origin.source.empty()) text += " " + origin.source;
    if (!origin.note.empty()) text += " (" + origin.note + ")";
    text += '\n';
  }
  if (record.derived.empty()) return text;
  std::size_t name_width = 7;
  for (const DerivedValue& value : record.derived) {
    name_width = std::max(name_width, value.name.size());
  }
  text += fmt::format("\n{:<{}}  {:<20}  formula [source]\n", "derived", name_width, "value");
  for (const DerivedValue& value : record.derived) {
    const std::string number = value.unit == "-"
                                   ? fmt::format("{:.6g}", value.value)
                                   : fmt::format("{:.6g} {}", value.value, value.unit);
    text += fmt::format("{:<{}}  {:<20}  {} [{}]\n", value.name, name_width, number, value.formula,
                        value.source);
  }
  return text;
}

std::string FormatRecordAsJson(const InputRecord& record) {
  nlohmann::ordered_json json;
  json["kind"] = record.kind;
  json["files"] = nlohmann::ordered_json::array();
  for (const auto& file : record.files) json["files"].push_back(file.string());
  json["values"] = nlohmann::ordered_json::array();
  for (const ValueRecord& value : record.values) {
    nlohmann::ordered_json entry;
    entry["path"] = value.path;
    if (value.numbers.size() == 1 && !value.value.starts_with('[')) {
      entry["value"] = value.numbers.front();
    } else if (!value.numbers.empty()) {
      entry["value"] = nlohmann::ordered_json::parse(value.value, nullptr, false);
    } else {
      entry["value"] = value.value;
    }
    entry["unit"] = value.unit;
    entry["text"] = value.text;
    nlohmann::ordered_json origin;
    origin["kind"] = NameOf(value.origin.kind);
    if (value.origin.kind == ValueOrigin::Kind::kFile) {
      origin["file"] = value.origin.file;
      origin["line"] = value.origin.line;
    }
    if (!value.origin.source.empty()) origin["source"] = value.origin.source;
    if (!value.origin.certainty.empty()) origin["certainty"] = value.origin.certainty;
    if (!value.origin.note.empty()) origin["note"] = value.origin.note;
    entry["origin"] = std::move(origin);
    json["values"].push_back(std::move(entry));
  }
  if (!record.derived.empty()) json["derived"] = nlohmann::ordered_json::array();
  for (const DerivedValue& value : record.derived) {
    nlohmann::ordered_json entry;
    entry["path"] = value.name;
    entry["value"] = value.value;
    entry["unit"] = value.unit;
    entry["formula"] = value.formula;
    entry["source"] = value.source;
    json["derived"].push_back(std::move(entry));
  }
  return FormatJson(json);
}

}  // namespace kingpin::io
