#pragma once

#include "core/io/schema.h"
#include "models/parameters/car.h"

namespace kingpin::parameters {

/// `kind: car`. Each subsystem may stand in the file itself or in one of its own.
///
/// Beyond units and ranges it checks: everything listed lies on the left, inertias are those of
/// real bodies, curves increase and do not fall where they must not, the column's parts in series
/// equal the stated total within 0.5 %, the tie rod's chain is not stiffer than its bar, the ground
/// lies under the wheels as their static deflection says within 5 mm.
const io::Schema<Car>& CarSchema();

const io::Schema<Body>& BodySchema();
const io::Schema<FrontSuspension>& FrontSuspensionSchema();
const io::Schema<RearSuspension>& RearSuspensionSchema();
const io::Schema<Steering>& SteeringSchema();
const io::Schema<Driveline>& DrivelineSchema();
const io::Schema<Tyres>& TyresSchema();

}  // namespace kingpin::parameters
