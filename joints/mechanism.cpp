#include "joints/mechanism.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "bodies/rigid_inertia.h"
#include "core/io/nearest_name.h"
#include "core/math/quaternion.h"
#include "core/mechanism/assemble.h"
#include "core/mechanism/compile.h"
#include "core/mechanism/kinematics.h"
#include "joints/fail.h"

namespace kingpin::joints {

namespace {

using mechanism::JointKind;
using mechanism::Link;
using mechanism::Model;

constexpr double kAssemblyTolerance = 1e-12;

void CheckUnit(const Source& source, const std::string& key, const Vector3<double>& axis) {
  const double norm = CalcNorm(axis);
  if (!(std::abs(norm - 1) < 1e-6)) {
    Fail(source, key,
         fmt::format("({:g}, {:g}, {:g}) of length {:g}", axis.x, axis.y, axis.z, norm),
         "a direction of length 1");
  }
}

void CheckBody(const BodyDescription& body) {
  const auto problem = bodies::FindInertiaProblem({body.mass, body.centre, body.central_inertia});
  if (!problem) return;
  Fail(body.source, fmt::format("bodies.{}.{}", body.name, problem->part), problem->found,
       problem->expected, problem->suggestion);
}

// One primitive of a joint's chain: its kind, and the direction of its axis in the joint frame.
struct Primitive {
  JointKind kind;
  Vector3<double> axis{0, 0, 1};
};

std::vector<Primitive> ListPrimitives(const JointDescription& joint) {
  switch (joint.type) {
    case JointType::kFixed:
      return {};
    case JointType::kRevolute:
      return {{JointKind::kRevolute, joint.axis}};
    case JointType::kPrismatic:
      return {{JointKind::kPrismatic, joint.axis}};
    case JointType::kScrew:
      return {{JointKind::kScrew, joint.axis}};
    case JointType::kCylindrical:
      return {{JointKind::kPrismatic, joint.axis}, {JointKind::kRevolute, joint.axis}};
    case JointType::kUniversal:
      return {{JointKind::kRevolute, joint.axis}, {JointKind::kRevolute, joint.second_axis}};
    case JointType::kPlanar: {
      const Rotation<double> plane = math::MakeRotationWithZ(joint.axis);
      return {{JointKind::kPrismatic, plane.x},
              {JointKind::kPrismatic, plane.y},
              {JointKind::kRevolute, joint.axis}};
    }
    case JointType::kSpherical:
      return {{JointKind::kSpherical}};
    case JointType::kFree:
      return {{JointKind::kFree}};
  }
  return {};
}

// Inertia of several bodies that are one link, summed about the link's origin.
struct LinkInertia {
  double mass = 0;
  Vector3<double> moment;
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  int bodies = 0;

  void Add(const BodyDescription& body, const Transform<double>& X_LB) {
    const double J[6] = {body.central_inertia[0], body.central_inertia[1], body.central_inertia[2],
                         body.central_inertia[3], body.central_inertia[4], body.central_inertia[5]};
    const auto I = math::MakeInertia(body.mass, body.centre, J, X_LB.R, X_LB.p);
    mass += I.m;
    moment += I.h;
    Eigen::Matrix3d about;
    about << I.xx, I.xy, I.xz, I.xy, I.yy, I.yz, I.xz, I.yz, I.zz;
    tensor += about;
    ++bodies;
  }
  void Set(Link& link) const {
    link.mass = mass;
    if (mass == 0) return;
    const Vector3<double> c = (1 / mass) * moment;
    link.centre = c;
    const Eigen::Vector3d r(c.x, c.y, c.z);
    const Eigen::Matrix3d central =
        tensor - mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
    const double entries[6] = {central(0, 0), central(1, 1), central(2, 2),
                               central(0, 1), central(0, 2), central(1, 2)};
    std::copy(entries, entries + 6, link.central_inertia);
  }
};

class Maker {
 public:
  explicit Maker(const MechanismDescription& description) : description_(description) {}

