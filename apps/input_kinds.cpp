#include "apps/input_kinds.h"

#include "joints/mechanism_file.h"
#include "models/parameters/input_kinds.h"
#include "optimisation/study/study_schema.h"

namespace kingpin::apps {

// One line for each folder that has input files of its own.
io::InputKinds MakeInputKinds() {
  io::InputKinds kinds;
  joints::AddInputKinds(&kinds);
  parameters::AddInputKinds(&kinds);
  study::AddInputKinds(&kinds);
  return kinds;
}

bool IsMechanismFile(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error) &&
         MakeInputKinds().Detect(file).name == "mechanism";
}

}  // namespace kingpin::apps
