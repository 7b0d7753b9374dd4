#include "joints/urdf.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include "core/io/error.h"
#include "core/io/yaml_document.h"
#include "core/math/quaternion.h"
#include "core/math/spatial_vector.h"
#include "joints/urdf_xml.h"

namespace kingpin::joints {

namespace {

using internal::XmlJoint;
using internal::XmlLink;
using internal::XmlOrigin;
using internal::XmlRobot;

// What urdfdom has to say goes to one handler for the whole process: one reader at a time, and the
// handler that was there before afterwards.
class LogCapture : public console_bridge::OutputHandler {
 public:
  LogCapture() : lock_(GetMutex()) { console_bridge::useOutputHandler(this); }
  ~LogCapture() override { console_bridge::restorePreviousOutputHandler(); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    text_ += (text_.empty() ? "" : "; ") + text;
  }
  const std::string& text() const { return text_; }

 private:
  static std::mutex& GetMutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  std::string text_;
};

std::string LinkId(std::size_t index) { return fmt::format("L{}", index); }
std::string JointId(std::size_t index) { return fmt::format("J{}", index); }

std::string Attribute(const char* name, const internal::Numbers& numbers) {
  return numbers ? fmt::format(" {}='{}'", name, *numbers) : "";
}

std::string FormatOrigin(const XmlOrigin& origin) {
  return fmt::format("<origin{}{}/>", Attribute("xyz", origin.xyz), Attribute("rpy", origin.rpy));
}

// The same robot in text that only has what the dynamics need: urdfdom's own XML reader never sees
// what a stranger wrote, and a mesh that cannot be found is no obstacle.
std::string WriteCleanUrdf(const XmlRobot& robot) {
  std::map<std::string, std::size_t> links, joints;
  for (std::size_t l = 0; l < robot.links.size(); ++l) links[robot.links[l].name] = l;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) joints[robot.joints[j].name] = j;
  std::string text = "<robot name='robot'>\n";
  for (std::size_t l = 0; l < robot.links.size(); ++l) {
    const XmlLink& link = robot.links[l];
    text += fmt::format("<link name='{}'>", LinkId(l));
    if (link.inertial_line > 0) {
      const auto& I = link.inertia;
      text += fmt::format(
          "<inertial>{}<mass value='{}'/><inertia ixx='{}' ixy='{}' ixz='{}' iyy='{}' iyz='{}' "
          "izz='{}'/></inertial>",
          FormatOrigin(link.origin), link.mass, I[0], I[1], I[2], I[3], I[4], I[5]);
    }
    text += "</link>\n";
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const XmlJoint& joint = robot.joints[j];
    text += fmt::format("<joint name='{}' type='{}'><parent link='{}'/><child link='{}'/>{}",
                        JointId(j), joint.type, LinkId(links.at(joint.parent)),
                        LinkId(links.at(joint.child)), FormatOrigin(joint.origin));
    if (joint.axis) text += fmt::format("<axis xyz='{}'/>", *joint.axis);
    if (joint.limit) {
      text += fmt::format(
          "<limit{}{} effort='{}' velocity='{}'/>", Attribute("lower", joint.limit->lower),
          Attribute("upper", joint.limit->upper), joint.limit->effort, joint.limit->velocity);
    }
    if (joint.dynamics && (joint.dynamics->damping || joint.dynamics->friction)) {
      text += fmt::format("<dynamics{}{}/>", Attribute("damping", joint.dynamics->damping),
                          Attribute("friction", joint.dynamics->friction));
    }
    if (joint.mimic) {
      text += fmt::format("<mimic joint='{}'{}{}/>", JointId(joints.at(joint.mimic->joint)),
                          Attribute("multiplier", joint.mimic->multiplier),
                          Attribute("offset", joint.mimic->offset));
    }
    text += "</joint>\n";
  }
  return text + "</robot>\n";
}

urdf::ModelInterfaceSharedPtr Parse(const XmlRobot& robot, const std::string& file) {
  const LogCapture log;
  urdf::ModelInterfaceSharedPtr model;
  std::string reason;
  try {
    model = urdf::parseURDF(WriteCleanUrdf(robot));
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!model) {
    if (reason.empty()) reason = log.text();
    throw io::InputError({.file = file,
                          .line = robot.line,
                          .key = "robot",
                          .found = "what urdfdom rejects: " + reason,
                          .expected = "a URDF robot"});
  }
  return model;
}

Vector3<double> Convert(const urdf::Vector3& a) { return {a.x, a.y, a.z}; }

Transform<double> Convert(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {math::MakeRotation(math::Quaternion<double>{r.w, r.x, r.y, r.z}), Convert(pose.position)};
}

BodyDescription MakeBody(const std::string& name, const urdf::Link& link, const Source& source) {
  BodyDescription body;
  body.name = name;
  body.source = source;
  if (!link.inertial) return body;
  const urdf::Inertial& inertial = *link.inertial;
  const Transform<double> X_LI = Convert(inertial.origin);
  body.mass = inertial.mass;
  body.centre = X_LI.p;
  const double J[6] = {inertial.ixx, inertial.iyy, inertial.izz,
                       inertial.ixy, inertial.ixz, inertial.iyz};
  // about the centre of mass, in the link's axes
  const auto I = math::MakeInertia(0.0, Vector3<double>{}, J, X_LI.R, Vector3<double>{});
  body.central_inertia = {I.xx, I.yy, I.zz, I.xy, I.xz, I.yz};
  return body;
}

JointType GetType(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
    case urdf::Joint::CONTINUOUS:
      return JointType::kRevolute;
    case urdf::Joint::PRISMATIC:
      return JointType::kPrismatic;
    case urdf::Joint::FLOATING:
      return JointType::kFree;
    case urdf::Joint::PLANAR:
      return JointType::kPlanar;
    default:
      return JointType::kFixed;
  }
}