  Mechanism Make() {
    CheckNames();
    ListChildren();
    Model& model = mechanism_.system.model;
    mechanism_.system.name = description_.name;
    model.gravity = description_.gravity;
    model.links.emplace_back();
    model.links[0].name = kWorld;
    inertias_.emplace_back();
    mechanism_.bodies[kWorld] = {};
    AddChildren(kWorld);
    CheckReached();
    for (size_t l = 1; l < model.links.size(); ++l) inertias_[l].Set(model.links[l]);
    SetStart();
    for (const ClosureDescription& closure : description_.closures) AddClosure(closure);
    for (const CouplingDescription& coupling : description_.couplings) AddCoupling(coupling);
    for (const MotionDescription& motion : description_.motions) AddMotion(motion);
    for (const FrictionDescription& friction : description_.frictions) AddFriction(friction);
    mechanism::CompileTopology(model);
    Assemble();
    try {
      mechanism::CompileElimination(
          model, {mechanism_.start.data(), static_cast<size_t>(model.positions)});
    } catch (const std::invalid_argument& error) {
      FailForInertia(error.what());
    }
    return std::move(mechanism_);
  }

 private:
  // The message names the link: that of the joint's child, or one of its chain ("NAME 2").
  [[noreturn]] void FailForInertia(const std::string& message) const {
    const JointDescription* culprit = nullptr;
    for (const JointDescription* joint : descriptions_) {
      for (const char* end : {"'", " "}) {
        if (message.find(fmt::format("'{}{}", joint->child.body, end)) != std::string::npos) {
          culprit = joint;
        }
      }
    }
    Fail(culprit ? culprit->source : Source{},
         culprit ? fmt::format("joints.{}", culprit->name) : "bodies", message,
         "a mass on every link that moves");
  }

  void CheckNames() {
    std::map<std::string, const Source*, std::less<>> seen;
    const auto add = [&](const std::string& list, const std::string& name, const Source& source) {
      if (name.empty()) Fail(source, list, "an empty name", "a name");
      if (!seen.emplace(list + '.' + name, &source).second) {
        Fail(source, list + '.' + name, "a name given twice", "one of each name");
      }
    };
    for (const BodyDescription& body : description_.bodies) {
      if (body.name == kWorld)
        Fail(body.source, "bodies.world", "a body named 'world'", "another name");
      add("bodies", body.name, body.source);
      CheckBody(body);
      bodies_[body.name] = &body;
    }
    for (const JointDescription& joint : description_.joints) {
      add("joints", joint.name, joint.source);
      CheckJoint(joint);
    }
    for (const auto& closure : description_.closures) add("closures", closure.name, closure.source);
    for (const auto& coupling : description_.couplings)
      add("closures", coupling.name, coupling.source);
    for (const auto& motion : description_.motions) add("closures", motion.name, motion.source);
    for (const auto& friction : description_.frictions) {
      add("closures", friction.name, friction.source);
    }
    for (double g : {description_.gravity.x, description_.gravity.y, description_.gravity.z}) {
      if (!std::isfinite(g)) Fail({}, "gravity", fmt::format("{:g}", g), "finite numbers [m/s^2]");
    }
  }

  void CheckBodyName(const Source& source, const std::string& key, const std::string& name) const {
    if (name == kWorld || bodies_.count(name) > 0) return;
    std::vector<std::string> known = {kWorld};
    for (const auto& [body, unused] : bodies_) known.push_back(body);
    Fail(source, key, fmt::format("'{}'", name), "the name of a body",
         io::SuggestName(name, known, "bodies"));
  }

  void CheckFrame(const Source& source, const std::string& key,
                  const FrameDescription& frame) const {
    CheckBodyName(source, key, frame.body);
    if (!IsFinite(frame.X_BF)) Fail(source, key, "a number that is not finite", "a pose");
  }

