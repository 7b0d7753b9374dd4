#include "core/io/csv.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/io/nearest_name.h"
#include "core/io/units.h"
#include "core/io/yaml_document.h"

namespace kingpin::io {
namespace {

constexpr std::size_t kLargestCsv = std::size_t{1} << 30;
constexpr std::size_t kMostColumns = 100000;

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) {
    text.remove_suffix(1);
  }
  return text;
}

bool IsNumber(std::string_view text) {
  try {
    ParseNumber(text);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// NaN and infinity count as numbers here, so that the message about them is the right one.
bool LooksLikeNumber(std::string_view text) {
  if (IsNumber(text)) return true;
  std::string word;
  for (const char c : text) {
    if (c != '+' && c != '-' && c != '.') word += static_cast<char>(c | 0x20);
  }
  return word == "nan" || word == "inf" || word == "infinity";
}

class CsvParser {
 public:
  CsvParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  CsvTable Parse() {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
    table_.file = name_;
    std::vector<std::string> fields;
    int rows = 0;
    while (NextRow(&fields)) {
      ++rows;
      if (rows == 1) {
        MakeColumns(fields);
        if (table_.has_names) continue;
      }
      if (fields.size() != table_.columns.size()) {
        Fail(line_, {}, fmt::format("{} fields", fields.size()),
             fmt::format("{} as in the first row", table_.columns.size()));
      }
      // Units may be `1`, so one field that is no number tells.
      if (rows == 2 && table_.has_names &&
          !std::all_of(fields.begin(), fields.end(), LooksLikeNumber)) {
        ReadUnits(fields);
        continue;
      }
      AddRow(fields);
    }
    if (rows == 0) Fail(0, {}, "an empty file", "a table of numbers");
    if (table_.lines.empty()) {
      Fail(line_, {}, "a header without numbers below it", "at least one row of numbers");
    }
    return std::move(table_);
  }

 private:
  [[noreturn]] void Fail(int line, std::string key, std::string found, std::string expected,
                         std::string suggestion = {}) const {
    throw InputError(InputProblem{.file = name_,
                                  .line = line,
                                  .key = std::move(key),
                                  .found = std::move(found),
                                  .expected = std::move(expected),
                                  .suggestion = std::move(suggestion)});
  }

  bool NextRow(std::vector<std::string>* fields) {
    while (!text_.empty()) {
      const std::size_t end = text_.find('\n');
      const std::string_view line = Trim(text_.substr(0, end));
      text_ = end == std::string_view::npos ? std::string_view() : text_.substr(end + 1);
      ++line_;
      if (line.empty() || line.front() == '#') continue;
      Split(line, fields);
      return true;
    }
    return false;
  }

  void Split(std::string_view line, std::vector<std::string>* fields) const {
    fields->clear();
    while (true) {
      if (fields->size() > kMostColumns) {
        Fail(line_, {}, fmt::format("more than {} fields", kMostColumns), "fewer columns");
      }
      std::string_view rest = line;
      while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
      if (rest.starts_with('"')) {
        rest.remove_prefix(1);
        std::string field;
        while (true) {
          const std::size_t quote = rest.find('"');
          if (quote == std::string_view::npos) {
            Fail(line_, {}, "a quotation mark that is not closed", "a closing quotation mark");
          }
          field += rest.substr(0, quote);
          rest.remove_prefix(quote + 1);
          if (!rest.starts_with('"')) break;
          field += '"';
          rest.remove_prefix(1);
        }
        rest = Trim(rest);
        if (!rest.empty() && rest.front() != ',') {
          Fail(line_, {}, "text after a closing quotation mark", "a comma");
        }
        fields->push_back(std::move(field));
        if (rest.empty()) return;
        line = rest.substr(1);
        continue;
      }
      const std::size_t comma = line.find(',');
      fields->emplace_back(Trim(line.substr(0, comma)));
      if (comma == std::string_view::npos) return;
      line.remove_prefix(comma + 1);
    }
  }

  void MakeColumns(const std::vector<std::string>& fields) {
    if (fields.size() == 1 && fields[0].find_first_of(";\t") != std::string::npos) {
      Fail(line_, {}, fmt::format("'{}'", fields[0]), "fields separated by commas",
           "separate fields by ',', and write numbers with a decimal point");
    }
    table_.has_names = std::none_of(fields.begin(), fields.end(), LooksLikeNumber);
    std::set<std::string> names;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      CsvColumn column;
      column.name = table_.has_names ? fields[i] : fmt::format("column {}", i + 1);
      if (column.name.empty()) {
        Fail(line_, fmt::format("column {}", i + 1), "no name", "a name for every column");
      }
      if (!names.insert(column.name).second) {
        Fail(line_, column.name, "the name a second time", "each column once");
      }
      table_.columns.push_back(std::move(column));
    }
  }

  void ReadUnits(const std::vector<std::string>& fields) {
    table_.has_units = true;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      CsvColumn& column = table_.columns[i];
      try {
        ParseUnit(fields[i]);
      } catch (const InputError& error) {
        Fail(line_, column.name, error.problem().found, error.problem().expected,
             error.problem().suggestion);
      }
      column.unit = fields[i];
    }
  }

  void AddRow(const std::vector<std::string>& fields) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      double value = 0.0;
      try {
        value = ParseNumber(fields[i]);
      } catch (const InputError& error) {
        Fail(line_, table_.columns[i].name, error.problem().found, error.problem().expected,
             error.problem().suggestion);
      }
      table_.columns[i].values.push_back(value);
    }
    table_.lines.push_back(line_);
  }

  std::string_view text_;
  const std::string& name_;
  CsvTable table_;
  int line_ = 0;
};

