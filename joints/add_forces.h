#pragma once

#include <vector>

#include "joints/force_description.h"
#include "joints/mechanism.h"

namespace kingpin::joints {

/// Adds force elements to a mechanism that has been put together; elements of one kind form one
/// group.
///
/// @throws io::InputError with the source of the culprit: names given twice or empty, unknown
/// bodies or joints, ends that move as one, points that coincide at the start, axes that are
/// opposite at the start, laws that scalar_law.h rejects, coupled matrices that are not symmetric
/// or not positive semi-definite, values that are not finite
void AddForces(const std::vector<ForceDescription>& forces, Mechanism& mechanism);

}  // namespace kingpin::joints
