#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/derived_value.h"

/// What was understood of an input, value by value: the echo of `kingpin check`, the parameter
/// table of a report, and the list of files for a run's manifest.
namespace kingpin::io {

/// Where a value came from.
struct ValueOrigin {
  enum class Kind { kDefault, kFile, kCommandLine };

  Kind kind = Kind::kDefault;
  std::string file;       ///< as opened; empty for a default; `command line` for --set
  int line = 0;           ///< counted from 1; 0 when there is none
  std::string source;     ///< the user's `source:`, e.g. `printed in the paper, table 1`
  std::string certainty;  ///< the user's `certainty:`: P, S, D, K, E or empty (docs/formats.md)
  std::string note;       ///< the user's `note:`
};

/// `c_segment/steering.yaml:12`, `default` or `command line`.
std::string FormatOrigin(const ValueOrigin& origin);

struct ValueRecord {
  std::string path;             ///< `steering.rack.mass`, `load_cases[0].speed`
  std::string value;            ///< in SI at full precision, or the text, the choice, the list
  std::vector<double> numbers;  ///< the same in SI: one for a quantity, all for a list or table
  std::string unit;             ///< in SI; empty for text; of a table `m, N`
  std::string text;             ///< as written, e.g. `300 mm`; the default's text for a default
  std::string description;
  ValueOrigin origin;
};

struct InputRecord {
  std::string kind;                          ///< the schema's name, e.g. `car`
  std::vector<ValueRecord> values;           ///< in the schema's order
  std::vector<std::filesystem::path> files;  ///< every file read, the named one first
  DerivedValues derived;                     ///< what follows from the values, if the kind says

  /// The record of one value, or null.
  const ValueRecord* Find(std::string_view path) const;
};

/// A table for people: path, value with unit, as written, origin, source and certainty; then the
/// derived values with their formulas.
std::string FormatRecordAsText(const InputRecord& record);

/// The same for machines: `{"kind": ..., "files": [...], "values": [{"path", "value", "unit",
/// "text", "origin": {"kind", "file", "line", "source", "certainty", "note"}}, ...], "derived":
/// [{"path", "value", "unit", "formula", "source"}, ...]}`.
std::string FormatRecordAsJson(const InputRecord& record);

}  // namespace kingpin::io
