#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/schema_core.h"
#include "core/io/value_reader.h"

namespace kingpin::io {

/// Reads a table or curve: rows, `{units, rows}` or `{file}`. Throws FieldIsWrong after noting what
/// is wrong; a CSV file that was read is added to `files`.
void ReadTable(const FieldSpec& field, const Node& node, const std::string& path,
               ValueReader& reader, FieldValue* value, std::vector<std::filesystem::path>* files);

}  // namespace kingpin::io
