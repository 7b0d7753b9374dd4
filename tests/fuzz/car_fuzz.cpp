// Any text, read as a car and as each of its parts: ends in values, from which the derived
// quantities follow, or in an InputError that names the file; never in a crash, a hang or another
// exception.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <type_traits>

#include "core/io/error.h"
#include "models/parameters/car_derived.h"
#include "models/parameters/car_schema.h"

namespace {

using namespace kingpin;

template <class T>
void Read(const io::Schema<T>& schema, std::string_view text) {
  io::InputRecord record;
  try {
    const T object = io::ReadText(schema, text, "fuzz.yaml", {}, &record);
    if constexpr (std::is_same_v<T, parameters::Car>) {
      parameters::CalcDerivedQuantities(object);
    }
  } catch (const io::InputError& error) {
    for (const io::InputProblem& problem : error.problems()) {
      if (problem.file.empty() || (problem.found.empty() && problem.expected.empty())) std::abort();
    }
  }
  if (io::FormatRecordAsText(record).empty() || io::FormatRecordAsJson(record).empty()) {
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Read(parameters::CarSchema(), text);
  Read(parameters::BodySchema(), text);
  Read(parameters::FrontSuspensionSchema(), text);
  Read(parameters::RearSuspensionSchema(), text);
  Read(parameters::SteeringSchema(), text);
  Read(parameters::DrivelineSchema(), text);
  Read(parameters::TyresSchema(), text);
  return 0;
}