  void CheckJoint(const JointDescription& joint) const {
    const std::string key = fmt::format("joints.{}", joint.name);
    CheckFrame(joint.source, key + ".parent", joint.parent);
    CheckFrame(joint.source, key + ".child", joint.child);
    if (joint.child.body == kWorld) {
      Fail(joint.source, key + ".child", "'world'", "a body that moves",
           "exchange parent and child");
    }
    CheckUnit(joint.source, key + ".axis", joint.axis);
    if (joint.type == JointType::kUniversal) {
      CheckUnit(joint.source, key + ".second_axis", joint.second_axis);
      if (std::abs(Dot(joint.axis, joint.second_axis)) > 1e-6) {
        Fail(joint.source, key + ".second_axis", "an axis that is not perpendicular to the first",
             "a right angle");
      }
    }
    if (!std::isfinite(joint.pitch))
      Fail(joint.source, key + ".pitch", "a number that is not finite", "m/rad");
  }

  void ListChildren() {
    std::map<std::string, const JointDescription*> carrier;
    for (const JointDescription& joint : description_.joints) {
      const auto [before, is_new] = carrier.emplace(joint.child.body, &joint);
      if (!is_new) {
        Fail(joint.source, fmt::format("joints.{}.child", joint.name),
             fmt::format("'{}', which joint '{}' carries already", joint.child.body,
                         before->second->name),
             "one joint for each body", "close a loop with an entry under closures");
      }
      children_[joint.parent.body].push_back(&joint);
    }
    for (auto& [parent, joints] : children_) {
      std::sort(joints.begin(), joints.end(),
                [](const auto* a, const auto* b) { return a->name < b->name; });
    }
    for (const auto& [name, body] : bodies_) {
      if (carrier.count(name) == 0) {
        Fail(body->source, fmt::format("bodies.{}", name), "a body that no joint carries",
             "one joint whose child it is", "give it a joint of type free to let it fly");
      }
    }
  }

  void AddChildren(const std::string& parent) {
    const auto found = children_.find(parent);
    if (found == children_.end()) return;
    for (const JointDescription* joint : found->second) {
      AddJoint(*joint);
      AddChildren(joint->child.body);
    }
  }

  void CheckReached() const {
    for (const JointDescription& joint : description_.joints) {
      if (mechanism_.bodies.count(joint.child.body) > 0) continue;
      std::string chain = joint.child.body;
      std::string at = joint.parent.body;
      for (size_t k = 0; k < bodies_.size() && at != joint.child.body; ++k) {
        chain = at + " -> " + chain;
        for (const JointDescription& other : description_.joints) {
          if (other.child.body == at) {
            at = other.parent.body;
            break;
          }
        }
      }
      Fail(joint.source, fmt::format("joints.{}", joint.name),
           fmt::format("a cycle of joints ({} -> {})", joint.child.body, chain),
           "a tree that hangs on the world", "cut the loop with an entry under closures");
    }
  }

  void AddJoint(const JointDescription& joint) {
    Model& model = mechanism_.system.model;
    const mechanism::Frame parent = mechanism_.MakeFrame(joint.parent);
    const std::vector<Primitive> primitives = ListPrimitives(joint);
    const Transform<double> X_MC = joint.child.X_BF.Inverse();
    mechanism::Frame child{parent.link, parent.X_LF * X_MC};
    if (!primitives.empty()) {
      Mechanism::JointPlace place{joint.name, joint.type,       0, model.positions,
                                  0,          model.velocities, 0};
      Rotation<double> before;
      int link = parent.link;
      Transform<double> X_PF = parent.X_LF;
      for (const Primitive& primitive : primitives) {
        const Rotation<double> align = math::MakeRotationWithZ(primitive.axis);
        Link next;
        next.name = primitives.size() == 1 ? joint.child.body
                                           : fmt::format("{} {}", joint.child.body,
                                                         &primitive - primitives.data() + 1);
        next.parent = link;
        next.kind = primitive.kind;
        next.q = model.positions;
        next.v = model.velocities;
        next.pitch = joint.pitch;
        next.X_PF = {X_PF.R * (before.Transpose() * align), X_PF.p};
        model.positions += CountPositions(next.kind);
        model.velocities += CountVelocities(next.kind);
        link = static_cast<int>(model.links.size());
        model.links.push_back(next);
        inertias_.emplace_back();
        X_PF = {};
        before = align;
      }
      place.link = link;
      place.positions = model.positions - place.q;
      place.velocities = model.velocities - place.v;
      mechanism_.joints.push_back(place);
      descriptions_.push_back(&joint);
      child = {link, Transform<double>{before.Transpose(), {}} * X_MC};
    }
    mechanism_.bodies[joint.child.body] = child;
    inertias_[child.link].Add(*bodies_.at(joint.child.body), child.X_LF);
  }

