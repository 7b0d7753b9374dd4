// Any text, read as URDF and put together with a fixed and with a floating base: ends in a
// mechanism or in an InputError that names the file, never in a crash, a hang or another exception.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/io/error.h"
#include "joints/mechanism.h"
#include "joints/urdf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kingpin;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto base : {joints::UrdfBase::kFixed, joints::UrdfBase::kFloating}) {
    try {
      const joints::Urdf urdf = joints::ReadUrdfText(text, "fuzz.urdf", base);
      if (urdf.description.joints.size() < 40) joints::MakeMechanism(urdf.description);
    } catch (const io::InputError& error) {
      for (const io::InputProblem& problem : error.problems()) {
        if (problem.found.empty() || problem.expected.empty()) std::abort();
      }
    }
  }
  return 0;
}
