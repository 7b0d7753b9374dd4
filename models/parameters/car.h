#pragma once

#include <string>

#include "models/parameters/body.h"
#include "models/parameters/driveline.h"
#include "models/parameters/front_suspension.h"
#include "models/parameters/rear_suspension.h"
#include "models/parameters/steering.h"
#include "models/parameters/tyres.h"

namespace kingpin::parameters {

/// Everything both models know about a car. SI units, ISO 8855 axes, left side only (mirror y).
/// Quantities that follow from these stand in car_derived.h, never here.
struct Car {
  std::string name;
  Body body;
  FrontSuspension front;
  RearSuspension rear;
  Steering steering;
  Driveline driveline;
  Tyres tyres;
};

}  // namespace kingpin::parameters
