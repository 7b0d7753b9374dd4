#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/io/yaml_document.h"

/// A small, independent reading of JSON Schema for tests: the keywords our export uses, and a
/// failure for any other, so that nothing is passed over in silence.
namespace kingpin::io {

/// Empty when `value` fits the schema, otherwise the path and what does not fit.
std::string FindSchemaViolation(const nlohmann::ordered_json& schema,
                                const nlohmann::ordered_json& value, const std::string& path = "");

/// What an editor sees: plain scalars become numbers and booleans as in YAML's core schema.
nlohmann::ordered_json MakeJson(const Node& node);

}  // namespace kingpin::io
