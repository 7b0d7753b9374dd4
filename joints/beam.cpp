#include "joints/beam.h"

#include <fmt/format.h>

#include "joints/fail.h"

namespace kingpin::joints {

namespace {

constexpr Vector3<double> kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

class Appender {
 public:
  Appender(const BeamDescription& beam, MechanismDescription& mechanism,
           std::vector<ForceDescription>& forces)
      : beam_(beam), mechanism_(mechanism), forces_(forces) {}

  BeamParts Append() {
    if (beam_.name.empty()) Fail(beam_.source, "beams", "an empty name", "a name");
    switch (beam_.root) {
      case JointType::kFixed:
      case JointType::kRevolute:
      case JointType::kSpherical:
      case JointType::kFree:
        break;
      default:
        Fail(beam_.source, fmt::format("beams.{}.root", beam_.name), "another type of joint",
             "fixed, revolute, spherical or free");
    }
    const auto& elements = beam_.elements.elements;
    for (size_t k = 0; k < elements.size(); ++k) {
      parts_.bodies.push_back(fmt::format("{}.{}", beam_.name, k));
    }
    AddJoint(beam_.name + ".root", beam_.root, beam_.at, parts_.bodies[0]);
    parts_.joints.push_back(beam_.name + ".root");
    mechanism_.bodies.push_back(MakeBody(parts_.bodies[0], elements[0].inertia, beam_.source));
    for (size_t k = 1; k < elements.size(); ++k) AddElement(k);
    parts_.end = {parts_.bodies.back(), {{}, {elements.back().end - elements.back().start, 0, 0}}};
    return std::move(parts_);
  }

 private:
  void AddJoint(const std::string& name, JointType type, const FrameDescription& parent,
                const std::string& child, const Vector3<double>& axis = kAxes[0]) {
    JointDescription joint;
    joint.name = name;
    joint.type = type;
    joint.parent = parent;
    joint.child = {child, {}};
    joint.axis = axis;
    joint.source = beam_.source;
    mechanism_.joints.push_back(std::move(joint));
  }

  // A displacement along one axis, carried by a body without mass.
  void AddSlide(const std::string& joint, int axis, FrameDescription& at) {
    const std::string body = fmt::format("{}.slide_{}", joint, "xyz"[axis]);
    mechanism_.bodies.push_back(MakeBody(body, {}, beam_.source));
    AddJoint(body, JointType::kPrismatic, at, body, kAxes[axis]);
    at = {body, {}};
  }

  void AddElement(size_t k) {
    using Flexibility = BeamDescription::Flexibility;
    const bodies::BeamElements::Spring& spring = beam_.elements.springs[k - 1];
    const std::string joint = fmt::format("{}.joint{}", beam_.name, k);
    const std::string name = fmt::format("{}.spring{}", beam_.name, k);
    const FrameDescription before{
        parts_.bodies[k - 1], {{}, {spring.position - beam_.elements.elements[k - 1].start, 0, 0}}};
    mechanism_.bodies.push_back(
        MakeBody(parts_.bodies[k], beam_.elements.elements[k].inertia, beam_.source));
    parts_.joints.push_back(joint);
    if (beam_.flexibility == Flexibility::kTorsion) {
      AddJoint(joint, JointType::kRevolute, before, parts_.bodies[k]);
      SpringDescription twist;
      twist.name = name;
      twist.place = OnCoordinate{joint, 0};
      twist.stiffness.coefficient = spring.stiffness[3];
      twist.damping.coefficient = spring.damping[3];
      twist.source = beam_.source;
      forces_.push_back(std::move(twist));
      return;
    }
    const bool all = beam_.flexibility == Flexibility::kAll;
    const bool moves[3] = {all && beam_.tension, all && beam_.shear, all && beam_.shear};
    FrameDescription at = before;
    if (moves[0] && moves[1]) {
      AddJoint(joint, JointType::kFree, at, parts_.bodies[k]);
    } else {
      for (int axis = 0; axis < 3; ++axis) {
        if (moves[axis]) AddSlide(joint, axis, at);
      }
      AddJoint(joint, JointType::kSpherical, at, parts_.bodies[k]);
    }
    BushingDescription bushing;
    bushing.name = name;
    bushing.a = before;
    bushing.b = {parts_.bodies[k], {}};
    for (int i = 0; i < 6; ++i) {
      if (i < 3 && !moves[i]) continue;
      bushing.stiffness[i].coefficient = spring.stiffness[i];
      bushing.damping[i].coefficient = spring.damping[i];
    }
    bushing.source = beam_.source;
    forces_.push_back(std::move(bushing));
  }

  const BeamDescription& beam_;
  MechanismDescription& mechanism_;
  std::vector<ForceDescription>& forces_;
  BeamParts parts_;
};

}  // namespace

BeamParts AppendBeam(const BeamDescription& beam, MechanismDescription& mechanism,
                     std::vector<ForceDescription>& forces) {
  return Appender(beam, mechanism, forces).Append();
}

BodyDescription MakeBody(const std::string& name, const bodies::RigidInertia& inertia,
                         const Source& source) {
  BodyDescription body;
  body.name = name;
  body.mass = inertia.mass;
  body.centre = inertia.centre;
  body.central_inertia = inertia.central;
  body.source = source;
  return body;
}

}  // namespace kingpin::joints
