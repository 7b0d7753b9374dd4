#pragma once

#include "core/io/input_kinds.h"

namespace kingpin::apps {

/// Every kind of input file this program reads.
io::InputKinds MakeInputKinds();

}  // namespace kingpin::apps
