#pragma once

#include <set>
#include <string>

#include <nlohmann/json.hpp>
#include <regex.h>

#include "core/io/error.h"
#include "core/io/units.h"
#include "core/io/yaml_document.h"

/// A small, independent reading of JSON Schema for tests: the keywords our export uses, and a
/// failure for any other, so that nothing is passed over in silence.
namespace kingpin::io {

using Json = nlohmann::ordered_json;

/// What an editor sees: plain scalars become numbers and booleans as in YAML's core schema.
inline Json MakeJson(const Node& node) {
  switch (node.kind) {
    case Node::Kind::kNull:
      return nullptr;
    case Node::Kind::kScalar: {
      if (node.quoted) return node.text;
      if (node.text == "true" || node.text == "false") return node.text == "true";
      try {
        const double number = ParseNumber(node.text);
        if (number == static_cast<double>(static_cast<long>(number))) {
          return static_cast<long>(number);
        }
        return number;
      } catch (const InputError&) {
        return node.text;
      }
    }
    case Node::Kind::kSequence: {
      Json json = Json::array();
      for (const NodePointer& item : node.items) json.push_back(MakeJson(*item));
      return json;
    }
    case Node::Kind::kMapping: {
      Json json = Json::object();
      for (const auto& entry : node.entries) json[entry.key] = MakeJson(*entry.value);
      return json;
    }
  }
  return nullptr;
}

inline bool Matches(const std::string& pattern, const std::string& text) {
  regex_t expression;
  if (::regcomp(&expression, pattern.c_str(), REG_EXTENDED | REG_NOSUB) != 0) return false;
  const bool matches = ::regexec(&expression, text.c_str(), 0, nullptr, 0) == 0;
  ::regfree(&expression);
  return matches;
}

inline bool HasType(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "number") return value.is_number();
  if (type == "integer") return value.is_number_integer();
  if (type == "boolean") return value.is_boolean();
  return false;
}

/// Empty when `value` fits the schema, otherwise the path and what does not fit. `root` holds what
/// references point at; the schema itself if left out.
inline std::string FindSchemaViolation(const Json& schema, const Json& value,
                                       const std::string& path = "", const Json* root = nullptr) {
  if (root == nullptr) root = &schema;
  static const std::set<std::string> kKnown = {"$schema",
                                               "$ref",
                                               "$defs",
                                               "title",
                                               "description",
                                               "default",
                                               "type",
                                               "enum",
                                               "const",
                                               "anyOf",
                                               "properties",
                                               "required",
                                               "additionalProperties",
                                               "items",
                                               "minItems",
                                               "maxItems",
                                               "minProperties",
                                               "maxProperties",
                                               "minimum",
                                               "maximum",
                                               "exclusiveMinimum",
                                               "exclusiveMaximum",
                                               "pattern"};
  if (!schema.is_object()) return path + ": the schema is no object: " + schema.dump();
  for (const auto& [keyword, unused] : schema.items()) {
    if (!kKnown.contains(keyword)) return path + ": unknown keyword " + keyword;
  }
  if (schema.contains("$ref")) {
    const std::string prefix = "#/$defs/";
    const auto name = schema["$ref"].get<std::string>();
    if (!name.starts_with(prefix) || !(*root)["$defs"].contains(name.substr(prefix.size()))) {
      return path + ": a reference to nothing: " + name;
    }
    const std::string reason =
        FindSchemaViolation((*root)["$defs"][name.substr(prefix.size())], value, path, root);
    if (!reason.empty()) return reason;
  }
  if (schema.contains("type")) {
    const Json& type = schema["type"];
    bool fits = false;
    for (const Json& one : type.is_array() ? type : Json::array({type})) {
      fits = fits || HasType(value, one.get<std::string>());
    }
    if (!fits) return path + ": not of type " + type.dump();
  }
  if (schema.contains("const") && schema["const"] != value) return path + ": not the constant";
  if (schema.contains("enum")) {
    bool fits = false;
    for (const Json& one : schema["enum"]) fits = fits || one == value;
    if (!fits) return path + ": not one of " + schema["enum"].dump();
  }
  if (schema.contains("anyOf")) {
    bool fits = false;
    std::string reasons;
    for (const Json& one : schema["anyOf"]) {
      const std::string reason = FindSchemaViolation(one, value, path, root);
      fits = fits || reason.empty();
      reasons += reason + "; ";
    }
    if (!fits) return reasons;
  }
  if (value.is_number()) {
    const double number = value.get<double>();
    if (schema.contains("minimum") && number < schema["minimum"]) return path + ": below minimum";
    if (schema.contains("maximum") && number > schema["maximum"]) return path + ": above maximum";
    if (schema.contains("exclusiveMinimum") && number <= schema["exclusiveMinimum"]) {
      return path + ": not above minimum";
    }
    if (schema.contains("exclusiveMaximum") && number >= schema["exclusiveMaximum"]) {
      return path + ": not below maximum";
    }
  }
  if (value.is_string() && schema.contains("pattern") &&
      !Matches(schema["pattern"].get<std::string>(), value.get<std::string>())) {
    return path + ": does not match the pattern";
  }
  if (value.is_array()) {
    if (schema.contains("minItems") && value.size() < schema["minItems"]) return path + ": short";
    if (schema.contains("maxItems") && value.size() > schema["maxItems"]) return path + ": long";
    for (std::size_t i = 0; schema.contains("items") && i < value.size(); ++i) {
      const std::string reason = FindSchemaViolation(schema["items"], value[i],
                                                     path + "[" + std::to_string(i) + "]", root);
      if (!reason.empty()) return reason;
    }
  }
  if (value.is_object()) {
    if (schema.contains("required")) {
      for (const Json& key : schema["required"]) {
        if (!value.contains(key.get<std::string>())) return path + ": lacks " + key.dump();
      }
    }
    if (schema.contains("minProperties") && value.size() < schema["minProperties"]) {
      return path + ": too few";
    }
    for (const auto& [key, item] : value.items()) {
      const std::string item_path = path + "/" + key;
      std::string reason;
      if (schema.contains("properties") && schema["properties"].contains(key)) {
        reason = FindSchemaViolation(schema["properties"][key], item, item_path, root);
      } else if (schema.contains("additionalProperties")) {
        const Json& more = schema["additionalProperties"];
        if (more.is_boolean() && !more.get<bool>()) return item_path + ": no such property";
        if (more.is_object()) reason = FindSchemaViolation(more, item, item_path, root);
      }
      if (!reason.empty()) return reason;
    }
  }
  return "";
}

}  // namespace kingpin::io
