#include "models/planar/adams_run.h"

namespace kingpin::planar {

template void RunAdamsJob<Lanes<Isa::kLanes>, Isa::kLanes>(const LaneJob&);
template void RunAdamsJob<Lanes<1>, 1>(const LaneJob&);

}  // namespace kingpin::planar