  void CheckQuaternion(const JointDescription& joint, const Mechanism::JointPlace& place) const {
    const double* w = &mechanism_.start[place.q + place.positions - 4];
    const double norm = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3]);
    if (std::abs(norm - 1) < 1e-6) return;
    Fail(joint.source, fmt::format("joints.{}.position", joint.name),
         fmt::format("a quaternion (w, x, y, z) of length {:g}", norm), "one of length 1");
  }

  void SetStart() {
    Model& model = mechanism_.system.model;
    mechanism_.start.assign(model.positions + model.velocities, 0.0);
    held_q_.assign(model.velocities, 0);
    held_v_.assign(model.velocities, 0);
    for (size_t j = 0; j < mechanism_.joints.size(); ++j) {
      const Mechanism::JointPlace& place = mechanism_.joints[j];
      const JointDescription& joint = *descriptions_[j];
      const auto set = [&](const std::vector<double>& values, int first, int count, const char* key,
                           const char* what) {
        if (values.empty()) return false;
        if (static_cast<int>(values.size()) != count) {
          Fail(joint.source, fmt::format("joints.{}.{}", joint.name, key),
               fmt::format("{} numbers", values.size()), fmt::format("{} ({})", count, what));
        }
        for (int i = 0; i < count; ++i) {
          if (!std::isfinite(values[i])) {
            Fail(joint.source, fmt::format("joints.{}.{}", joint.name, key),
                 fmt::format("{:g}", values[i]), "finite numbers");
          }
          mechanism_.start[first + i] = values[i];
        }
        return true;
      };
      if (place.positions != place.velocities) mechanism_.start[place.q + place.positions - 4] = 1;
      if (set(joint.position, place.q, place.positions, "position",
              "coordinates; quaternions are w, x, y, z")) {
        if (place.positions != place.velocities) CheckQuaternion(joint, place);
        std::fill_n(held_q_.begin() + place.v, place.velocities, 1);
      }
      if (set(joint.velocity, model.positions + place.v, place.velocities, "velocity",
              "coordinates")) {
        std::fill_n(held_v_.begin() + place.v, place.velocities, 1);
      }
    }
  }

  int AddRows(const std::string& name, const Source& source,
              std::initializer_list<const char*> suffixes, bool holonomic = true) {
    Model& model = mechanism_.system.model;
    const int first = model.rows;
    mechanism_.rows.push_back({name, first, static_cast<int>(suffixes.size())});
    for (const char* suffix : suffixes) {
      model.row_names.push_back(*suffix ? name + '.' + suffix : name);
      model.holonomic.push_back(holonomic);
      row_sources_.push_back(&source);
      mechanism_.system.drives.emplace_back();
      ++model.rows;
    }
    return first;
  }

