#include "joints/mechanism_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "core/io/nearest_name.h"
#include "core/math/cubic_spline.h"
#include "core/math/dual.h"
#include "core/mechanism/kinematics.h"
#include "core/solve/equilibrium.h"
#include "joints/add_forces.h"
#include "joints/fail.h"
#include "joints/mechanism_file_entries.h"
#include "joints/mechanism_run.h"
#include "joints/turn_watch.h"

namespace kingpin::joints {

namespace {

using file::File;
using file::FileSchema;

// Places of the entries in the file, from the record of what was read.
class Places {
 public:
  Places(const io::InputRecord& record, std::string file)
      : record_(record), file_(std::move(file)) {}
  Source Find(const std::string& path) const {
    for (const io::ValueRecord& value : record_.values) {
      if (value.origin.kind == io::ValueOrigin::Kind::kFile &&
          (value.path == path || value.path.starts_with(path + '.'))) {
        return {value.origin.file, value.origin.line};
      }
    }
    return {file_, 0};
  }
  // Written in the file or on the command line, not a default.
  bool IsGiven(const std::string& path) const {
    return std::any_of(
        record_.values.begin(), record_.values.end(), [&path](const io::ValueRecord& value) {
          return value.path == path && value.origin.kind != io::ValueOrigin::Kind::kDefault;
        });
  }

 private:
  const io::InputRecord& record_;
  std::string file_;
};

LawDescription MakeLaw(double coefficient, const std::optional<io::CurveTable>& curve) {
  LawDescription law;
  law.coefficient = curve ? 0 : coefficient;
  if (curve) {
    for (size_t i = 0; i < curve->x.size(); ++i) law.points.push_back({curve->x[i], curve->y[i]});
  }
  return law;
}

using MotionSpline = math::CubicSpline<double, file::kMotionNodes>;

mechanism::Drive MakeDrive(const file::Motion& motion) {
  if (motion.table) {
    const auto spline = std::make_shared<MotionSpline>(MotionSpline::MakeNatural(
        static_cast<int>(motion.table->x.size()), motion.table->x.data(), motion.table->y.data()));
    return [spline](double t) {
      using D = math::Dual<double, 1>;
      const D slope = spline->CalcSlope(D::MakeVariable(t, 0));
      return std::array<double, 3>{(*spline)(t), slope.v, slope.d[0]};
    };
  }
  return [motion](double t) {
    const double w = 2 * std::numbers::pi * motion.frequency, a = motion.amplitude;
    const double s = std::sin(w * t + motion.phase), c = std::cos(w * t + motion.phase);
    return std::array<double, 3>{
        motion.start + motion.rate * t + 0.5 * motion.acceleration * t * t + a * s,
        motion.rate + motion.acceleration * t + a * w * c, motion.acceleration - a * w * w * s};
  };
}

double InterpolateLinearly(const io::CurveTable& table, double t) {
  if (t <= table.x.front()) return table.y.front();
  if (t >= table.x.back()) return table.y.back();
  const size_t k = std::upper_bound(table.x.begin(), table.x.end(), t) - table.x.begin();
  const double s = (t - table.x[k - 1]) / (table.x[k] - table.x[k - 1]);
  return table.y[k - 1] + s * (table.y[k] - table.y[k - 1]);
}

// Position and velocity coordinates of a joint.
std::array<size_t, 2> CountCoordinates(JointType type) {
  switch (type) {
    case JointType::kFixed:
      return {0, 0};
    case JointType::kRevolute:
    case JointType::kPrismatic:
    case JointType::kScrew:
      return {1, 1};
    case JointType::kCylindrical:
    case JointType::kUniversal:
      return {2, 2};
    case JointType::kPlanar:
      return {3, 3};
    case JointType::kSpherical:
      return {4, 3};
    case JointType::kFree:
      break;
  }
  return {7, 6};
}

void CheckCount(const Source& source, const std::string& key, const std::vector<double>& values,
                size_t count) {
  if (values.empty() || values.size() == count) return;
  Fail(source, key, fmt::format("{} values", values.size()), fmt::format("{}", count));
}

// Start values of an entry of `joints` or `start`.
template <class Entry>
void SetStart(const Entry& j, const Source& source, const std::string& path,
              JointDescription& joint) {
  const bool turns = joint.type == JointType::kRevolute || joint.type == JointType::kScrew;
  const bool slides = joint.type == JointType::kPrismatic;
  const auto choose = [&](const std::optional<double>& one, const char* key, bool fits,
                          std::vector<double>& values) {
    if (!one) return;
    if (!fits || !values.empty()) {
      throw io::InputError(
          {.file = source.file,
           .line = source.line,
           .key = fmt::format("{}.{}", path, key),
           .found = "a start value that this joint does not have, or has already",
           .expected =
               "angle for turning, displacement for sliding joints, position for the others"});
    }
    values = {*one};
  };
  if (!j.position.empty()) joint.position = j.position;
  if (!j.velocity.empty()) joint.velocity = j.velocity;
  choose(j.angle, "angle", turns, joint.position);
  choose(j.displacement, "displacement", slides, joint.position);
  choose(j.angle_rate, "angle_rate", turns, joint.velocity);
  choose(j.displacement_rate, "displacement_rate", slides, joint.velocity);
}

// Puts the entries of a file, a URDF file and beams into one description.
class Translator {
 public:
  Translator(const File& file, const io::InputRecord& record, const std::string& name)
      : file_(file), places_(record, name) {}

