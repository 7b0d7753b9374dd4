#pragma once

#include "models/parameters/car.h"
#include "models/parameters/derived_quantity.h"

namespace kingpin::parameters {

/// What follows from a car's parameters without a simulation, and is therefore no input: masses,
/// static loads, levers of the steering, rates, ratios. `kingpin check` prints it after the values.
///
/// Rates and frequencies are those of rigid links and ideal joints; where bushings count, the
/// planar model's reduction (models/planar/car_reduction.h) has the compliant values.
DerivedQuantities CalcDerivedQuantities(const Car& car);

}  // namespace kingpin::parameters
