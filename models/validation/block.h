#pragma once

#include "models/validation/parts.h"

namespace kingpin::validation {

/// A block on a slide along x, with gravity along -z; its friction element
/// is named `rub`, the slide `slide`.
Mechanism MakeBlock(double mass, double position, double velocity, double gravity,
                    joints::FrictionDescription friction);

/// A spring on the slide, without force at 0 [N/m].
void AddSpring(double stiffness, Mechanism& block);

}  // namespace kingpin::validation
