#include "core/io/field_text.h"

#include <fmt/format.h>

namespace kingpin::io {
namespace {

std::string UnitName(const FieldSpec& field) {
  return field.unit.text.empty() ? "1" : field.unit.text;
}

}  // namespace

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

std::string Count(std::size_t count, const Noun& noun) {
  return fmt::format("{} {}", count, count == 1 ? noun.singular : noun.plural);
}

std::string Below(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

std::string DescribeRange(const FieldSpec& field) {
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

std::string DescribeColumns(const FieldSpec& field) {
  std::string text;
  for (const ColumnSpec& column : field.columns) {
    text += fmt::format("{}{} [{}]", text.empty() ? "" : ", ", column.name, column.unit);
  }
  return text;
}

std::string Describe(const FieldSpec& field) {
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

std::string FormatNumbers(const std::vector<double>& numbers) {
  std::string text = "[";
  for (const double number : numbers) {
    text += (text.size() == 1 ? "" : ", ") + FormatNumber(number);
  }
  return text + "]";
}

void FillTableRecord(const FieldSpec& field, const FieldValue& value, ValueRecord* record) {
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

}  // namespace kingpin::io
