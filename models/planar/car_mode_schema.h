#pragma once

#include "core/io/schema.h"
#include "models/planar/car_mode_options.h"

namespace kingpin::planar {

/// The section of a study that says how the car is reduced to the planar model. Every key has a
/// default.
const io::Schema<CarModeOptions>& CarModeSchema();

}  // namespace kingpin::planar
