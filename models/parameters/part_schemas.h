#pragma once

#include "core/io/schema.h"
#include "models/parameters/bushing.h"
#include "models/parameters/rigid_body.h"
#include "models/parameters/strut.h"
#include "models/parameters/tyres.h"

/// Schemas of the parts that several subsystems have.
namespace kingpin::parameters {

/// Checks that the tensor is one of a real body: each principal moment is at most the sum of the
/// other two.
const io::Schema<RigidBody>& RigidBodySchema();

const io::Schema<RevolvedBody>& RevolvedBodySchema();
const io::Schema<BushingAxis>& BushingAxisSchema();
const io::Schema<Bushing>& BushingSchema();
const io::Schema<SpringDamper>& SpringDamperSchema();

}  // namespace kingpin::parameters
