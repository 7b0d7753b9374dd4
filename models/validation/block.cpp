#include "models/validation/block.h"

#include "joints/add_forces.h"

namespace kingpin::validation {

Mechanism MakeBlock(double mass, double position, double velocity, double gravity,
                    joints::FrictionDescription friction) {
  MechanismDescription d;
  d.name = "block";
  d.gravity = {0, 0, -gravity};
  d.bodies = {MakeBody("block", mass, {}, {1, 1, 1})};
  d.joints = {MakeJoint("slide", JointType::kPrismatic, kWorld, {}, "block", {1, 0, 0})};
  d.joints[0].position = {position};
  d.joints[0].velocity = {velocity};
  friction.name = "rub";
  friction.joint = "slide";
  d.frictions = {std::move(friction)};
  return MakeMechanism(d);
}

void AddSpring(double stiffness, Mechanism& block) {
  joints::SpringDescription spring;
  spring.name = "spring";
  spring.place = joints::OnCoordinate{"slide"};
  spring.stiffness.coefficient = stiffness;
  spring.free = 0;
  AddForces({std::move(spring)}, block);
}

}  // namespace kingpin::validation
