// Any text, read as a mechanism file and, while small, put together: ends in a mechanism or in an
// InputError that says what was found and expected, never in a crash, a hang or another exception.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/io/error.h"
#include "joints/mechanism_file.h"
#include "joints/mechanism_run.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kingpin;
  constexpr std::size_t kMostJoints = 12, kMostRows = 12;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    joints::MechanismFile file = joints::ReadMechanismText(text, "fuzz.yaml");
    file.start_at_rest = false;  // a search that may take long and may fail
    const joints::MechanismDescription& d = file.description;
    const std::size_t rows =
        d.closures.size() + d.couplings.size() + d.motions.size() + d.frictions.size();
    if (d.joints.size() > kMostJoints || rows > kMostRows) return 0;
    joints::CheckNames(file, joints::MakeMechanism(file));
  } catch (const io::InputError& error) {
    for (const io::InputProblem& problem : error.problems()) {
      if (problem.found.empty() || problem.expected.empty()) std::abort();
    }
  }
  return 0;
}
