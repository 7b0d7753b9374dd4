#include "core/io/table_reader.h"

#include <fmt/format.h>

#include "core/io/csv.h"
#include "core/io/error.h"
#include "core/io/field_text.h"
#include "core/io/units.h"

namespace kingpin::io {
namespace {

class TableReader {
 public:
  TableReader(ValueReader& reader, std::vector<std::filesystem::path>* files)
      : reader_(reader), files_(files) {}

  void ReadTable(const FieldSpec& field, const Node& node, const std::string& path,
                 FieldValue* value);

 private:
  void ReadTableFile(const FieldSpec& field, const Node& node, const std::string& path,
                     FieldValue* value);
  void CheckRow(const FieldSpec& field, const std::vector<double>& cells, const FieldValue& value,
                const ValueReader::Place& place, const std::string& path);

  ValueReader& reader_;
  std::vector<std::filesystem::path>* files_;
};

void TableReader::ReadTable(const FieldSpec& field, const Node& node, const std::string& path,
                            FieldValue* value) {
  value->columns.assign(field.columns.size(), {});
  const Node* rows = &node;
  std::vector<Unit> units = field.column_units;
  if (node.is_mapping()) {
    if (const Node* file = node.Find("file"); file != nullptr) {
      if (const Node* extra = node.Find("units"); extra != nullptr) {
        reader_.Fail(*extra, Below(path, "units"), "units beside a file",
                     "the units in the file itself");
      }
      ReadTableFile(field, *file, Below(path, "file"), value);
      return;
    }
    rows = node.Find("rows");
    if (const Node* given = node.Find("units"); given != nullptr) {
      if (!given->is_sequence() || given->items.size() != units.size()) {
        reader_.Fail(*given, Below(path, "units"), DescribeNode(*given),
                     fmt::format("a list of {} units", units.size()));
      }
      for (std::size_t j = 0; j < units.size(); ++j) {
        units[j] =
            reader_.ReadUnit(*given->items[j], fmt::format("{}.units[{}]", path, j), units[j]);
      }
    }
  }
  if (!rows->is_sequence()) reader_.Fail(*rows, path, DescribeNode(*rows), Describe(field));
  reader_.CheckCount(field, *rows, rows->items.size(), path, kRows);
  for (std::size_t i = 0; i < rows->items.size(); ++i) {
    const Node& row = *rows->items[i];
    const std::string row_path = fmt::format("{}[{}]", path, i);
    if (!row.is_sequence() || row.items.size() != units.size()) {
      reader_.Fail(
          row, row_path,
          row.is_sequence() ? fmt::format("a row of {}", row.items.size()) : DescribeNode(row),
          fmt::format("a row of {}: {}", units.size(), DescribeColumns(field)));
    }
    std::vector<double> cells;
    for (std::size_t j = 0; j < units.size(); ++j) {
      cells.push_back(reader_.ReadQuantity(*row.items[j], units[j],
                                           fmt::format("{}[{}]", row_path, j),
                                           DescribeQuantity(field.column_units[j])));
    }
    CheckRow(field, cells, *value, ValueReader::Place{row.file_name(), row.line}, row_path);
    for (std::size_t j = 0; j < units.size(); ++j) value->columns[j].push_back(cells[j]);
  }
}

void TableReader::ReadTableFile(const FieldSpec& field, const Node& node, const std::string& path,
                                FieldValue* value) {
  if (!node.is_scalar() || node.text.empty()) {
    reader_.Fail(node, path, DescribeNode(node), "the name of a CSV file");
  }
  const std::filesystem::path file = ValueReader::Resolve(node);
  try {
    const CsvTable table = ReadCsv(file);
    files_->push_back(file);
    std::vector<const CsvColumn*> columns;
    for (std::size_t j = 0; j < field.columns.size(); ++j) {
      const CsvColumn* column = table.Find(field.columns[j].name);
      // Names may differ, but then the file must have these columns and no other.
      if (column == nullptr && table.columns.size() == field.columns.size()) {
        column = &table.columns[j];
      }
      if (column == nullptr) {
        reader_.Fail(
            node, path,
            fmt::format("'{}' without a column '{}'", file.string(), field.columns[j].name),
            DescribeColumns(field));
      }
      columns.push_back(column);
    }
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
      std::vector<double> cells;
      for (std::size_t j = 0; j < columns.size(); ++j) {
        Unit unit = field.column_units[j];
        if (table.has_units) {
          unit = ParseUnit(columns[j]->unit);
          if (!IsUsableAs(unit.dimension, field.column_units[j].dimension)) {
            throw InputError(InputProblem{.file = file.string(),
                                          .line = 2,
                                          .key = columns[j]->name,
                                          .found = fmt::format("unit '{}'", columns[j]->unit),
                                          .expected = DescribeQuantity(field.column_units[j])});
          }
        }
        cells.push_back(unit.ToSi(columns[j]->values[i]));
      }
      CheckRow(field, cells, *value, ValueReader::Place{file.string(), table.lines[i]}, path);
      for (std::size_t j = 0; j < columns.size(); ++j) value->columns[j].push_back(cells[j]);
    }
  } catch (const InputError& error) {
    if (error.problem().line > 0) reader_.Fail(node, path, error);
    reader_.Fail(node, path, fmt::format("'{}': {}", file.string(), error.problem().found),
                 error.problem().expected, error.problem().suggestion);
  }
  reader_.CheckCount(field, node, value->columns[0].size(), path, kRows);
}

void TableReader::CheckRow(const FieldSpec& field, const std::vector<double>& cells,
                           const FieldValue& value, const ValueReader::Place& place,
                           const std::string& path) {
  if (value.columns[0].empty()) return;
  const auto fail = [&](std::size_t j, const char* expected) {
    reader_.Note(place, path,
                 fmt::format("{} {} after {}", field.columns[j].name,
                             FormatQuantity(cells[j], field.columns[j].unit),
                             FormatQuantity(value.columns[j].back(), field.columns[j].unit)),
                 expected);
    throw FieldIsWrong{};
  };
  if (field.increasing && !(cells[0] > value.columns[0].back())) {
    fail(0, "a first column that increases from row to row");
  }
  for (std::size_t j = 1; field.monotone && j < cells.size(); ++j) {
    if (cells[j] < value.columns[j].back()) fail(j, "a curve that never falls");
  }
}

}  // namespace

void ReadTable(const FieldSpec& field, const Node& node, const std::string& path,
               ValueReader& reader, FieldValue* value, std::vector<std::filesystem::path>* files) {
  TableReader(reader, files).ReadTable(field, node, path, value);
}

}  // namespace kingpin::io
