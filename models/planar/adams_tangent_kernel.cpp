#include "models/planar/adams_run.h"

namespace kingpin::planar {

template void RunAdamsJob<DualLanes<Isa::kLanes>, Isa::kLanes>(const LaneJob&);
template void RunAdamsJob<DualLanes<1>, 1>(const LaneJob&);

}  // namespace kingpin::planar
