#include "models/validation/parts.h"

#include <span>

#include "core/math/quaternion.h"
#include "core/solve/null_space.h"

namespace kingpin::validation {

BodyDescription MakeBody(const std::string& name, double mass, const Vector3<double>& centre,
                         const std::array<double, 6>& inertia) {
  BodyDescription body;
  body.name = name;
  body.mass = mass;
  body.centre = centre;
  body.central_inertia = inertia;
  return body;
}

BodyDescription MakeThinRod(const std::string& name, double mass, const Vector3<double>& end) {
  const double s = mass / 12;
  return MakeBody(name, mass, 0.5 * end,
                  {s * (end.y * end.y + end.z * end.z), s * (end.x * end.x + end.z * end.z),
                   s * (end.x * end.x + end.y * end.y), -s * end.x * end.y, -s * end.x * end.z,
                   -s * end.y * end.z});
}

JointDescription MakeJoint(const std::string& name, JointType type, const std::string& parent,
                           const Vector3<double>& at, const std::string& child,
                           const Vector3<double>& axis) {
  JointDescription joint;
  joint.name = name;
  joint.type = type;
  joint.parent = {parent, {{}, at}};
  joint.child = {child, {}};
  joint.axis = axis;
  return joint;
}

ClosureDescription MakeClosure(const std::string& name, ClosureType type,
                               const joints::FrameDescription& a,
                               const joints::FrameDescription& b) {
  ClosureDescription closure;
  closure.name = name;
  closure.type = type;
  closure.a = a;
  closure.b = b;
  return closure;
}

joints::FrameDescription At(const std::string& body, const Vector3<double>& point,
                            const Vector3<double>& z) {
  return {body, {math::MakeRotationWithZ(z), point}};
}

int CountFreedoms(const Mechanism& mechanism) {
  const mechanism::Model& model = mechanism.system.model;
  const std::span<const double> q(mechanism.start.data(), model.positions);
  return solve::CalcNullSpace(model, q).freedoms();
}

}  // namespace kingpin::validation
