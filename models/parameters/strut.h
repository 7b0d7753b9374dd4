#pragma once

#include "models/parameters/table.h"

namespace kingpin::parameters {

/// What a strut or a spring-damper pair does along its line. The coil's force in design position is
/// not a datum: it follows from the static wheel load (car_derived.h).
struct SpringDamper {
  double spring_rate = 0.0;             ///< coil [N/m]
  Table rebound;                        ///< damper force [N] over speed [m/s], both positive
  Table compression;                    ///< the same, being compressed
  double jounce_clearance = 0.0;        ///< travel to the bumper's contact [m]
  Table bumper;                         ///< bumper force [N] over its compression [m]
  double rebound_clearance = 0.0;       ///< travel to the rebound stop [m]
  double rebound_stop_stiffness = 0.0;  ///< [N/m]
  double friction = 0.0;                ///< dry friction [N]
  double gas_force = 0.0;               ///< pushes the damper apart [N]
};

}  // namespace kingpin::parameters
