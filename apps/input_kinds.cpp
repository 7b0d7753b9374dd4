#include "apps/input_kinds.h"

#include "models/parameters/input_kinds.h"
#include "optimisation/study/study_schema.h"

namespace kingpin::apps {

// One line for each folder that has input files of its own.
io::InputKinds MakeInputKinds() {
  io::InputKinds kinds;
  parameters::AddInputKinds(&kinds);
  study::AddInputKinds(&kinds);
  return kinds;
}

}  // namespace kingpin::apps
