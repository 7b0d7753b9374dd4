// Any text, read as a table and as signals: ends in numbers or in an InputError; what was read can
// be written and reads back the same.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/io/csv.h"
#include "core/io/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kingpin;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  io::Signals signals;
  try {
    const io::CsvTable table = io::ParseCsv(text, "fuzz.csv");
    for (const io::CsvColumn& column : table.columns) {
      if (column.values.size() != table.lines.size() || column.values.empty()) std::abort();
    }
    signals = io::ParseSignals(text, "fuzz.csv");
  } catch (const io::InputError& error) {
    if (error.problem().file.empty()) std::abort();
    return 0;
  }
  const io::Signals again = io::ParseSignals(io::FormatSignals(signals), "again.csv");
  if (again.time != signals.time || again.channels.size() != signals.channels.size()) std::abort();
  for (std::size_t i = 0; i < again.channels.size(); ++i) {
    if (again.channels[i].values != signals.channels[i].values) std::abort();
    if (again.channels[i].name != signals.channels[i].name) std::abort();
  }
  return 0;
}