// SI text for a unit that is not SI itself: built from the base units.
std::string MakeSiUnit(const Unit& unit) {
  if (unit.is_si()) return unit.text;
  static constexpr const char* kBases[] = {"m", "kg", "s", "A", "rad", "cycle"};
  std::string above;
  std::string below;
  int factors_below = 0;
  for (int i = 0; i < Dimension::kCount; ++i) {
    const int quarters = unit.dimension.quarters[i];
    if (quarters == 0) continue;
    const double exponent = std::abs(quarters) / 4.0;
    std::string& side = quarters > 0 ? above : below;
    if (!side.empty()) side += ' ';
    side += kBases[i];
    if (exponent != 1.0) side += fmt::format("^{}", exponent);
    if (quarters < 0) ++factors_below;
  }
  if (below.empty()) return above.empty() ? "1" : above;
  if (factors_below > 1) below = fmt::format("({})", below);
  return fmt::format("{}/{}", above.empty() ? "1" : above, below);
}

Signals MakeSignals(CsvTable table) {
  const auto fail = [&table](int line, std::string key, std::string found, std::string expected) {
    throw InputError(InputProblem{.file = table.file,
                                  .line = line,
                                  .key = std::move(key),
                                  .found = std::move(found),
                                  .expected = std::move(expected)});
  };
  if (table.columns.size() < 2) {
    fail(1, {}, "one column", "time and at least one channel");
  }
  if (!table.has_units && table.columns.size() != 2) {
    fail(2, {}, "no units in the second row",
         "units below the names, such as 's,rad/s^2', or two plain columns");
  }
  const CsvColumn& first = table.columns.front();
  Unit time_unit = ParseUnit(table.has_units ? first.unit : "s");
  if (time_unit.dimension != ParseUnit("s").dimension) {
    fail(2, first.name, fmt::format("unit '{}'", first.unit), "a time in s in the first column");
  }
  if (table.has_units && first.name != "time") {
    fail(1, first.name, fmt::format("'{}'", first.name), "'time' as the first column");
  }
  if (table.lines.size() < 2) {
    fail(table.lines.front(), {}, "one row of numbers", "at least two samples");
  }
  Signals signals;
  signals.file = table.file;
  for (std::size_t i = 0; i < first.values.size(); ++i) {
    signals.time.push_back(time_unit.ToSi(first.values[i]));
    if (i > 0 && !(signals.time[i] > signals.time[i - 1])) {
      fail(table.lines[i], first.name,
           fmt::format("{} after {}", FormatNumber(first.values[i]),
                       FormatNumber(first.values[i - 1])),
           "time that increases from row to row");
    }
  }
  for (std::size_t j = 1; j < table.columns.size(); ++j) {
    CsvColumn& column = table.columns[j];
    const Unit unit = ParseUnit(column.unit);
    Signals::Channel channel{.name = std::move(column.name),
                             .unit = column.unit,
                             .si_unit = MakeSiUnit(unit),
                             .values = std::move(column.values)};
    if (!unit.is_si()) {
      for (double& value : channel.values) value = unit.ToSi(value);
    }
    signals.channels.push_back(std::move(channel));
  }
  return signals;
}

std::string QuoteField(const std::string& field) {
  if (field.find_first_of(",\"\n#") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

const CsvColumn* CsvTable::Find(std::string_view name) const {
  for (const CsvColumn& column : columns) {
    if (column.name == name) return &column;
  }
  return nullptr;
}

CsvTable ParseCsv(std::string_view text, const std::string& name) {
  return CsvParser(text, name).Parse();
}

CsvTable ReadCsv(const std::filesystem::path& path) {
  return ParseCsv(ReadTextFile(path, kLargestCsv), path.string());
}

Signals ParseSignals(std::string_view text, const std::string& name) {
  return MakeSignals(ParseCsv(text, name));
}

Signals ReadSignals(const std::filesystem::path& path) { return MakeSignals(ReadCsv(path)); }

const Signals::Channel& GetChannel(const Signals& signals, std::string_view name) {
  std::vector<std::string> names;
  for (const Signals::Channel& channel : signals.channels) {
    if (channel.name == name) return channel;
    names.push_back(channel.name);
  }
  const std::string nearest = FindNearestName(name, names);
  std::string list;
  for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
  throw InputError(InputProblem{
      .file = signals.file,
      .line = 1,
      .key = std::string(name),
      .found = "no such channel",
      .expected = "one of " + list,
      .suggestion = nearest.empty() ? "" : fmt::format("did you mean '{}'?", nearest)});
}

std::string FormatSignals(const Signals& signals) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "time");
  for (const auto& channel : signals.channels) fmt::format_to(out, ",{}", QuoteField(channel.name));
  fmt::format_to(out, "\ns");
  for (const auto& channel : signals.channels) {
    fmt::format_to(out, ",{}", channel.si_unit.empty() ? "1" : channel.si_unit);
  }
  fmt::format_to(out, "\n");
  for (std::size_t i = 0; i < signals.time.size(); ++i) {
    fmt::format_to(out, "{:.17g}", signals.time[i]);
    for (const auto& channel : signals.channels) {
      fmt::format_to(out, ",{:.17g}", channel.values[i]);
    }
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

}  // namespace kingpin::io