  void AddClosure(const ClosureDescription& closure) {
    Model& model = mechanism_.system.model;
    const std::string key = fmt::format("closures.{}", closure.name);
    CheckFrame(closure.source, key + ".a", closure.a);
    CheckFrame(closure.source, key + ".b", closure.b);
    const mechanism::Frame a = mechanism_.MakeFrame(closure.a), b = mechanism_.MakeFrame(closure.b);
    if (a.link == b.link) {
      Fail(closure.source, key,
           fmt::format("'{}' and '{}', which move as one", closure.a.body, closure.b.body),
           "two bodies that move against each other");
    }
    const auto point = [&](int axes, int row) {
      model.points.push_back({a.link, b.link, a.X_LF.p, b.X_LF, axes, row});
    };
    const auto perpendicular = [&](const Vector3<double>& u, const Vector3<double>& w, int row) {
      model.perpendiculars.push_back({a.link, b.link, u, w, row});
    };
    // The torque of a perpendicular row is along u × w: z × -y = x, z × x = y.
    const auto parallel = [&](int row) {
      perpendicular(a.X_LF.R.z, -b.X_LF.R.y, row);
      perpendicular(a.X_LF.R.z, b.X_LF.R.x, row + 1);
    };
    switch (closure.type) {
      case ClosureType::kSpherical:
        point(7, AddRows(closure.name, closure.source, {"x", "y", "z"}));
        break;
      case ClosureType::kPointOnLine:
        point(3, AddRows(closure.name, closure.source, {"x", "y"}));
        break;
      case ClosureType::kPointOnPlane:
        point(4, AddRows(closure.name, closure.source, {"z"}));
        break;
      case ClosureType::kDistance: {
        const double length = closure.length > 0 ? closure.length : CalcStartDistance(a, b);
        if (!(length > 0))
          Fail(closure.source, key + ".length", fmt::format("{:g} m", length),
               "a length above zero");
        model.distances.push_back({a.link, b.link, a.X_LF.p, b.X_LF.p, length,
                                   AddRows(closure.name, closure.source, {""})});
        break;
      }
      case ClosureType::kParallelAxes:
        parallel(AddRows(closure.name, closure.source, {"turn_x", "turn_y"}));
        break;
      case ClosureType::kPerpendicular:
        perpendicular(a.X_LF.R.z, b.X_LF.R.x, AddRows(closure.name, closure.source, {"turn"}));
        break;
      case ClosureType::kRevolute: {
        const int row = AddRows(closure.name, closure.source, {"x", "y", "z", "turn_x", "turn_y"});
        point(7, row);
        parallel(row + 3);
        break;
      }
      case ClosureType::kPrismatic: {
        const int row =
            AddRows(closure.name, closure.source, {"x", "y", "turn_x", "turn_y", "turn_z"});
        point(3, row);
        parallel(row + 2);
        perpendicular(a.X_LF.R.x, b.X_LF.R.y, row + 4);
        aligned_.push_back({&closure, a, b});
        break;
      }
      case ClosureType::kCylindrical: {
        const int row = AddRows(closure.name, closure.source, {"x", "y", "turn_x", "turn_y"});
        point(3, row);
        parallel(row + 2);
        break;
      }
      case ClosureType::kUniversal: {
        const int row = AddRows(closure.name, closure.source, {"x", "y", "z", "turn"});
        point(7, row);
        perpendicular(a.X_LF.R.z, b.X_LF.R.x, row + 3);
        break;
      }
      case ClosureType::kFixed: {
        const int row =
            AddRows(closure.name, closure.source, {"x", "y", "z", "turn_x", "turn_y", "turn_z"});
        point(7, row);
        parallel(row + 3);
        perpendicular(a.X_LF.R.x, b.X_LF.R.y, row + 5);
        aligned_.push_back({&closure, a, b});
        break;
      }
      case ClosureType::kRollingDisc: {
        if (!(closure.radius > 0)) {
          Fail(closure.source, key + ".radius", fmt::format("{:g} m", closure.radius),
               "a radius above zero");
        }
        const int row = AddRows(closure.name, closure.source, {"contact", "slip_x", "slip_y"});
        model.holonomic[row + 1] = model.holonomic[row + 2] = 0;
        model.discs.push_back({a.link, b.link, a.X_LF.p, a.X_LF.R.z, closure.radius, b.X_LF, row});
        break;
      }
    }
  }

  // The rows of a closure or coupling that are components of a force.
  std::vector<int> ListForceRows(const Mechanism::RowPlace& place) const {
    const Model& model = mechanism_.system.model;
    std::vector<int> rows;
    const auto add = [&](int first, int count) {
      for (int r = first; r < first + count; ++r) {
        if (r >= place.first && r < place.first + place.count) rows.push_back(r);
      }
    };
    for (const auto& point : model.points) add(point.row, __builtin_popcount(point.axes));
    for (const auto& distance : model.distances) add(distance.row, 1);
    for (const auto& disc : model.discs) add(disc.row, 3);
    return rows;
  }