  MechanismFile Translate() {
    if (file_.urdf) AddUrdf();
    description_.name = file_.name;
    description_.gravity = MakeVector(file_.gravity);
    AddBodies();
    AddBeams();  // before what refers to their ends
    AddJoints();
    SetStarts();
    AddConstraints();
    AddFrictions();
    AddSprings();
    AddStops();
    AddBushings();
    AddBodyForces();
    AddMotors();
    SetSimulation();
    result_.report = {file_.report.coordinates, file_.report.reactions,
                      places_.Find("report.coordinates"), places_.Find("report.reactions")};
    for (const auto& [name, r] : file_.responses) {
      result_.responses.push_back(
          {name, r.from, r.to, r.band[0], r.band[1], r.points, places_.Find("responses." + name)});
    }
    SetTrim();
    return std::move(result_);
  }

 private:
  // A frame in a body, or in the end of a beam.
  FrameDescription MakeFrame(const std::string& body, const FilePoint& at,
                             const FilePoint& turned) const {
    const Transform<double> X = MakePose(at, turned);
    const auto end = ends_.find(body);
    if (end == ends_.end()) return {body, X};
    return {end->second.body, end->second.X_BF * X};
  }

  PlaceDescription MakePlace(const file::Place& place) const {
    if (place.joint) return OnCoordinate{*place.joint, place.coordinate};
    const FrameDescription a = MakeFrame(*place.a, place.a_at, place.a_turned);
    const FrameDescription b = MakeFrame(*place.b, place.b_at, place.b_turned);
    if (place.between == file::Between::kAxis) return AboutAxis{a, b};
    return BetweenPoints{a, b};
  }

  void AddKinks(const io::CurveTable& table) {
    std::vector<double>& kinks = result_.simulation.kinks;
    kinks.insert(kinks.end(), table.x.begin(), table.x.end());
  }

  void AddUrdf() {
    Urdf urdf = ReadUrdf(file_.urdf->string(), file_.root);
    description_ = std::move(urdf.description);
    if (!file_.urdf_dynamics) return;
    std::map<std::string, Source> sources;
    for (const JointDescription& joint : description_.joints) sources[joint.name] = joint.source;
    for (const UrdfJoint& joint : urdf.joints) {
      if (joint.type != "revolute" && joint.type != "continuous" && joint.type != "prismatic") {
        continue;
      }
      if (joint.damping != 0) {
        SpringDescription damper;
        damper.name = joint.name + ".damping";
        damper.place = OnCoordinate{joint.name, 0};
        damper.damping.coefficient = joint.damping;
        damper.source = sources[joint.name];
        result_.forces.emplace_back(std::move(damper));
      }
      if (joint.friction != 0) {
        FrictionDescription friction;
        friction.name = joint.name + ".friction";
        friction.joint = joint.name;
        friction.static_force = friction.kinetic_force = joint.friction;
        friction.source = sources[joint.name];
        description_.frictions.push_back(std::move(friction));
      }
    }
  }

  void AddBodies() {
    for (const auto& [name, b] : file_.bodies) {
      description_.bodies.push_back(
          {name,
           b.mass,
           MakeVector(b.centre),
           {b.inertia[0], b.inertia[1], b.inertia[2], b.products[0], b.products[1], b.products[2]},
           places_.Find("bodies." + name)});
    }
  }

