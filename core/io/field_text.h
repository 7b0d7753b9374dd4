#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/input_record.h"
#include "core/io/schema_core.h"

/// Fields of a schema and their values in words, for messages and records.
namespace kingpin::io {

struct Noun {
  const char* singular;
  const char* plural;
};
inline constexpr Noun kEntries = {"entry", "entries"};
inline constexpr Noun kNumbers = {"number", "numbers"};
inline constexpr Noun kRows = {"row", "rows"};

/// `1 row`, `3 rows`.
std::string Count(std::size_t count, const Noun& noun);

/// `a, b, c`
std::string Join(const std::vector<std::string>& names);
std::vector<std::string> NamesOf(const std::vector<FieldSpec::Option>& options);

/// Path of a key below another path: `rack.mass`.
std::string Below(const std::string& path, std::string_view key);

/// What the field takes: `a mass in kg, such as '35 kg'`, `one of none, hydraulic, electric`.
std::string Describe(const FieldSpec& field);
/// `at least 0 m and less than 1 m`
std::string DescribeRange(const FieldSpec& field);
/// `torque [N m], force [N]`
std::string DescribeColumns(const FieldSpec& field);

/// `[1, 2.5]`
std::string FormatNumbers(const std::vector<double>& numbers);

/// Rows, numbers and units of a table that was read.
void FillTableRecord(const FieldSpec& field, const FieldValue& value, ValueRecord* record);

}  // namespace kingpin::io
