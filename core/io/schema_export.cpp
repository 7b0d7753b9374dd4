#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/io/json_text.h"
#include "core/io/schema_core.h"

namespace kingpin::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kNoLimit = static_cast<std::size_t>(-1);

Json MakeRef(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

Json MakeNumber(const FieldSpec& field, const char* type) {
  Json number = {{"type", type}};
  if (field.range_is_of_type) return number;
  if (field.min) number[field.min_is_open ? "exclusiveMinimum" : "minimum"] = *field.min;
  if (field.max) number[field.max_is_open ? "exclusiveMaximum" : "maximum"] = *field.max;
  return number;
}

void LimitCount(const FieldSpec& field, Json* list) {
  if (field.min_count > 0) (*list)["minItems"] = field.min_count;
  if (field.max_count != kNoLimit) (*list)["maxItems"] = field.max_count;
}

// `quantity_above_0_at_most_1`: what has the same limits has the same name.
std::string NameWithLimits(std::string name, const FieldSpec& field) {
  if (field.range_is_of_type) return name;
  if (field.min) name += fmt::format("_{}_{}", field.min_is_open ? "above" : "from", *field.min);
  if (field.max) name += fmt::format("_{}_{}", field.max_is_open ? "below" : "to", *field.max);
  return name;
}

Json MakeNames(const FieldSpec& field) {
  Json names = Json::array();
  for (const auto& option : field.options) names.push_back(option.name);
  return names;
}

std::string DescribeLimits(const FieldSpec& field);
std::string DescribeUnit(const FieldSpec& field);

// Writes each thing that stands in several places once, under `$defs`: sections that share a
// schema, quantities with the same limits, provenance.
class Exporter {
 public:
  Json MakeRoot(const SchemaCore& schema) {
    Json json;
    json["$schema"] = "https://json-schema.org/draft/2020-12/schema";
    json["title"] = schema.name();
    json.update(MakeObject(schema, true));
    if (!definitions_.empty()) json["$defs"] = std::move(definitions_);
    return json;
  }

 private:
  template <class Make>
  Json Share(const std::string& name, Make make) {
    if (!definitions_.contains(name)) {
      definitions_[name] = nullptr;  // keeps its place while what it needs comes behind it
      Json definition = make();
      definitions_[name] = std::move(definition);
    }
    return MakeRef(name);
  }

  Json MakeSection(const SchemaCore& schema) {
    const auto known = names_.find(&schema);
    if (known != names_.end()) return MakeRef(known->second);
    std::string name = "section_" + schema.name();
    for (int i = 2; definitions_.contains(name); ++i) {
      name = fmt::format("section_{}_{}", schema.name(), i);
    }
    names_[&schema] = name;
    return Share(name, [&] { return MakeObject(schema, false); });
  }

  Json MakeProvenanceProperties() {
    Json properties;
    properties["source"] = Share("source", [] {
      return Json{{"type", "string"}, {"description", "where the value comes from"}};
    });
    properties["certainty"] = Share("certainty", [] {
      return Json{
          {"enum", {"P", "S", "D", "K", "E"}},
          {"description",
           "P printed in the paper, S public source, D derived, K general knowledge, E estimate"}};
    });
    properties["note"] = {{"type", "string"}};
    return properties;
  }

  // Understood alike by ECMA 262, which JSON Schema asks for, and by POSIX.
  Json MakeQuantityText() {
    return Share("quantity_text", [] {
      return Json{
          {"type", "string"},
          {"pattern", "^ *[+-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)? *([^0-9., ].*)?$"}};
    });
  }

  Json MakePlainQuantity(const FieldSpec& field) {
    return Share(NameWithLimits("plain_quantity", field), [&] {
      return Json{{"anyOf", Json::array({MakeNumber(field, "number"), MakeQuantityText()})}};
    });
  }

  Json MakeWrapped(Json plain, bool takes_unit) {
    Json properties;
    properties["value"] = plain;
    if (takes_unit) properties["unit"] = {{"type", "string"}};
    properties.update(MakeProvenanceProperties());
    return {{"anyOf", Json::array({std::move(plain), Json{{"type", "object"},
                                                          {"properties", std::move(properties)},
                                                          {"required", {"value"}},
                                                          {"additionalProperties", false}}})}};
  }

  Json MakeTable(const FieldSpec& field) {
    Json cell = {{"anyOf", Json::array({Json{{"type", "number"}}, MakeQuantityText()})}};
    Json row = {{"type", "array"},
                {"items", cell},
                {"minItems", field.columns.size()},
                {"maxItems", field.columns.size()}};
    Json rows = {{"type", "array"}, {"items", std::move(row)}};
    LimitCount(field, &rows);
    Json with_rows;
    with_rows["rows"] = rows;
    with_rows["units"] = {{"type", "array"},
                          {"items", {{"type", "string"}}},
                          {"minItems", field.columns.size()},
                          {"maxItems", field.columns.size()}};
    with_rows.update(MakeProvenanceProperties());
    Json with_file;
    with_file["file"] = {{"type", "string"}};
    with_file.update(MakeProvenanceProperties());
    return {{"anyOf", Json::array({rows,
                                   Json{{"type", "object"},
                                        {"properties", std::move(with_rows)},
                                        {"required", {"rows"}},
                                        {"additionalProperties", false}},
                                   Json{{"type", "object"},
                                        {"properties", std::move(with_file)},
                                        {"required", {"file"}},
                                        {"additionalProperties", false}}})}};
  }

  static Json MakeTextType(const FieldSpec& field) {
    if (field.options.empty()) return {{"type", {"string", "number", "boolean"}}};
    return {{"enum", MakeNames(field)}};
  }

  Json MakeText(const FieldSpec& field) {
    if (!field.options.empty()) return MakeWrapped(MakeTextType(field), false);
    return Share("text", [&] { return MakeWrapped(MakeTextType(field), false); });
  }

  Json MakeField(const FieldSpec& field) {
    switch (field.kind) {
      case FieldKind::kQuantity:
        return Share(NameWithLimits("quantity", field),
                     [&] { return MakeWrapped(MakePlainQuantity(field), false); });
      case FieldKind::kInteger:
        return Share(NameWithLimits("integer", field),
                     [&] { return MakeWrapped(MakeNumber(field, "integer"), false); });
      case FieldKind::kBoolean:
        return Share("truth", [&] {
          return MakeWrapped({{"anyOf", Json::array({Json{{"type", "boolean"}},
                                                     Json{{"enum", {"yes", "no", "on", "off"}}}})}},
                             false);
        });
      case FieldKind::kText:
        return MakeText(field);
      case FieldKind::kChoice:
        return MakeWrapped({{"enum", MakeNames(field)}}, false);
      case FieldKind::kFile:
        return Share("file", [&] { return MakeWrapped({{"type", "string"}}, false); });
      case FieldKind::kTexts: {
        Json list = {{"type", "array"}, {"items", MakeTextType(field)}};
        LimitCount(field, &list);
        return MakeWrapped(std::move(list), false);
      }
      case FieldKind::kQuantities: {
        const auto make = [&] {
          Json list = {{"type", "array"}, {"items", MakePlainQuantity(field)}};
          LimitCount(field, &list);
          return MakeWrapped(std::move(list), true);
        };
        const std::string most =
            field.max_count == kNoLimit ? "any" : fmt::format("{}", field.max_count);
        return Share(
            fmt::format("{}_{}_to_{}", NameWithLimits("quantities", field), field.min_count, most),
            make);
      }
      case FieldKind::kTable:
        return MakeTable(field);
      case FieldKind::kSection: {
        Json object = MakeSection(*field.schema);
        if (!field.may_be_file) return object;
        return {{"anyOf", Json::array({Json{{"type", "string"}}, std::move(object)})}};
      }
      case FieldKind::kList: {
        Json list = {{"type", "array"}, {"items", MakeSection(*field.schema)}};
        LimitCount(field, &list);
        return list;
      }
      case FieldKind::kMap: {
        Json object = {{"type", "object"}, {"additionalProperties", MakeSection(*field.schema)}};
        if (field.min_count > 0) object["minProperties"] = field.min_count;
        if (field.max_count != kNoLimit) object["maxProperties"] = field.max_count;
        return object;
      }
      case FieldKind::kRaw:
        return Json::object();
    }
    return {};
  }

  Json MakeObject(const SchemaCore& schema, bool is_root) {
    Json properties = Json::object();
    Json required = Json::array();
    if (is_root) {
      properties["kind"] = {{"const", schema.name()}, {"description", "what the file describes"}};
      required.push_back("kind");
    }
    for (const FieldSpec& field : schema.fields()) {
      Json property = MakeField(field);
      std::string description = field.description;
      if (const std::string unit = DescribeUnit(field); !unit.empty()) description += " " + unit;
      description += DescribeLimits(field);
      for (const auto& option : field.options) {
        if (!option.description.empty()) {
          description += fmt::format("\n{}: {}", option.name, option.description);
        }
      }
      if (!field.condition_key.empty()) {
        std::string options;
        for (const std::string& option : field.condition_options) {
          options += (options.empty() ? "" : ", ") + option;
        }
        description += fmt::format("\nonly with {}: {}", field.condition_key, options);
      }
      property["description"] = std::move(description);
      if (field.default_node) property["default"] = field.default_text;
      properties[field.key] = std::move(property);
      if (field.required && field.condition_key.empty()) required.push_back(field.key);
    }
    properties.update(MakeProvenanceProperties());
    Json object = {{"type", "object"},
                   {"description", schema.description()},
                   {"properties", std::move(properties)},
                   {"additionalProperties", false}};
    if (!required.empty()) object["required"] = std::move(required);
    return object;
  }

  Json definitions_ = Json::object();
  std::map<const SchemaCore*, std::string> names_;
};

std::string DescribeLimits(const FieldSpec& field) {
  std::string text;
  if (field.range_is_of_type) return text;
  if (field.min) {
    text += fmt::format(", {} {}", field.min_is_open ? "more than" : "at least",
                        FormatQuantity(*field.min, field.unit.text));
  }
  if (field.max) {
    text += fmt::format(", {} {}", field.max_is_open ? "less than" : "at most",
                        FormatQuantity(*field.max, field.unit.text));
  }
  return text;
}

std::string DescribeUnit(const FieldSpec& field) {
  if (field.kind == FieldKind::kTable) {
    std::string text;
    for (const ColumnSpec& column : field.columns) {
      text += fmt::format("{}{} [{}]", text.empty() ? "" : ", ", column.name, column.unit);
    }
    return text;
  }
  if (field.kind != FieldKind::kQuantity && field.kind != FieldKind::kQuantities) return {};
  return "[" + (field.unit.text.empty() ? "1" : field.unit.text) + "]";
}

const char* NameOfKind(const FieldSpec& field) {
  switch (field.kind) {
    case FieldKind::kQuantity:
      return "quantity";
    case FieldKind::kInteger:
      return "whole number";
    case FieldKind::kBoolean:
      return "true or false";
    case FieldKind::kText:
      return "text";
    case FieldKind::kTexts:
      return "list of texts";
    case FieldKind::kChoice:
      return "choice";
    case FieldKind::kFile:
      return "file";
    case FieldKind::kQuantities:
      return "list of quantities";
    case FieldKind::kTable:
      return "table";
    case FieldKind::kSection:
      return field.may_be_file ? "mapping or file" : "mapping";
    case FieldKind::kList:
      return "list of mappings";
    case FieldKind::kMap:
      return "mapping of names";
    case FieldKind::kRaw:
      return "anything";
  }
  return "";
}

void AppendMarkdown(const SchemaCore& schema, const std::string& prefix, std::string* text) {
  for (const FieldSpec& field : schema.fields()) {
    const std::string path = prefix + field.key;
    std::string takes = NameOfKind(field);
    if (const std::string unit = DescribeUnit(field); !unit.empty()) takes += " " + unit;
    takes += DescribeLimits(field);
    for (std::size_t i = 0; i < field.options.size(); ++i) {
      takes += (i == 0 ? ": " : ", ") + field.options[i].name;
    }
    const std::string otherwise = field.default_node ? "`" + field.default_text + "`"
                                  : field.required   ? "required"
                                                     : "optional";
    *text += fmt::format("| `{}` | {} | {} | {} |\n", path, takes, otherwise, field.description);
    if (field.kind == FieldKind::kSection) AppendMarkdown(*field.schema, path + ".", text);
    if (field.kind == FieldKind::kList) AppendMarkdown(*field.schema, path + "[i].", text);
    if (field.kind == FieldKind::kMap) AppendMarkdown(*field.schema, path + ".NAME.", text);
  }
}

}  // namespace

std::string FormatJsonSchema(const SchemaCore& schema) {
  return FormatJson(Exporter().MakeRoot(schema));
}

std::string FormatSchemaAsMarkdown(const SchemaCore& schema) {
  std::string text = fmt::format(
      "# kind: {}\n\n{}\n\n| key | takes | otherwise | meaning |\n"
      "| --- | --- | --- | --- |\n",
      schema.name(), schema.description());
  AppendMarkdown(schema, "", &text);
  return text;
}

}  // namespace kingpin::io
