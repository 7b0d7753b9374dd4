#include "core/mechanism/acceleration_kernel.h"

namespace kingpin::mechanism {

AccelerationKernel::~AccelerationKernel() = default;

std::unique_ptr<AccelerationKernel> MakeAccelerationKernel(const Model& model, int lanes) {
  switch (isa::DetectLevel()) {
    case isa::Level::kAvx512:
      return MakeAccelerationKernel(model, lanes, isa::Avx512{});
    case isa::Level::kAvx2:
      return MakeAccelerationKernel(model, lanes, isa::Avx2{});
    case isa::Level::kPortable:
      break;
  }
  return MakeAccelerationKernel(model, lanes, isa::Portable{});
}

}  // namespace kingpin::mechanism