JointDescription MakeJoint(const std::string& name, const urdf::Joint& from,
                           const std::string& parent, const std::string& child,
                           const Source& source) {
  JointDescription joint;
  joint.name = name;
  joint.type = GetType(from);
  joint.parent = {parent, Convert(from.parent_to_joint_origin_transform)};
  joint.child = {child, {}};
  joint.source = source;
  const bool has_axis = joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic ||
                        joint.type == JointType::kPlanar;
  if (!has_axis) return joint;
  const Vector3<double> printed = Convert(from.axis);
  joint.axis = (1 / CalcNorm(printed)) * printed;
  return joint;
}

UrdfJoint MakeReport(const XmlJoint& xml, const urdf::Joint& from) {
  UrdfJoint joint{xml.name, xml.type, xml.parent, xml.child, {}, 0, 0, {}};
  if (from.limits) {
    joint.limit = {from.limits->lower, from.limits->upper, from.limits->effort,
                   from.limits->velocity};
  }
  if (from.dynamics) {
    joint.damping = from.dynamics->damping;
    joint.friction = from.dynamics->friction;
  }
  if (from.mimic) joint.mimic = {xml.mimic->joint, from.mimic->multiplier, from.mimic->offset};
  return joint;
}

}  // namespace

Urdf ReadUrdfText(std::string_view text, const std::string& file, UrdfBase base) {
  const XmlRobot robot = internal::ReadUrdfXml(text, file);
  const urdf::ModelInterfaceSharedPtr model = Parse(robot, file);
  Urdf result;
  result.name = robot.name;
  result.root = robot.links[robot.root].name;
  MechanismDescription& description = result.description;
  if (!robot.name.empty()) description.name = robot.name;

  // A fixed root named `world` is the world; any other link of that name needs another for its
  // body.
  const bool root_is_world = base == UrdfBase::kFixed && result.root == kWorld;
  for (const XmlLink& link : robot.links) result.bodies[link.name] = link.name;
  if (const auto found = result.bodies.find(kWorld);
      found != result.bodies.end() && !root_is_world) {
    std::string name = "link world";
    while (result.bodies.count(name) > 0) name += '\'';
    found->second = name;
  }
  for (std::size_t l = 0; l < robot.links.size(); ++l) {
    const XmlLink& link = robot.links[l];
    const Source source{file, link.inertial_line > 0 ? link.inertial_line : link.line};
    BodyDescription body = MakeBody(result.bodies[link.name], *model->getLink(LinkId(l)), source);
    if (body.name != kWorld) description.bodies.push_back(std::move(body));
  }
  std::vector<std::string> names;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const XmlJoint& xml = robot.joints[j];
    names.push_back(xml.name);
    const urdf::Joint& joint = *model->getJoint(JointId(j));
    description.joints.push_back(MakeJoint(xml.name, joint, result.bodies[xml.parent],
                                           result.bodies[xml.child], {file, xml.line}));
    result.joints.push_back(MakeReport(xml, joint));
    if (!xml.mimic) continue;
    CouplingDescription coupling;
    coupling.name = fmt::format("{} mimics {}", xml.name, xml.mimic->joint);
    coupling.terms = {{xml.name, 0, 1}, {xml.mimic->joint, 0, -joint.mimic->multiplier}};
    coupling.offset = joint.mimic->offset;
    coupling.source = {file, xml.mimic->line};
    description.couplings.push_back(std::move(coupling));
  }
  if (!root_is_world) {
    JointDescription joint;
    joint.type = base == UrdfBase::kFloating ? JointType::kFree : JointType::kFixed;
    joint.name = base == UrdfBase::kFloating ? kFloatingBase : "fixed_base";
    joint.source = {file, robot.links[robot.root].line};
    const auto taken = std::find(names.begin(), names.end(), joint.name);
    if (taken != names.end() && base == UrdfBase::kFloating) {
      throw io::InputError(
          {.file = file,
           .line = robot.joints[taken - names.begin()].line,
           .key = fmt::format("joint[{}]", kFloatingBase),
           .found = fmt::format("a joint named '{}'", kFloatingBase),
           .expected = "another name: the joint of the floating base is called so"});
    }
    while (std::find(names.begin(), names.end(), joint.name) != names.end()) joint.name += '\'';
    joint.parent = {kWorld, {}};
    joint.child = {result.bodies[result.root], {}};
    description.joints.push_back(std::move(joint));
  }
  std::sort(result.joints.begin(), result.joints.end(),
            [](const UrdfJoint& a, const UrdfJoint& b) { return a.name < b.name; });
  return result;
}

Urdf ReadUrdf(const std::string& file, UrdfBase base) {
  return ReadUrdfText(io::ReadTextFile(file), file, base);
}

}  // namespace kingpin::joints