  double CalcStartDistance(const mechanism::Frame& a, const mechanism::Frame& b) {
    Model tree;  // without the closures that stand already
    tree.links = mechanism_.system.model.links;
    tree.positions = mechanism_.system.model.positions;
    tree.velocities = mechanism_.system.model.velocities;
    mechanism::CompileTopology(tree);
    mechanism::Workspace<double> w(tree);
    mechanism::UpdatePositions(tree, mechanism_.start.data(), w);
    return CalcNorm((w.R[a.link] * a.X_LF.p + w.p[a.link]) -
                    (w.R[b.link] * b.X_LF.p + w.p[b.link]));
  }

  mechanism::LinearRow::Term MakeTerm(const Source& source, const std::string& key,
                                      const std::string& joint, int coordinate, double factor,
                                      bool rate_only) const {
    std::vector<std::string> known;
    for (const Mechanism::JointPlace& place : mechanism_.joints) {
      known.push_back(place.name);
      if (place.name != joint) continue;
      if (coordinate < 0 || coordinate >= place.velocities) {
        Fail(source, key, fmt::format("coordinate {} of joint '{}'", coordinate, joint),
             fmt::format("a coordinate from 0 to {}", place.velocities - 1));
      }
      if (!rate_only && place.positions != place.velocities) {
        Fail(source, key, fmt::format("joint '{}', whose rotation is a quaternion", joint),
             "a joint with angles or displacements", "couple its rates only");
      }
      if (!std::isfinite(factor)) Fail(source, key, fmt::format("{:g}", factor), "a finite factor");
      return {place.q + (rate_only ? 0 : coordinate), place.v + coordinate, factor};
    }
    Fail(source, key, fmt::format("'{}'", joint), "the name of a joint that moves",
         io::SuggestName(joint, known, "joints"));
  }

  void AddCoupling(const CouplingDescription& coupling) {
    const std::string key = fmt::format("couplings.{}", coupling.name);
    if (coupling.terms.empty())
      Fail(coupling.source, key + ".terms", "nothing", "at least one joint");
    mechanism::LinearRow row;
    row.rate_only = coupling.rate_only;
    double offset = 0;
    for (const CouplingDescription::Term& term : coupling.terms) {
      row.terms.push_back(MakeTerm(coupling.source, key, term.joint, term.coordinate, term.factor,
                                   coupling.rate_only));
      const auto same = [&](const auto& other) { return other.v == row.terms.back().v; };
      if (std::any_of(row.terms.begin(), row.terms.end() - 1, same)) {
        Fail(coupling.source, key + ".terms",
             fmt::format("coordinate {} of joint '{}' twice", term.coordinate, term.joint),
             "each coordinate once");
      }
      offset += term.factor * mechanism_.start[row.terms.back().q];
    }
    if (coupling.offset) offset = *coupling.offset;
    row.row = AddRows(coupling.name, coupling.source, {""}, !coupling.rate_only);
    if (!coupling.rate_only && offset != 0) {
      mechanism_.system.drives[row.row] = [offset](double) {
        return std::array<double, 3>{offset, 0, 0};
      };
    }
    mechanism_.system.model.linear.push_back(std::move(row));
  }

  void AddMotion(const MotionDescription& motion) {
    const std::string key = fmt::format("motions.{}", motion.name);
    mechanism::LinearRow row;
    for (size_t j = 0; j < mechanism_.joints.size(); ++j) {
      const Mechanism::JointPlace& place = mechanism_.joints[j];
      if (place.name != motion.joint) continue;
      // a quaternion has no coordinates of its own for the row to hold: its rates follow
      row.rate_only = place.positions != place.velocities;
      if (!row.rate_only) CheckStart(motion, key, *descriptions_[j]);
    }
    row.terms.push_back(
        MakeTerm(motion.source, key, motion.joint, motion.coordinate, 1, row.rate_only));
    row.row = AddRows(motion.name, motion.source, {""}, !row.rate_only);
    mechanism_.system.drives[row.row] = motion.motion;
    mechanism_.system.model.linear.push_back(std::move(row));
  }

