#pragma once

#include "core/io/schema.h"
#include "models/parameters/car_schema.h"

namespace kingpin::parameters {

/// The shipped C-segment car, read once.
inline const Car& CSegment() {
  static const Car car = io::ReadFile(
      CarSchema(), std::string(KINGPIN_SOURCE_DIR) + "/models/data/cars/c_segment/car.yaml");
  return car;
}

}  // namespace kingpin::parameters