  void AddBeams() {
    for (const auto& [name, b] : file_.beams) {
      const std::string path = "beams." + name;
      BeamDescription beam = MakeBeamDescription(name, b, [&](const std::string& key) {
        return places_.Find(key.empty() ? path : path + '.' + key);
      });
      beam.at = MakeFrame(b.body, b.at, b.turned);
      const BeamParts parts = AppendBeam(beam, description_, result_.forces);
      ends_[name + ".end"] = parts.end;
      result_.beam_joints.insert(result_.beam_joints.end(), parts.joints.begin() + 1,
                                 parts.joints.end());
    }
  }

  void AddJoints() {
    for (const auto& [name, j] : file_.joints) {
      JointDescription joint;
      joint.name = name;
      joint.type = j.type;
      joint.parent = MakeFrame(j.parent, j.at, j.turned);
      joint.child = MakeFrame(j.child, j.child_at, j.child_turned);
      joint.axis = MakeVector(j.axis);
      joint.second_axis = MakeVector(j.second_axis);
      joint.pitch = j.pitch;
      joint.source = places_.Find("joints." + name);
      CheckAxes("joints." + name, j.type);
      SetStart(j, joint.source, "joints." + name, joint);
      description_.joints.push_back(std::move(joint));
    }
  }

  // What a joint of this type has no use for is a mistake about its type.
  void CheckAxes(const std::string& path, JointType type) const {
    const bool has_axis =
        type != JointType::kFixed && type != JointType::kSpherical && type != JointType::kFree;
    const auto check = [&](const char* key, bool has, const char* joints) {
      const std::string whole = fmt::format("{}.{}", path, key);
      if (has || !places_.IsGiven(whole)) return;
      Fail(places_.Find(whole), whole, "a key that a joint of this type does not have",
           fmt::format("it with {} only", joints));
    };
    check("axis", has_axis, "joints that have an axis");
    check("second_axis", type == JointType::kUniversal, "universal joints");
    check("pitch", type == JointType::kScrew, "screw joints");
  }

  void SetStarts() {
    for (const auto& [name, start] : file_.start) {
      const std::string path = "start." + name;
      const Source source = places_.Find(path);
      std::vector<JointDescription>& joints = description_.joints;
      const auto joint =
          std::find_if(joints.begin(), joints.end(),
                       [&name = name](const JointDescription& j) { return j.name == name; });
      if (joint == joints.end()) {
        std::vector<std::string> names;
        for (const JointDescription& j : joints) names.push_back(j.name);
        Fail(source, path, fmt::format("'{}'", name), "the name of a joint",
             io::SuggestName(name, names, "joints"));
      }
      CheckCount(source, path + ".position", start.position, CountCoordinates(joint->type)[0]);
      CheckCount(source, path + ".velocity", start.velocity, CountCoordinates(joint->type)[1]);
      SetStart(start, source, path, *joint);
    }
  }

  void AddConstraints() {
    for (const auto& [name, c] : file_.closures) {
      description_.closures.push_back({name, c.type, MakeFrame(c.a, c.a_at, c.a_turned),
                                       MakeFrame(c.b, c.b_at, c.b_turned), c.length, c.radius,
                                       places_.Find("closures." + name)});
    }
    for (const auto& [name, c] : file_.couplings) {
      CouplingDescription coupling{
          name, {}, c.offset, c.rate_only, places_.Find("couplings." + name)};
      for (const file::Term& term : c.terms) {
        coupling.terms.push_back({term.joint, term.coordinate, term.factor});
      }
      description_.couplings.push_back(std::move(coupling));
    }
    for (const auto& [name, m] : file_.motions) {
      description_.motions.push_back(
          {name, m.joint, m.coordinate, MakeDrive(m), places_.Find("motions." + name)});
      if (m.table) AddKinks(*m.table);
    }
  }

