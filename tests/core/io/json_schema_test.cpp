#include <filesystem>
#include <optional>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/io/error.h"
#include "core/io/units.h"
#include "tests/core/io/example_schema.h"
#include "tests/core/io/json_schema_checker.h"

namespace kingpin::io {

using Json = nlohmann::ordered_json;

Json MakeJson(const Node& node) {
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

namespace {

bool HasType(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "number") return value.is_number();
  if (type == "integer") return value.is_number_integer();
  if (type == "boolean") return value.is_boolean();
  return false;
}

}  // namespace

std::string FindSchemaViolation(const Json& schema, const Json& value, const std::string& path) {
  static const std::set<std::string> kKnown = {"$schema",
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
      const std::string reason = FindSchemaViolation(one, value, path);
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
      !std::regex_search(value.get<std::string>(),
                         std::regex(schema["pattern"].get<std::string>()))) {
    return path + ": does not match the pattern";
  }
  if (value.is_array()) {
    if (schema.contains("minItems") && value.size() < schema["minItems"]) return path + ": short";
    if (schema.contains("maxItems") && value.size() > schema["maxItems"]) return path + ": long";
    for (std::size_t i = 0; schema.contains("items") && i < value.size(); ++i) {
      const std::string reason =
          FindSchemaViolation(schema["items"], value[i], path + "[" + std::to_string(i) + "]");
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
        reason = FindSchemaViolation(schema["properties"][key], item, item_path);
      } else if (schema.contains("additionalProperties")) {
        const Json& more = schema["additionalProperties"];
        if (more.is_boolean() && !more.get<bool>()) return item_path + ": no such property";
        if (more.is_object()) reason = FindSchemaViolation(more, item, item_path);
      }
      if (!reason.empty()) return reason;
    }
  }
  return "";
}

namespace {

Json GetSchema() { return Json::parse(FormatJsonSchema(*example::MakeSchema().core())); }

std::string Check(const char* yaml) {
  return FindSchemaViolation(GetSchema(), MakeJson(*ParseYaml(yaml, "a.yaml")));
}

TEST(JsonSchema, SaysWhichDraftItIs) {
  const Json schema = GetSchema();
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["properties"]["kind"]["const"], "steering");
  EXPECT_EQ(schema["properties"]["share"]["description"],
            "of the force [1], at least 0, at most 1");
  EXPECT_EQ(schema["properties"]["assistance"]["default"], "none");
}

TEST(JsonSchema, AcceptsWhatTheReaderAccepts) {
  for (const char* yaml :
       {"kind: steering\nrack: {mass: 2}", "kind: steering\nrack: rack.yaml",
        "kind: steering\nrack: {mass: {value: 2.5 kg, source: x, certainty: D, note: y}}",
        "kind: steering\nsource: manual\nrack: {mass: 2 kg, travel: .5e1 mm, preload: 0}\n"
        "assistance: hydraulic\nboost: [[0, 0], [1 N m, 2 kN]]\nlocked: yes\nteeth: 9\n"
        "outer_joint: {value: [1, 2, 3], unit: mm}\nnodes: [0, 1 mm]\nfree_variables: [r_L, r_X]\n"
        "load_cases: [{speed: 3}]\nnamed: {a: {speed: 3 km/h, weight: 50 %}}\n"
        "points: {units: [mm, mm, deg], rows: [[1, 2, 3]]}",
        "kind: steering\nrack: {mass: 2}\nassistance: hydraulic\nboost: {file: a.csv}"}) {
    EXPECT_EQ(Check(yaml), "") << yaml;
  }
}

TEST(JsonSchema, RefusesWhatTheReaderRefuses) {
  for (const char* yaml : {"rack: {mass: 2}",
                           "kind: car\nrack: {mass: 2}",
                           "kind: steering",
                           "kind: steering\nrack: {}",
                           "kind: steering\nrack: {mass: heavy}",
                           "kind: steering\nrack: {mass: -2}",
                           "kind: steering\nrack: {mas: 2}",
                           "kind: steering\nrack: {mass: [2]}",
                           "kind: steering\nrack: {mass: {val: 2}}",
                           "kind: steering\nrack: {mass: {value: 2, certainty: Q}}",
                           "kind: steering\nrack: {mass: 2}\nassistance: hydrolic",
                           "kind: steering\nrack: {mass: 2}\nteeth: 8.5",
                           "kind: steering\nrack: {mass: 2}\nteeth: 2",
                           "kind: steering\nrack: {mass: 2}\nouter_joint: [1, 2]",
                           "kind: steering\nrack: {mass: 2}\nnodes: [1]",
                           "kind: steering\nrack: {mass: 2}\nboost: [[1, 2]]",
                           "kind: steering\nrack: {mass: 2}\npoints: [[1, 2]]",
                           "kind: steering\nrack: {mass: 2}\nload_cases: {speed: 3}",
                           "kind: steering\nrack: {mass: 2}\nnamed: {a: {sped: 3}}",
                           "kind: steering\nrack: {mass: 2}\nlocked: maybe",
                           "kind: steering\nrack: {mass: 2}\nfree_variables: [rx]"}) {
    EXPECT_NE(Check(yaml), "") << yaml;
    EXPECT_THROW(ReadText(example::MakeSchema(), yaml, "a.yaml"), InputError) << yaml;
  }
}

}  // namespace
}  // namespace kingpin::io
