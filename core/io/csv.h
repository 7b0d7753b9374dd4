#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Comma-separated numbers.
///
/// The contract of `signals.csv`: row 1 names the channels, row 2 their units, then numbers; the
/// first column is `time`, strictly increasing. Plain tables may leave out the units' row, or both
/// header rows; blank lines and lines that begin with `#` are skipped. A field may stand in double
/// quotes; CRLF and a UTF-8 byte order mark are accepted. `;` and tabs are not separators (the
/// message says so).
namespace kingpin::io {

struct CsvColumn {
  std::string name;            ///< `column 1` ... when the file names none
  std::string unit;            ///< as written; empty when there is no units' row
  std::vector<double> values;  ///< as written, in `unit`
};

struct CsvTable {
  std::string file;
  bool has_names = false;
  bool has_units = false;
  std::vector<CsvColumn> columns;  ///< at least one, all of the same length, at least one row
  std::vector<int> lines;          ///< of each row of numbers, counted from 1

  /// The column of a name, or null.
  const CsvColumn* Find(std::string_view name) const;
};

/// Reads any table of numbers. Throws InputError: no content, a header without numbers, ragged
/// rows, text where a number is due, NaN and infinity, unknown units, a name that stands there
/// twice.
CsvTable ReadCsv(const std::filesystem::path& path);
CsvTable ParseCsv(std::string_view text, const std::string& name);

/// A time history in SI.
struct Signals {
  struct Channel {
    std::string name;
    std::string unit;            ///< as written in the file
    std::string si_unit;         ///< of `values`
    std::vector<double> values;  ///< in SI
  };

  std::string file;
  std::vector<double> time;  ///< [s], strictly increasing, at least two samples
  std::vector<Channel> channels;
};

/// Reads a time history: both header rows, the first column `time`. A table of two columns without
/// a units' row is accepted as time in seconds and one channel without a unit.
/// Throws InputError as ReadCsv, and for one row only, a first column that is not a time, and time
/// that does not increase (with the line).
Signals ReadSignals(const std::filesystem::path& path);
Signals ParseSignals(std::string_view text, const std::string& name);

/// The channel of a name. Throws InputError that lists the channels there are and the nearest one.
const Signals::Channel& GetChannel(const Signals& signals, std::string_view name);

/// `signals.csv` as text: numbers with 17 significant digits, which read back exactly; units are
/// the channels' si_unit.
std::string FormatSignals(const Signals& signals);

}  // namespace kingpin::io
