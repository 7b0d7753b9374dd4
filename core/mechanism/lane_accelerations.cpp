#include "core/mechanism/lane_accelerations.h"

namespace kingpin::mechanism {

LaneAccelerations::~LaneAccelerations() = default;

std::unique_ptr<LaneAccelerations> MakeLaneAccelerations(const Model& model, int lanes) {
  switch (isa::DetectLevel()) {
    case isa::Level::kAvx512:
      return MakeLaneAccelerations(model, lanes, isa::Avx512{});
    case isa::Level::kAvx2:
      return MakeLaneAccelerations(model, lanes, isa::Avx2{});
    case isa::Level::kPortable:
      break;
  }
  return MakeLaneAccelerations(model, lanes, isa::Portable{});
}

}  // namespace kingpin::mechanism
