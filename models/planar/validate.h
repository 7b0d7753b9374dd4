#pragma once

#include "models/planar/parameters.h"

namespace kingpin::planar {

/// Throws io::InputError with the key `planar.NAME` for the first parameter that makes no model: a
/// number that is not finite, a mass or inertia that is not positive (singular mass matrix), a
/// negative stiffness, damping or clearance, a rod of no length, curve nodes that do not increase,
/// a lag without its time constant.
void ValidateParameters(const Parameters<double>& parameters);

}  // namespace kingpin::planar