  void AddFrictions() {
    for (const auto& [name, f] : file_.frictions) {
      FrictionDescription friction;
      friction.name = name;
      friction.joint = f.joint;
      friction.coordinate = f.coordinate;
      friction.static_force = f.static_force;
      friction.kinetic_force = f.kinetic_force;
      friction.static_coefficient = f.static_coefficient;
      friction.kinetic_coefficient = f.kinetic_coefficient;
      friction.preload = f.preload;
      friction.from_joint = f.from_joint;
      friction.from_closures = f.from_closures;
      friction.stribeck = f.stribeck;
      friction.stribeck_speed = f.stribeck_speed;
      if (const double speed = f.counterpart_speed; speed != 0) {
        friction.counterpart = [speed](double t) {
          return std::array<double, 3>{speed * t, speed, 0};
        };
      }
      friction.source = places_.Find("frictions." + name);
      description_.frictions.push_back(std::move(friction));
    }
  }

  void AddSprings() {
    for (const auto& [name, s] : file_.springs) {
      SpringDescription spring;
      spring.name = name;
      spring.place = MakePlace(s.place);
      spring.stiffness = MakeLaw(s.stiffness, s.stiffness_curve);
      spring.damping = MakeLaw(s.damping, s.damping_curve);
      spring.free = s.free;
      spring.preload = s.preload;
      spring.source = places_.Find("springs." + name);
      result_.forces.emplace_back(std::move(spring));
    }
  }

  void AddStops() {
    for (const auto& [name, s] : file_.stops) {
      StopDescription stop;
      stop.name = name;
      stop.place = MakePlace(s.place);
      stop.upper = s.upper;
      stop.limit = s.limit;
      stop.stiffness.coefficient = s.stiffness;
      stop.exponent = s.exponent;
      stop.damping = s.damping;
      stop.depth = s.depth;
      stop.source = places_.Find("stops." + name);
      result_.forces.emplace_back(std::move(stop));
    }
  }

  void AddBushings() {
    for (const auto& [name, b] : file_.bushings) {
      BushingDescription bushing;
      bushing.name = name;
      bushing.a = MakeFrame(b.a, b.a_at, b.a_turned);
      bushing.b = MakeFrame(b.b, b.b_at, b.b_turned);
      for (int i = 0; i < 3; ++i) {
        bushing.stiffness[i].coefficient = b.stiffness[i];
        bushing.stiffness[3 + i].coefficient = b.turning_stiffness[i];
        bushing.damping[i].coefficient = b.damping[i];
        bushing.damping[3 + i].coefficient = b.turning_damping[i];
      }
      bushing.source = places_.Find("bushings." + name);
      result_.forces.emplace_back(std::move(bushing));
    }
  }

  void AddBodyForces() {
    for (const auto& [name, f] : file_.forces) {
      BodyForceDescription force;
      force.name = name;
      force.at = MakeFrame(f.body, f.at, {});
      force.force = MakeVector(f.force);
      force.torque = MakeVector(f.torque);
      force.axes =
          f.follows_body ? BodyForceDescription::Axes::kFrame : BodyForceDescription::Axes::kWorld;
      if (f.history) {
        force.scale = [table = *f.history](double t) { return InterpolateLinearly(table, t); };
        AddKinks(*f.history);
      }
      force.source = places_.Find("forces." + name);
      result_.forces.emplace_back(std::move(force));
    }
  }

  void AddMotors() {
    for (const auto& [name, m] : file_.motors) {
      MotorDescription motor;
      motor.name = name;
      motor.place = MakePlace(m.place);
      if (const double constant = m.force; constant != 0) {
        motor.force = [constant](double) { return constant; };
      }
      if (const double target = m.target; target != 0) {
        motor.target = [target](double) { return std::array<double, 3>{target, 0, 0}; };
      }
      motor.proportional = m.proportional;
      motor.derivative = m.derivative;
      motor.limit = m.limit;
      motor.source = places_.Find("motors." + name);
      result_.forces.emplace_back(std::move(motor));
    }
  }

  void SetTrim() {
    if (!file_.equilibrium) return;
    MechanismFile::Trim& trim = result_.trim;
    trim.source = places_.Find("equilibrium");
    for (size_t i = 0; i < file_.equilibrium->vary.size(); ++i) {
      const file::Vary& vary = file_.equilibrium->vary[i];
      trim.vary.push_back(
          {vary.of, vary.quantity, places_.Find(fmt::format("equilibrium.vary[{}]", i))});
    }
    for (size_t i = 0; i < file_.equilibrium->targets.size(); ++i) {
      const file::Target& target = file_.equilibrium->targets[i];
      trim.targets.push_back(
          {target.of, target.value, places_.Find(fmt::format("equilibrium.targets[{}]", i))});
    }
    result_.start_at_rest = true;
  }

