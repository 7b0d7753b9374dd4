#pragma once

#include "bodies/rigid_inertia.h"
#include "joints/add_forces.h"
#include "joints/mechanism_builder.h"
#include "tests/joints/example_mechanisms.h"

// Mechanisms for properties of whole runs: allocations, repeats, threads, long runs.

namespace kingpin::joints {

/// A tree: a free body that carries arms on several types of joints.
inline Mechanism MakeSampleTree() {
  MechanismBuilder m("tree");
  m.AddBody("base", bodies::MakeBox(5, {0.4, 0.3, 0.2}));
  m.AddBody("arm", bodies::Move(bodies::MakeRod(1, 0.6), {{}, {0.3, 0, 0}}));
  m.AddBody("hand", bodies::MakeBox(0.5, {0.1, 0.2, 0.1}));
  m.AddBody("wheel", bodies::MakeCylinder(2, 0.2, 0.1));
  m.AddFree("fly", At("world"), At("base")).Velocity({0.3, 0, 1, 0.5, 0.2, -0.4});
  m.AddUniversal("shoulder", At("base", {0.2, 0, 0}), At("arm"), {0, 0, 1}, {0, 1, 0})
      .Velocity({1.0, -2.0});
  m.AddSpherical("wrist", At("arm", {0.6, 0, 0}), At("hand")).Velocity({3.0, 1.0, 2.0});
  m.AddCylindrical("axle", At("base", {-0.2, 0, 0}), At("wheel"), {1, 0, 0}).Velocity({0.1, 8.0});
  return m.Make();
}

/// A four-bar with one redundant row, a spring between points and a stop.
inline Mechanism MakeSampleLoop() {
  const MechanismDescription d = MakeFourBar(5);
  Mechanism mechanism = MakeMechanism(d);
  SpringDescription spring;
  spring.name = "spring";
  spring.place = BetweenPoints{At("world", {0, 0, 0.5}), At("rocker", {0.4, 0, 0})};
  spring.stiffness.points = {{-1.0, -300.0}, {0.0, 0.0}, {0.5, 80.0}, {1.0, 300.0}};
  spring.damping.coefficient = 1;
  StopDescription stop;
  stop.name = "stop";
  stop.place = OnCoordinate{"D"};
  stop.limit = 1.5;
  stop.stiffness.coefficient = 400;
  stop.damping = 2;
  AddForces({spring, stop}, mechanism);
  return mechanism;
}

/// Two blocks on a moving belt and on each other, sticking and slipping, one with a limit that
/// follows the load of its joint.
inline Mechanism MakeSampleFriction() {
  MechanismDescription d;
  for (const char* name : {"lower", "upper"}) {
    BodyDescription block;
    block.name = name;
    block.mass = 1;
    block.central_inertia = {1, 1, 1, 0, 0, 0};
    d.bodies.push_back(block);
  }
  d.joints = {MakeJoint("slide", JointType::kPrismatic, "world", {0, 0, 0}, "lower", {1, 0, 0}),
              MakeJoint("top", JointType::kPrismatic, "lower", {0, 0, 0.1}, "upper", {1, 0, 0})};
  d.joints[1].velocity = {0.5};
  FrictionDescription belt;
  belt.name = "belt";
  belt.joint = "slide";
  belt.static_force = 6;
  belt.kinetic_force = 4;
  belt.counterpart = [](double t) { return std::array<double, 3>{0.2 * t, 0.2, 0}; };
  FrictionDescription rub;
  rub.name = "rub";
  rub.joint = "top";
  rub.static_coefficient = 0.2;
  rub.kinetic_coefficient = 0.1;
  rub.from_joint = true;
  d.frictions = {belt, rub};
  Mechanism mechanism = MakeMechanism(d);
  SpringDescription spring;
  spring.name = "anchor";
  spring.place = OnCoordinate{"slide"};
  spring.stiffness.coefficient = 20;
  SpringDescription soft = spring;
  soft.name = "soft";
  soft.place = OnCoordinate{"top"};
  soft.stiffness.coefficient = 40;
  AddForces({spring, soft}, mechanism);
  return mechanism;
}

/// A body on a coupled bushing, with every other kind of force.
inline Mechanism MakeSampleForces() {
  MechanismBuilder m("forces");
  m.AddBody("block", bodies::MakeBox(3, {0.2, 0.3, 0.4}));
  m.AddBody("pin", bodies::MakeBox(1, {0.1, 0.1, 0.1}));
  m.AddFree("fly", At("world"), At("block")).Velocity({0.1, 0.2, 0, 1, 0, 0.5});
  m.AddCylindrical("slot", At("block", {0.3, 0, 0}), At("pin"), {0, 1, 0}).Velocity({0.4, 3.0});
  BushingDescription::Matrix6 K{};
  for (int i = 0; i < 6; ++i) K[i][i] = 200;
  K[0][4] = K[4][0] = 30;
  m.AddBushing("mount", At("world"), At("block"))
      .Stiffness({4000, 3000, 5000, 60, 80, 70})
      .Damping({20, 20, 20, 1, 1, 1})
      .CoupledStiffness(K);
  m.AddSpring("line", BetweenPoints{At("world", {1, 0, 1}), At("pin", {0.05, 0, 0})})
      .Stiffness(500)
      .Damping(4);
  m.AddSpring("twist", OnCoordinate{"slot", 1}).Stiffness(10);
  m.AddStop("end", OnCoordinate{"slot", 0}).Above(0.05).Stiffness(3000, 1.5).Damping(30);
  m.AddMotor("motor", OnCoordinate{"slot", 1}).Force([](double t) { return std::sin(20 * t); });
  m.AddForce("push", At("pin")).Force({1, 0, 2}).InFrame();
  m.AddCallback("drag", OnCoordinate{"slot", 0},
                [](double, double, double rate) { return -2 * rate * rate * rate; });
  return m.Make();
}

}  // namespace kingpin::joints
