#pragma once

#include "models/parameters/rigid_body.h"

namespace kingpin::parameters {

/// The car body with everything that moves with it: engine, seats, two occupants, load.
struct Body {
  RigidBody body;
  double ground_height = 0.0;  ///< z of the road under the car at rest, negative [m]
};

}  // namespace kingpin::parameters