  void SetSimulation() {
    const file::Simulation& from = file_.simulation;
    result_.start_at_rest = from.start_at_rest;
    solve::SimulationOptions& to = result_.simulation;
    to.duration = from.duration;
    to.sample_interval = from.sample_interval;
    to.stepper.method = from.method;
    to.stepper.step = from.step;
    to.stepper.relative_tolerance = from.relative_tolerance;
    to.stepper.absolute_tolerance = from.absolute_tolerance;
    to.stepper.projection_tolerance = from.constraint_tolerance;
  }

  const File& file_;
  Places places_;
  MechanismFile result_;
  MechanismDescription& description_ = result_.description;
  std::map<std::string, FrameDescription> ends_;  // of beams, by what a file calls them
};

// What a file calls the list that a force stands in.
const char* GetSection(const ForceDescription& force) {
  if (std::holds_alternative<SpringDescription>(force)) return "springs";
  if (std::holds_alternative<StopDescription>(force)) return "stops";
  if (std::holds_alternative<MotorDescription>(force)) return "motors";
  if (std::holds_alternative<BushingDescription>(force)) return "bushings";
  return "forces";
}

// AddForces knows one list of forces; a file has several.
io::InputError NameSections(const io::InputError& error,
                            const std::vector<ForceDescription>& forces) {
  std::vector<io::InputProblem> problems = error.problems();
  for (io::InputProblem& problem : problems) {
    for (const ForceDescription& force : forces) {
      const std::string& name =
          std::visit([](const auto& f) -> const std::string& { return f.name; }, force);
      const std::string path = "forces." + name;
      const bool is_it = problem.key == path || problem.key.starts_with(path + '.');
      const int line = std::visit([](const auto& f) { return f.source.line; }, force);
      if (!is_it || line != problem.line) continue;
      problem.key.replace(0, std::string("forces").size(), GetSection(force));
      break;
    }
  }
  return io::InputError(std::move(problems));
}

// The equilibrium, found without an angle having jumped on the way.
void FindRest(const MechanismFile& file, Mechanism& mechanism) {
  const mechanism::Model& model = mechanism.system.model;
  TurnWatch turns(file.forces, mechanism);
  mechanism::Workspace<double> w(model);
  const auto look = [&] {
    if (turns.empty()) return;
    const double *q = mechanism.start.data(), *v = q + model.positions;
    UpdatePositions(model, q, w);
    UpdateVelocities(model, v, w);
    turns.Look({model, 0.0, q, v, nullptr, nullptr, w});
  };
  look();
  solve::FindEquilibrium(mechanism.system, {}, mechanism.start);
  look();
}

}  // namespace

MechanismFile ReadMechanismFile(const std::filesystem::path& path, const io::ReadOptions& options,
                                io::InputRecord* record) {
  io::InputRecord own;
  io::InputRecord& read = record != nullptr ? *record : own;
  const File file = io::ReadFile(FileSchema(), path, options, &read);
  return Translator(file, read, path.string()).Translate();
}

MechanismFile ReadMechanismText(std::string_view text, const std::string& name,
                                const io::ReadOptions& options, io::InputRecord* record) {
  io::InputRecord own;
  io::InputRecord& read = record != nullptr ? *record : own;
  const File file = io::ReadText(FileSchema(), text, name, options, &read);
  return Translator(file, read, name).Translate();
}

void AddInputKinds(io::InputKinds* kinds) {
  kinds->Add({FileSchema().name(), FileSchema().core(),
              [](const std::filesystem::path& path, const io::ReadOptions& options) {
                io::InputRecord record;
                MechanismFile file = ReadMechanismFile(path, options, &record);
                // the equilibrium is one of values that are still to be found
                if (!file.trim.vary.empty()) file.start_at_rest = false;
                CheckNames(file, MakeMechanism(file));
                return record;
              }});
}

Mechanism MakeMechanism(const MechanismFile& file) {
  Mechanism mechanism = MakeMechanism(file.description);
  try {
    AddForces(file.forces, mechanism);
  } catch (const io::InputError& error) {
    throw NameSections(error, file.forces);
  }
  if (file.start_at_rest) FindRest(file, mechanism);
  return mechanism;
}

}  // namespace kingpin::joints