  // A motion begins where its joint does.
  void CheckStart(const MotionDescription& motion, const std::string& key,
                  const JointDescription& joint) const {
    const double start = motion.motion(0)[0];
    const auto coordinate = static_cast<size_t>(motion.coordinate);
    if (coordinate >= joint.position.size()) return;
    const double given = joint.position[coordinate];
    if (!(std::abs(start - given) > 1e-9 * std::max(1.0, std::abs(given)))) return;
    Fail(motion.source, key, fmt::format("a motion that starts at {:g}", start),
         fmt::format("{:g}, where joint '{}' starts", given, joint.name));
  }

  void AddFriction(const FrictionDescription& friction) {
    const std::string key = fmt::format("frictions.{}", friction.name);
    mechanism::LinearRow row;
    row.rate_only = true;
    row.terms.push_back(
        MakeTerm(friction.source, key + ".joint", friction.joint, friction.coordinate, 1, true));
    const double values[] = {
        friction.kinetic_force,      friction.static_force, friction.kinetic_coefficient,
        friction.static_coefficient, friction.preload,      friction.stribeck_speed};
    for (double value : values) {
      if (!std::isfinite(value) || value < 0) {
        Fail(friction.source, key, fmt::format("{:g}", value), "numbers that are not negative");
      }
    }
    if (friction.static_force < friction.kinetic_force ||
        friction.static_coefficient < friction.kinetic_coefficient) {
      Fail(friction.source, key, "a static limit below the kinetic one",
           "a static limit at least as large");
    }
    if (friction.stribeck != mechanism::Friction::Stribeck::kNone && friction.stribeck_speed == 0) {
      Fail(friction.source, key + ".stribeck_speed", "0", "a speed above zero");
    }
    mechanism::Friction element;
    row.row = element.row = AddRows(friction.name, friction.source, {""}, false);
    element.static_force = friction.static_force;
    element.kinetic_force = friction.kinetic_force;
    element.static_coefficient = friction.static_coefficient;
    element.kinetic_coefficient = friction.kinetic_coefficient;
    element.preload = friction.preload;
    element.stribeck = friction.stribeck;
    element.stribeck_speed = friction.stribeck_speed;
    if (friction.from_joint) {
      // of a joint that is a chain, the link of this coordinate: its kind says which part of the
      // force is normal to the motion
      const Mechanism::JointPlace& place = mechanism_.GetJoint(friction.joint);
      const bool chain = place.positions == place.velocities;
      element.normal_link = place.link - (chain ? place.velocities - 1 - friction.coordinate : 0);
    }
    for (const std::string& name : friction.from_closures) {
      const auto found = std::find_if(mechanism_.rows.begin(), mechanism_.rows.end(),
                                      [&](const auto& place) { return place.name == name; });
      if (found == mechanism_.rows.end()) {
        std::vector<std::string> known;
        for (const auto& place : mechanism_.rows) known.push_back(place.name);
        Fail(friction.source, key + ".from_closures", fmt::format("'{}'", name),
             "the name of a closure", io::SuggestName(name, known, "closures"));
      }
      std::vector<int> rows = ListForceRows(*found);
      if (rows.empty()) {
        Fail(friction.source, key + ".from_closures", fmt::format("'{}'", name),
             "a closure that holds points together or apart, so that it transmits a force");
      }
      element.normal_rows.push_back(std::move(rows));
    }
    mechanism_.system.model.switching.resize(row.row + 1, 0);
    mechanism_.system.model.switching[row.row] = 1;
    mechanism_.system.drives[row.row] = friction.counterpart;
    mechanism_.system.model.linear.push_back(std::move(row));
    mechanism_.system.friction.push_back(std::move(element));
  }

