#pragma once

#include <array>
#include <memory>
#include <string>

#include "joints/mechanism.h"

namespace kingpin::validation {

using joints::BodyDescription;
using joints::ClosureDescription;
using joints::ClosureType;
using joints::JointDescription;
using joints::JointType;
using joints::kWorld;
using joints::Mechanism;
using joints::MechanismDescription;
using math::Rotation;
using math::Transform;
using math::Vector3;

/// @param inertia about the centre: Jxx, Jyy, Jzz, Jxy, Jxz, Jyz
BodyDescription MakeBody(const std::string& name, double mass, const Vector3<double>& centre,
                         const std::array<double, 6>& inertia);

/// Uniform thin rod from the body's origin to `end`.
BodyDescription MakeThinRod(const std::string& name, double mass, const Vector3<double>& end);

/// The child's frame coincides with the parent's, moved to `at`, when the coordinates are zero.
JointDescription MakeJoint(const std::string& name, JointType type, const std::string& parent,
                           const Vector3<double>& at, const std::string& child,
                           const Vector3<double>& axis = {0, 0, 1});

ClosureDescription MakeClosure(const std::string& name, ClosureType type,
                               const joints::FrameDescription& a,
                               const joints::FrameDescription& b);

/// A frame at a point of a body with its z axis along `z`.
joints::FrameDescription At(const std::string& body, const Vector3<double>& point,
                            const Vector3<double>& z = {0, 0, 1});

/// How many degrees of freedom of motion are left.
int CountFreedoms(const Mechanism& mechanism);

}  // namespace kingpin::validation
