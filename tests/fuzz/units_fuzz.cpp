// Any text, read as a quantity: ends in a finite value or in an InputError. A unit that is read can
// be read again, and a finite value in SI reads back exactly.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/io/error.h"
#include "core/io/nearest_name.h"
#include "core/io/units.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kingpin;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static const io::Unit units[] = {io::ParseUnit("m"), io::ParseUnit("N m/rad"),
                                   io::ParseUnit("1")};
  for (const io::Unit& unit : units) {
    try {
      const double value = io::ParseQuantity(text, unit);
      if (!std::isfinite(value)) std::abort();
      if (io::ParseQuantity(io::FormatQuantity(value, unit.text), unit) != value) std::abort();
    } catch (const io::InputError& error) {
      if (error.problem().found.empty()) std::abort();
    }
  }
  try {
    const io::Unit unit = io::ParseUnit(text);
    if (io::ParseUnit(unit.text).dimension != unit.dimension) std::abort();
  } catch (const io::InputError&) {
  }
  return 0;
}
