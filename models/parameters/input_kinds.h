#pragma once

#include "core/io/input_kinds.h"

namespace kingpin::parameters {

/// The car and each of its subsystems' files.
void AddInputKinds(io::InputKinds* kinds);

}  // namespace kingpin::parameters