  void Assemble() {
    const Model& model = mechanism_.system.model;
    std::vector<double> drive(model.rows), rate(model.rows);
    for (int r = 0; r < model.rows; ++r) {
      if (!mechanism_.system.drives[r]) continue;
      const std::array<double, 3> s = mechanism_.system.drives[r](0);
      drive[r] = s[0], rate[r] = s[1];
    }
    const std::span<double> q(mechanism_.start.data(), model.positions);
    const std::span<double> v(mechanism_.start.data() + model.positions, model.velocities);
    FailIfOpen(mechanism::AssemblePositions(model, drive, held_q_, kAssemblyTolerance, q),
               "m or rad");
    CheckAlignment(q);
    FailIfOpen(mechanism::AssembleVelocities(model, rate, held_v_, 1e-9, q, v), "m/s or rad/s");
  }

  // Rows that hold directions perpendicular are met half a turn away, too.
  void CheckAlignment(std::span<const double> q) const {
    if (aligned_.empty()) return;
    mechanism::Workspace<double> w(mechanism_.system.model);
    UpdatePositions(mechanism_.system.model, q.data(), w);
    for (const auto& [closure, a, b] : aligned_) {
      const Rotation<double> R_A = w.R[a.link] * a.X_LF.R, R_B = w.R[b.link] * b.X_LF.R;
      if (Dot(R_A.z, R_B.z) > 0 && Dot(R_A.x, R_B.x) > 0) continue;
      Fail(closure->source, fmt::format("closures.{}", closure->name),
           "frames a and b half a turn apart", "frames of the same orientation",
           "give start values nearer to it");
    }
  }

  void FailIfOpen(const mechanism::Assembly& assembly, const char* unit) const {
    if (assembly.closed) return;
    const int worst = assembly.open_rows.front();
    std::string others;
    for (size_t k = 1; k < assembly.open_rows.size() && k < 6; ++k) {
      others += (k > 1 ? ", " : "; also open: ") +
                mechanism_.system.model.row_names[assembly.open_rows[k]];
    }
    Fail(*row_sources_[worst], mechanism_.system.model.row_names[worst],
         fmt::format("a gap of {:g} {}{}", assembly.residual, unit, others),
         "a mechanism that can be assembled",
         "check lengths and start positions, and whether constraints contradict each other");
  }

  const MechanismDescription& description_;
  Mechanism mechanism_;
  std::map<std::string, const BodyDescription*, std::less<>> bodies_;
  std::map<std::string, std::vector<const JointDescription*>, std::less<>> children_;
  std::vector<LinkInertia> inertias_;
  std::vector<const JointDescription*> descriptions_;  // of mechanism_.joints
  std::vector<const Source*> row_sources_;
  struct Alignment {
    const ClosureDescription* closure = nullptr;
    mechanism::Frame a, b;
  };
  std::vector<Alignment> aligned_;  // closures that leave no turn
  std::vector<char> held_q_, held_v_;
};

}  // namespace

const Mechanism::JointPlace& Mechanism::GetJoint(std::string_view name) const {
  std::vector<std::string> known;
  for (const JointPlace& joint : joints) {
    if (joint.name == name) return joint;
    known.push_back(joint.name);
  }
  throw std::out_of_range(
      fmt::format("no joint '{}' moves; {}", name, io::SuggestName(name, known, "joints")));
}

const mechanism::Frame& Mechanism::GetBody(std::string_view name) const {
  const auto found = bodies.find(name);
  if (found != bodies.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [body, frame] : bodies) known.push_back(body);
  throw std::out_of_range(
      fmt::format("no body '{}'; {}", name, io::SuggestName(name, known, "bodies")));
}

mechanism::Frame Mechanism::MakeFrame(const FrameDescription& frame) const {
  const mechanism::Frame& body = GetBody(frame.body);
  return {body.link, body.X_LF * frame.X_BF};
}

Mechanism MakeMechanism(const MechanismDescription& description) {
  return Maker(description).Make();
}

}  // namespace kingpin::joints
