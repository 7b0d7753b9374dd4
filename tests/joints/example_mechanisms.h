#pragma once

#include <cmath>
#include <string>

#include "joints/mechanism.h"

namespace kingpin::joints {

inline BodyDescription MakeRod(const std::string& name, double mass, const Vector3<double>& centre,
                               double transverse, double axial = 0) {
  BodyDescription body;
  body.name = name;
  body.mass = mass;
  body.centre = centre;
  // the rod lies along x
  body.central_inertia = {axial, transverse, transverse, 0, 0, 0};
  return body;
}

inline JointDescription MakeJoint(const std::string& name, JointType type,
                                  const std::string& parent, const Vector3<double>& at,
                                  const std::string& child,
                                  const Vector3<double>& axis = {0, 0, 1}) {
  JointDescription joint;
  joint.name = name;
  joint.type = type;
  joint.parent = {parent, {{}, at}};
  joint.child = {child, {}};
  joint.axis = axis;
  return joint;
}

/// Four-bar in the xz plane: crank 0.3 m, coupler 1 m, rocker 0.8 m, ground 0.9 m, with a cut
/// spherical joint between coupler and rocker (one of its rows is redundant). The crank turns at
/// `speed`.
inline MechanismDescription MakeFourBar(double speed) {
  MechanismDescription d;
  d.name = "four-bar";
  const Vector3<double> y{0, -1, 0};  // positive angles lift x towards z
  d.bodies = {MakeRod("crank", 1, {0.15, 0, 0}, 0.01), MakeRod("coupler", 2, {0.5, 0, 0}, 0.2),
              MakeRod("rocker", 1.5, {0.4, 0, 0}, 0.1)};
  d.joints = {MakeJoint("A", JointType::kRevolute, "world", {0, 0, 0}, "crank", y),
              MakeJoint("B", JointType::kRevolute, "crank", {0.3, 0, 0}, "coupler", y),
              MakeJoint("D", JointType::kRevolute, "world", {0.9, 0, 0}, "rocker", y)};
  d.joints[0].position = {1.0};
  d.joints[0].velocity = {speed};
  ClosureDescription c;
  c.name = "C";
  c.type = ClosureType::kSpherical;
  c.a = {"coupler", {{}, {1, 0, 0}}};
  c.b = {"rocker", {{}, {0.8, 0, 0}}};
  d.closures = {c};
  // guesses near the assembled position
  d.joints[1].position = {};
  d.joints[2].position = {};
  return d;
}

/// Heavy top of Brüls and Cardona (2010): 15 kg, centre 1 m from the fixed point along y, spinning
/// at 150 rad/s.
inline MechanismDescription MakeHeavyTop() {
  MechanismDescription d;
  d.name = "heavy top";
  BodyDescription top;
  top.name = "top";
  top.mass = 15;
  top.centre = {0, 1, 0};
  top.central_inertia = {0.234375, 0.46875, 0.234375, 0, 0, 0};
  d.bodies = {top};
  d.joints = {MakeJoint("tip", JointType::kSpherical, "world", {0, 0, 0}, "top")};
  d.joints[0].velocity = {0, 150, -4.61538};
  d.gravity = {0, 0, -9.81};
  return d;
}

}  // namespace kingpin::joints
