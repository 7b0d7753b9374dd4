#include "joints/mechanism_builder.h"

#include "joints/add_forces.h"

namespace kingpin::joints {

namespace {

Source MakeSource(const CodePlace& where) { return {where.file, where.line}; }

}  // namespace

MechanismBuilder::MechanismBuilder(std::string name) { rest_.name = std::move(name); }

MechanismBuilder& MechanismBuilder::Gravity(const Vector3<double>& g) {
  rest_.gravity = g;
  return *this;
}

MechanismBuilder& MechanismBuilder::AddBody(const std::string& name,
                                            const bodies::RigidInertia& inertia, Where where) {
  rest_.bodies.push_back(MakeBody(name, inertia, MakeSource(where)));
  return *this;
}

MechanismBuilder::Joint MechanismBuilder::AddJoint(const std::string& name, JointType type,
                                                   const FrameDescription& parent,
                                                   const FrameDescription& child,
                                                   const Vector3<double>& axis, Where where) {
  JointDescription& joint = joints_.emplace_back();
  joint.name = name;
  joint.type = type;
  joint.parent = parent;
  joint.child = child;
  joint.axis = axis;
  joint.source = MakeSource(where);
  return Joint(joint);
}

MechanismBuilder::Joint MechanismBuilder::AddFixed(const std::string& name,
                                                   const FrameDescription& parent,
                                                   const FrameDescription& child, Where where) {
  return AddJoint(name, JointType::kFixed, parent, child, {0, 0, 1}, where);
}

MechanismBuilder::Joint MechanismBuilder::AddRevolute(const std::string& name,
                                                      const FrameDescription& parent,
                                                      const FrameDescription& child,
                                                      const Vector3<double>& axis, Where where) {
  return AddJoint(name, JointType::kRevolute, parent, child, axis, where);
}

MechanismBuilder::Joint MechanismBuilder::AddPrismatic(const std::string& name,
                                                       const FrameDescription& parent,
                                                       const FrameDescription& child,
                                                       const Vector3<double>& axis, Where where) {
  return AddJoint(name, JointType::kPrismatic, parent, child, axis, where);
}

MechanismBuilder::Joint MechanismBuilder::AddCylindrical(const std::string& name,
                                                         const FrameDescription& parent,
                                                         const FrameDescription& child,
                                                         const Vector3<double>& axis, Where where) {
  return AddJoint(name, JointType::kCylindrical, parent, child, axis, where);
}

MechanismBuilder::Joint MechanismBuilder::AddScrew(const std::string& name,
                                                   const FrameDescription& parent,
                                                   const FrameDescription& child,
                                                   const Vector3<double>& axis, double pitch,
                                                   Where where) {
  const Joint joint = AddJoint(name, JointType::kScrew, parent, child, axis, where);
  joints_.back().pitch = pitch;
  return joint;
}

MechanismBuilder::Joint MechanismBuilder::AddUniversal(
    const std::string& name, const FrameDescription& parent, const FrameDescription& child,
    const Vector3<double>& axis, const Vector3<double>& second_axis, Where where) {
  const Joint joint = AddJoint(name, JointType::kUniversal, parent, child, axis, where);
  joints_.back().second_axis = second_axis;
  return joint;
}

MechanismBuilder::Joint MechanismBuilder::AddPlanar(const std::string& name,
                                                    const FrameDescription& parent,
                                                    const FrameDescription& child, Where where) {
  return AddJoint(name, JointType::kPlanar, parent, child, {0, 0, 1}, where);
}

MechanismBuilder::Joint MechanismBuilder::AddSpherical(const std::string& name,
                                                       const FrameDescription& parent,
                                                       const FrameDescription& child, Where where) {
  return AddJoint(name, JointType::kSpherical, parent, child, {0, 0, 1}, where);
}

MechanismBuilder::Joint MechanismBuilder::AddFree(const std::string& name,
                                                  const FrameDescription& parent,
                                                  const FrameDescription& child, Where where) {
  return AddJoint(name, JointType::kFree, parent, child, {0, 0, 1}, where);
}

MechanismBuilder& MechanismBuilder::AddClosure(const std::string& name, ClosureType type,
                                               const FrameDescription& a, const FrameDescription& b,
                                               Where where) {
  ClosureDescription& closure = rest_.closures.emplace_back();
  closure.name = name;
  closure.type = type;
  closure.a = a;
  closure.b = b;
  closure.source = MakeSource(where);
  return *this;
}

MechanismBuilder& MechanismBuilder::AddDistance(const std::string& name, const FrameDescription& a,
                                                const FrameDescription& b, double length,
                                                Where where) {
  AddClosure(name, ClosureType::kDistance, a, b, where);
  rest_.closures.back().length = length;
  return *this;
}

MechanismBuilder& MechanismBuilder::AddRollingDisc(const std::string& name,
                                                   const FrameDescription& disc,
                                                   const FrameDescription& ground, double radius,
                                                   Where where) {
  AddClosure(name, ClosureType::kRollingDisc, disc, ground, where);
  rest_.closures.back().radius = radius;
  return *this;
}

MechanismBuilder& MechanismBuilder::AddCoupling(const std::string& name,
                                                std::vector<CouplingDescription::Term> terms,
                                                Where where) {
  CouplingDescription& coupling = rest_.couplings.emplace_back();
  coupling.name = name;
  coupling.terms = std::move(terms);
  coupling.source = MakeSource(where);
  return *this;
}

MechanismBuilder& MechanismBuilder::AddMotion(const std::string& name, const OnCoordinate& on,
                                              mechanism::Drive motion, Where where) {
  MotionDescription& entry = rest_.motions.emplace_back();
  entry.name = name;
  entry.joint = on.joint;
  entry.coordinate = on.coordinate;
  entry.motion = std::move(motion);
  entry.source = MakeSource(where);
  return *this;
}

template <class Description>
Description& MechanismBuilder::AddForceDescription(Description description, Where where) {
  description.source = MakeSource(where);
  return std::get<Description>(forces_.emplace_back(std::move(description)));
}

MechanismBuilder::Spring MechanismBuilder::AddSpring(const std::string& name,
                                                     PlaceDescription place, Where where) {
  SpringDescription spring;
  spring.name = name;
  spring.place = std::move(place);
  return Spring(AddForceDescription(std::move(spring), where));
}

MechanismBuilder::Stop MechanismBuilder::AddStop(const std::string& name, PlaceDescription place,
                                                 Where where) {
  StopDescription stop;
  stop.name = name;
  stop.place = std::move(place);
  return Stop(AddForceDescription(std::move(stop), where));
}

MechanismBuilder::Motor MechanismBuilder::AddMotor(const std::string& name, PlaceDescription place,
                                                   Where where) {
  MotorDescription motor;
  motor.name = name;
  motor.place = std::move(place);
  return Motor(AddForceDescription(std::move(motor), where));
}

MechanismBuilder::Bushing MechanismBuilder::AddBushing(const std::string& name,
                                                       const FrameDescription& a,
                                                       const FrameDescription& b, Where where) {
  BushingDescription bushing;
  bushing.name = name;
  bushing.a = a;
  bushing.b = b;
  return Bushing(AddForceDescription(std::move(bushing), where));
}

MechanismBuilder::BodyForce MechanismBuilder::AddForce(const std::string& name,
                                                       const FrameDescription& at, Where where) {
  BodyForceDescription force;
  force.name = name;
  force.at = at;
  return BodyForce(AddForceDescription(std::move(force), where));
}

MechanismBuilder& MechanismBuilder::AddCallback(const std::string& name, PlaceDescription place,
                                                std::function<double(double, double, double)> force,
                                                Where where) {
  AddForceDescription(CallbackDescription{name, std::move(place), std::move(force), {}}, where);
  return *this;
}

MechanismBuilder& MechanismBuilder::AddWrenchCallback(
    const std::string& name, const FrameDescription& a, const FrameDescription& b,
    std::function<math::Wrench<double>(double, const RelativeMotion<double>&)> wrench,
    Where where) {
  AddForceDescription(WrenchCallbackDescription{name, a, b, std::move(wrench), {}}, where);
  return *this;
}

BeamParts MechanismBuilder::AddBeam(BeamDescription beam, Where where) {
  beam.source = MakeSource(where);
  MechanismDescription parts;
  std::vector<ForceDescription> forces;
  BeamParts names = AppendBeam(beam, parts, forces);
  rest_.bodies.insert(rest_.bodies.end(), parts.bodies.begin(), parts.bodies.end());
  joints_.insert(joints_.end(), parts.joints.begin(), parts.joints.end());
  forces_.insert(forces_.end(), forces.begin(), forces.end());
  return names;
}

MechanismDescription MechanismBuilder::MakeDescription() const {
  MechanismDescription description = rest_;
  description.joints.assign(joints_.begin(), joints_.end());
  return description;
}

std::vector<ForceDescription> MechanismBuilder::ListForces() const {
  return {forces_.begin(), forces_.end()};
}

Mechanism MechanismBuilder::Make() const {
  Mechanism mechanism = MakeMechanism(MakeDescription());
  AddForces(ListForces(), mechanism);
  return mechanism;
}

}  // namespace kingpin::joints
