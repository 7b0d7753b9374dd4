#pragma once

#include "joints/force_description.h"
#include "joints/force_place.h"
#include "joints/mechanism.h"

namespace kingpin::joints {

/// Where a force about an axis acts. If every joint between the two bodies turns about that axis or
/// slides, the place counts full turns by their coordinates.
AxisPlace MakeAxisPlace(const Mechanism& mechanism, const AboutAxis& axis);

}  // namespace kingpin::joints
