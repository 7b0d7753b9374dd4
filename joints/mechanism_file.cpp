#include "joints/mechanism_file.h"

#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "core/math/cubic_spline.h"
#include "core/math/quaternion.h"
#include "core/solve/equilibrium.h"
#include "joints/add_forces.h"

namespace kingpin::joints {

namespace {

using Point = std::array<double, 3>;

constexpr int kMotionNodes = 512;

Vector3<double> MakeVector(const Point& p) { return {p[0], p[1], p[2]}; }

// What the file says, in its own terms.

struct Body {
  double mass = 0;
  Point centre{};
  Point inertia{};
  Point products{};
};

struct Joint {
  JointType type = JointType::kRevolute;
  std::string parent = kWorld, child;
  Point at{}, turned{}, child_at{}, child_turned{};
  Point axis{0, 0, 1}, second_axis{1, 0, 0};
  double pitch = 0;
  std::optional<double> angle, displacement, angle_rate, displacement_rate;
  std::vector<double> position, velocity;
};

struct Closure {
  ClosureType type = ClosureType::kSpherical;
  std::string a, b = kWorld;
  Point a_at{}, a_turned{}, b_at{}, b_turned{};
  double length = 0, radius = 0;
};

struct Term {
  std::string joint;
  int coordinate = 0;
  double factor = 1;
};

struct Coupling {
  std::vector<Term> terms;
  std::optional<double> offset;
  bool rate_only = false;
};

struct Motion {
  std::string joint;
  int coordinate = 0;
  std::optional<io::CurveTable> table;
  double start = 0, rate = 0, acceleration = 0, amplitude = 0, frequency = 0, phase = 0;
};

struct FrictionEntry {
  std::string joint;
  int coordinate = 0;
  double static_force = 0, kinetic_force = 0, static_coefficient = 0, kinetic_coefficient = 0,
         preload = 0;
  bool from_joint = false;
  std::vector<std::string> from_closures;
  mechanism::Friction::Stribeck stribeck = mechanism::Friction::Stribeck::kNone;
  double stribeck_speed = 0, counterpart_speed = 0;
};

// Where a force with one degree of freedom acts: a joint's coordinate, or between two frames.
enum class Between { kPoints, kAxis };
struct Place {
  std::optional<std::string> joint;
  int coordinate = 0;
  std::optional<std::string> a, b;
  Point a_at{}, a_turned{}, b_at{}, b_turned{};
  Between between = Between::kPoints;
};

struct Spring {
  Place place;
  double stiffness = 0, damping = 0, preload = 0;
  std::optional<double> free;
  std::optional<io::CurveTable> stiffness_curve, damping_curve;
};

struct Stop {
  Place place;
  bool upper = true;
  double limit = 0, stiffness = 0, exponent = 1, damping = 0, depth = 1e-3;
};

struct Bushing {
  std::string a, b;
  Point a_at{}, a_turned{}, b_at{}, b_turned{};
  Point stiffness{}, turning_stiffness{}, damping{}, turning_damping{};
};

struct Force {
  std::string body;
  Point at{}, force{}, torque{};
  bool follows_body = false;
  std::optional<io::CurveTable> history;
};

struct Motor {
  Place place;
  double force = 0, target = 0, proportional = 0, derivative = 0;
  std::optional<double> limit;
};

struct Simulation {
  solve::Method method = solve::Method::kRosenbrock;
  double step = 5e-4, duration = 1, sample_interval = 1e-3;
  double relative_tolerance = 1e-9, absolute_tolerance = 1e-11, constraint_tolerance = 1e-10;
  bool start_at_rest = false;
};

struct File {
  std::string name;
  Point gravity{0, 0, -9.80665};
  io::NamedList<Body> bodies;
  io::NamedList<Joint> joints;
  io::NamedList<Closure> closures;
  io::NamedList<Coupling> couplings;
  io::NamedList<Motion> motions;
  io::NamedList<FrictionEntry> frictions;
  io::NamedList<Spring> springs;
  io::NamedList<Stop> stops;
  io::NamedList<Bushing> bushings;
  io::NamedList<Force> forces;
  io::NamedList<Motor> motors;
  Simulation simulation;
};

const io::Schema<Body>& BodySchema() {
  static const io::Schema<Body> schema = [] {
    io::Schema<Body> s("body", "A rigid body.");
    s.Quantity("mass", &Body::mass, "kg", "mass").NonNegative();
    s.Point("centre", &Body::centre, "m", "centre of mass in the body frame").Default("[0, 0, 0]");
    s.Point("inertia", &Body::inertia, "kg m^2", "moments Jxx, Jyy, Jzz about the centre of mass")
        .Default("[0, 0, 0]");
    s.Point("products", &Body::products, "kg m^2", "Jxy, Jxz, Jyz of the tensor, Jxy = -∫xy dm")
        .Default("[0, 0, 0]");
    return s;
  }();
  return schema;
}

const io::Schema<Joint>& JointSchema() {
  static const io::Schema<Joint> schema = [] {
    io::Schema<Joint> s(
        "joint",
        "A joint of the tree; at position zero the child's joint frame lies on the parent's.");
    s.Choice(
        "type", &Joint::type,
        {{"fixed", JointType::kFixed, "moves as one with the parent"},
         {"revolute", JointType::kRevolute, "angle about the axis"},
         {"prismatic", JointType::kPrismatic, "displacement along the axis"},
         {"screw", JointType::kScrew, "angle about the axis, pitch along it"},
         {"cylindrical", JointType::kCylindrical, "displacement along, then angle about the axis"},
         {"universal", JointType::kUniversal, "angle about the axis, then about the second axis"},
         {"planar", JointType::kPlanar,
          "x, y and angle in the plane normal to z of the joint frame"},
         {"spherical", JointType::kSpherical, "quaternion"},
         {"free", JointType::kFree, "position and quaternion"}},
        "how the child moves");
    s.Text("parent", &Joint::parent, "body that carries the joint").Default("world");
    s.Text("child", &Joint::child, "body that the joint carries");
    s.Point("at", &Joint::at, "m", "the joint in the parent's frame").Default("[0, 0, 0]");
    s.Point("turned", &Joint::turned, "rad", "rotation vector of the joint frame in the parent")
        .Default("[0, 0, 0]");
    s.Point("child_at", &Joint::child_at, "m", "the joint in the child's frame")
        .Default("[0, 0, 0]");
    s.Point("child_turned", &Joint::child_turned, "rad",
            "rotation vector of the joint frame in the child")
        .Default("[0, 0, 0]");
    s.Point("axis", &Joint::axis, "1", "axis in the joint frame, of length 1").Default("[0, 0, 1]");
    s.Point("second_axis", &Joint::second_axis, "1", "of a universal joint").Default("[1, 0, 0]");
    s.Quantity("pitch", &Joint::pitch, "m/rad", "of a screw").Default("0 m/rad");
    s.Quantity("angle", &Joint::angle, "rad", "start value of a joint with one angle").Optional();
    s.Quantity("displacement", &Joint::displacement, "m",
               "start value of a joint with one displacement")
        .Optional();
    s.Quantity("angle_rate", &Joint::angle_rate, "rad/s", "start value").Optional();
    s.Quantity("displacement_rate", &Joint::displacement_rate, "m/s", "start value").Optional();
    s.Quantities("position", &Joint::position, "1",
                 "start values of all coordinates, SI; quaternions are w, x, y, z")
        .Optional();
    s.Quantities("velocity", &Joint::velocity, "1", "start values of all velocity coordinates, SI")
        .Optional();
    return s;
  }();
  return schema;
}

const io::Schema<Closure>& ClosureSchema() {
  static const io::Schema<Closure> schema = [] {
    io::Schema<Closure> s("closure", "Closes a loop between two bodies of the tree.");
    s.Choice(
        "type", &Closure::type,
        {{"spherical", ClosureType::kSpherical, "the points coincide"},
         {"point_on_line", ClosureType::kPointOnLine, "a's point on b's z axis"},
         {"point_on_plane", ClosureType::kPointOnPlane, "a's point in b's xy plane"},
         {"distance", ClosureType::kDistance, "the points keep their distance"},
         {"parallel_axes", ClosureType::kParallelAxes, "a's z axis parallel to b's"},
         {"perpendicular", ClosureType::kPerpendicular, "a's z axis perpendicular to b's x axis"},
         {"revolute", ClosureType::kRevolute, "points coincide, z axes parallel"},
         {"prismatic", ClosureType::kPrismatic, "a slides along b's z axis without turning"},
         {"cylindrical", ClosureType::kCylindrical, "a slides along and turns about b's z axis"},
         {"universal", ClosureType::kUniversal,
          "points coincide, a's z axis perpendicular to b's x axis"},
         {"fixed", ClosureType::kFixed, "nothing moves"},
         {"rolling_disc", ClosureType::kRollingDisc,
          "a's disc about its z axis rolls on b's xy plane"}},
        "what is held");
    s.Text("a", &Closure::a, "first body");
    s.Point("a_at", &Closure::a_at, "m", "point in a").Default("[0, 0, 0]");
    s.Point("a_turned", &Closure::a_turned, "rad", "rotation vector of the frame in a")
        .Default("[0, 0, 0]");
    s.Text("b", &Closure::b, "second body").Default("world");
    s.Point("b_at", &Closure::b_at, "m", "point in b").Default("[0, 0, 0]");
    s.Point("b_turned", &Closure::b_turned, "rad", "rotation vector of the frame in b")
        .Default("[0, 0, 0]");
    s.Quantity("length", &Closure::length, "m", "distance; 0: that of the start")
        .NonNegative()
        .Default("0 m");
    s.Quantity("radius", &Closure::radius, "m", "of a rolling disc").NonNegative().Default("0 m");
    return s;
  }();
  return schema;
}

const io::Schema<Coupling>& CouplingSchema() {
  static const io::Schema<Coupling> schema = [] {
    io::Schema<Term> term("term", "One coordinate of a coupling.");
    term.Text("joint", &Term::joint, "a joint that moves");
    term.Integer("coordinate", &Term::coordinate, "of a joint with several, from 0").Default("0");
    term.Quantity("factor", &Term::factor, "1", "in SI: 1, 1/m or m").Default("1");
    io::Schema<Coupling> s("coupling",
                           "The sum of factor times coordinate stays what it is: gear, rack and "
                           "pinion, differential.");
    s.List("terms", &Coupling::terms, term, "coordinates");
    s.Quantity("offset", &Coupling::offset, "1", "what the sum is; absent: what the start gives")
        .Optional();
    s.Boolean("rate_only", &Coupling::rate_only, "couples the rates only").Default("false");
    return s;
  }();
  return schema;
}

const io::Schema<Motion>& MotionSchema() {
  static const io::Schema<Motion> schema = [] {
    io::Schema<Motion> s("motion",
                         "A coordinate follows start + rate t + acceleration t²/2 + amplitude "
                         "sin(2π frequency t + phase), or a table; SI.");
    s.Text("joint", &Motion::joint, "a joint that moves");
    s.Integer("coordinate", &Motion::coordinate, "of a joint with several, from 0").Default("0");
    s.Quantity("start", &Motion::start, "1", "at t = 0 [m, rad]").Default("0");
    s.Quantity("rate", &Motion::rate, "1", "[m/s, rad/s]").Default("0");
    s.Quantity("acceleration", &Motion::acceleration, "1", "[m/s^2, rad/s^2]").Default("0");
    s.Quantity("amplitude", &Motion::amplitude, "1", "[m, rad]").Default("0");
    s.Quantity("frequency", &Motion::frequency, "Hz", "of the sine").Default("0 Hz");
    s.Quantity("phase", &Motion::phase, "rad", "of the sine").Default("0 rad");
    s.Curve("table", &Motion::table, {"time", "s"}, {"value", "1"},
            "natural spline through these points instead")
        .Increasing()
        .Count(2, kMotionNodes)
        .Optional();
    return s;
  }();
  return schema;
}

const io::Schema<FrictionEntry>& FrictionSchema() {
  static const io::Schema<FrictionEntry> schema = [] {
    using Stribeck = mechanism::Friction::Stribeck;
    io::Schema<FrictionEntry> s(
        "friction", "Dry friction in a coordinate; limits are force + coefficient × normal force.");
    s.Text("joint", &FrictionEntry::joint, "a joint that moves");
    s.Integer("coordinate", &FrictionEntry::coordinate, "of a joint with several, from 0")
        .Default("0");
    s.Quantity("static_force", &FrictionEntry::static_force, "1", "[N, N m]")
        .NonNegative()
        .Default("0");
    s.Quantity("kinetic_force", &FrictionEntry::kinetic_force, "1", "[N, N m]")
        .NonNegative()
        .Default("0");
    s.Quantity("static_coefficient", &FrictionEntry::static_coefficient, "1",
               "for turning joints times the radius [m]")
        .NonNegative()
        .Default("0");
    s.Quantity("kinetic_coefficient", &FrictionEntry::kinetic_coefficient, "1", "")
        .NonNegative()
        .Default("0");
    s.Quantity("preload", &FrictionEntry::preload, "N", "part of the normal force")
        .NonNegative()
        .Default("0 N");
    s.Boolean("from_joint", &FrictionEntry::from_joint,
              "the joint's own load is part of the normal force")
        .Default("false");
    s.Texts("from_closures", &FrictionEntry::from_closures,
            "so are the reactions of these closures")
        .Optional();
    s.Choice("stribeck", &FrictionEntry::stribeck,
             {{"none", Stribeck::kNone, "kinetic limit at once"},
              {"exponential", Stribeck::kExponential, "falls as exp(-speed/stribeck_speed)"},
              {"hyperbolic", Stribeck::kHyperbolic, "falls as 1/(1 + speed/stribeck_speed)"}},
             "from the static to the kinetic limit")
        .Default("none");
    s.Quantity("stribeck_speed", &FrictionEntry::stribeck_speed, "1", "[m/s, rad/s]")
        .NonNegative()
        .Default("0");
    s.Quantity("counterpart_speed", &FrictionEntry::counterpart_speed, "1",
               "of a belt or disc that it rubs against [m/s, rad/s]")
        .Default("0");
    return s;
  }();
  return schema;
}

template <class T>
void AddPlace(io::Schema<T>& s) {
  s.Text(
       "joint", [](T & t) -> auto& { return t.place.joint; }, "acts on this joint's coordinate")
      .Optional();
  s.Integer(
       "coordinate", [](T & t) -> auto& { return t.place.coordinate; },
       "of a joint with several, from 0")
      .Default("0");
  s.Text(
       "a", [](T & t) -> auto& { return t.place.a; }, "first body, when it acts between two")
      .Optional();
  s.Point(
       "a_at", [](T & t) -> auto& { return t.place.a_at; }, "m", "point in a")
      .Default("[0, 0, 0]");
  s.Point(
       "a_turned", [](T & t) -> auto& { return t.place.a_turned; }, "rad",
       "rotation vector of the frame in a")
      .Default("[0, 0, 0]");
  s.Text(
       "b", [](T & t) -> auto& { return t.place.b; }, "second body")
      .Optional();
  s.Point(
       "b_at", [](T & t) -> auto& { return t.place.b_at; }, "m", "point in b")
      .Default("[0, 0, 0]");
  s.Point(
       "b_turned", [](T & t) -> auto& { return t.place.b_turned; }, "rad",
       "rotation vector of the frame in b")
      .Default("[0, 0, 0]");
  s.Choice(
       "between", [](T & t) -> auto& { return t.place.between; },
       {{"points", Between::kPoints, "along the line between the points"},
        {"axis", Between::kAxis, "about a's z axis"}},
       "where it acts between two bodies")
      .Default("points");
  s.Check([](const T& t, io::Check& check) {
    const bool pair = t.place.a && t.place.b;
    if (t.place.joint.has_value() == (t.place.a || t.place.b) || (!t.place.joint && !pair)) {
      check.Fail(t.place.joint ? "joint" : "a",
                 t.place.joint ? "a joint and bodies" : "neither a joint nor two bodies",
                 "either joint, or a and b");
    }
  });
}

const io::Schema<Spring>& SpringSchema() {
  static const io::Schema<Spring> schema = [] {
    io::Schema<Spring> s(
        "spring", "Spring and damper; SI: N/m and N s/m, about an axis N m/rad and N m s/rad.");
    AddPlace(s);
    s.Quantity("stiffness", &Spring::stiffness, "1", "[N/m, N m/rad]").NonNegative().Default("0");
    s.Quantity("damping", &Spring::damping, "1", "[N s/m, N m s/rad]").NonNegative().Default("0");
    s.Quantity("free", &Spring::free, "1",
               "length or angle without force; absent: that of the start, 0 for angles [m, rad]")
        .Optional();
    s.Quantity("preload", &Spring::preload, "1", "pulls [N, N m]").Default("0");
    s.Curve("stiffness_curve", &Spring::stiffness_curve, {"deflection", "1"}, {"force", "1"},
            "instead of stiffness")
        .Increasing()
        .Optional();
    s.Curve("damping_curve", &Spring::damping_curve, {"rate", "1"}, {"force", "1"},
            "instead of damping")
        .Increasing()
        .Optional();
    return s;
  }();
  return schema;
}

const io::Schema<Stop>& StopSchema() {
  static const io::Schema<Stop> schema = [] {
    io::Schema<Stop> s(
        "stop", "One-sided stop: stiffness × penetration^exponent, with damping that never pulls.");
    AddPlace(s);
    s.Boolean("upper", &Stop::upper, "acts above the limit, else below").Default("true");
    s.Quantity("limit", &Stop::limit, "1", "length or angle at contact [m, rad]");
    s.Quantity("stiffness", &Stop::stiffness, "1", "[N/m^exponent]").Positive();
    s.Quantity("exponent", &Stop::exponent, "1", "at least 1").Min(1).Max(10).Default("1");
    s.Quantity("damping", &Stop::damping, "1", "[N s/m, N m s/rad]").NonNegative().Default("0");
    s.Quantity("depth", &Stop::depth, "1", "penetration at which damping is in full [m, rad]")
        .Positive()
        .Default("1e-3");
    return s;
  }();
  return schema;
}

const io::Schema<Bushing>& BushingSchema() {
  static const io::Schema<Bushing> schema = [] {
    io::Schema<Bushing> s("bushing", "Six-axis bushing between two frames, in the axes of a's.");
    s.Text("a", &Bushing::a, "first body");
    s.Point("a_at", &Bushing::a_at, "m", "point in a").Default("[0, 0, 0]");
    s.Point("a_turned", &Bushing::a_turned, "rad", "rotation vector of the frame in a")
        .Default("[0, 0, 0]");
    s.Text("b", &Bushing::b, "second body");
    s.Point("b_at", &Bushing::b_at, "m", "point in b").Default("[0, 0, 0]");
    s.Point("b_turned", &Bushing::b_turned, "rad", "rotation vector of the frame in b")
        .Default("[0, 0, 0]");
    s.Point("stiffness", &Bushing::stiffness, "N/m", "along x, y, z").Default("[0, 0, 0]");
    s.Point("turning_stiffness", &Bushing::turning_stiffness, "N m/rad", "about x, y, z")
        .Default("[0, 0, 0]");
    s.Point("damping", &Bushing::damping, "N s/m", "along x, y, z").Default("[0, 0, 0]");
    s.Point("turning_damping", &Bushing::turning_damping, "N m s/rad", "about x, y, z")
        .Default("[0, 0, 0]");
    return s;
  }();
  return schema;
}

const io::Schema<Force>& ForceSchema() {
  static const io::Schema<Force> schema = [] {
    io::Schema<Force> s("force", "A force and a torque on a body.");
    s.Text("body", &Force::body, "on which it acts");
    s.Point("at", &Force::at, "m", "point in the body").Default("[0, 0, 0]");
    s.Point("force", &Force::force, "N", "force").Default("[0, 0, 0]");
    s.Point("torque", &Force::torque, "N m", "torque").Default("[0, 0, 0]");
    s.Boolean("follows_body", &Force::follows_body, "in the body's axes, else in the world's")
        .Default("false");
    s.Curve("history", &Force::history, {"time", "s"}, {"scale", "1"},
            "factor over time, linear between the points")
        .Increasing()
        .Optional();
    return s;
  }();
  return schema;
}

const io::Schema<Motor>& MotorSchema() {
  static const io::Schema<Motor> schema = [] {
    io::Schema<Motor> s(
        "motor", "Drives a coordinate: force + proportional (target - x) - derivative ẋ; SI.");
    AddPlace(s);
    s.Quantity("force", &Motor::force, "1", "constant part [N, N m]").Default("0");
    s.Quantity("target", &Motor::target, "1", "[m, rad]").Default("0");
    s.Quantity("proportional", &Motor::proportional, "1", "[N/m, N m/rad]")
        .NonNegative()
        .Default("0");
    s.Quantity("derivative", &Motor::derivative, "1", "[N s/m, N m s/rad]")
        .NonNegative()
        .Default("0");
    s.Quantity("limit", &Motor::limit, "1", "largest force [N, N m]").Positive().Optional();
    return s;
  }();
  return schema;
}

const io::Schema<Simulation>& SimulationSchema() {
  static const io::Schema<Simulation> schema = [] {
    using solve::Method;
    io::Schema<Simulation> s("simulation", "How the mechanism is simulated.");
    s.Choice("method", &Simulation::method,
             {{"rosenbrock", Method::kRosenbrock, "fixed step, linearly implicit, order 3"},
              {"rk4", Method::kRungeKutta4, "fixed step, explicit, order 4"},
              {"explicit8", Method::kExplicit8, "adaptive, explicit, order 8 (ARKODE)"},
              {"bdf", Method::kBdf, "adaptive, implicit (CVODE)"}},
             "integrator")
        .Default("rosenbrock");
    s.Quantity("step", &Simulation::step, "s", "of fixed-step methods")
        .Positive()
        .Default("0.5 ms");
    s.Quantity("duration", &Simulation::duration, "s", "simulated time").Positive().Default("1 s");
    s.Quantity("sample_interval", &Simulation::sample_interval, "s", "between rows of signals.csv")
        .Positive()
        .Default("1 ms");
    s.Quantity("relative_tolerance", &Simulation::relative_tolerance, "1", "of adaptive methods")
        .Positive()
        .Default("1e-9");
    s.Quantity("absolute_tolerance", &Simulation::absolute_tolerance, "1", "of adaptive methods")
        .Positive()
        .Default("1e-11");
    s.Quantity("constraint_tolerance", &Simulation::constraint_tolerance, "1",
               "constraints are met to this [m, rad]")
        .Positive()
        .Default("1e-10");
    s.Boolean("start_at_rest", &Simulation::start_at_rest, "find the equilibrium first")
        .Default("false");
    return s;
  }();
  return schema;
}

const io::Schema<File>& FileSchema() {
  static const io::Schema<File> schema = [] {
    io::Schema<File> s(
        "mechanism",
        "A mechanism: bodies on a tree of joints, closures, forces; and its simulation.");
    s.Text("name", &File::name, "title").Default("mechanism");
    s.Point("gravity", &File::gravity, "m/s^2", "gravity").Default("[0, 0, -9.80665]");
    s.Map("bodies", &File::bodies, BodySchema(), "rigid bodies");
    s.Map("joints", &File::joints, JointSchema(), "joints of the tree");
    s.Map("closures", &File::closures, ClosureSchema(), "closed loops").Optional();
    s.Map("couplings", &File::couplings, CouplingSchema(), "between coordinates").Optional();
    s.Map("motions", &File::motions, MotionSchema(), "prescribed motions").Optional();
    s.Map("frictions", &File::frictions, FrictionSchema(), "dry friction").Optional();
    s.Map("springs", &File::springs, SpringSchema(), "springs and dampers").Optional();
    s.Map("stops", &File::stops, StopSchema(), "bump and rebound stops").Optional();
    s.Map("bushings", &File::bushings, BushingSchema(), "bushings").Optional();
    s.Map("forces", &File::forces, ForceSchema(), "forces on bodies").Optional();
    s.Map("motors", &File::motors, MotorSchema(), "motors").Optional();
    s.Section("simulation", &File::simulation, SimulationSchema(), "how it is simulated")
        .Optional();
    return s;
  }();
  return schema;
}

Transform<double> MakePose(const Point& at, const Point& turned) {
  return {math::MakeRotation(math::MakeQuaternion(MakeVector(turned))), MakeVector(at)};
}

// Places of the entries in the file, from the record of what was read.
class Places {
 public:
  Places(const io::InputRecord& record, std::string file)
      : record_(record), file_(std::move(file)) {}
  Source Find(const std::string& path) const {
    for (const io::ValueRecord& value : record_.values) {
      if (value.origin.kind == io::ValueOrigin::Kind::kFile && value.path.starts_with(path + '.')) {
        return {value.origin.file, value.origin.line};
      }
    }
    return {file_, 0};
  }

 private:
  const io::InputRecord& record_;
  std::string file_;
};

PlaceDescription MakePlace(const Place& place) {
  if (place.joint) return OnCoordinate{*place.joint, place.coordinate};
  const FrameDescription a{*place.a, MakePose(place.a_at, place.a_turned)};
  const FrameDescription b{*place.b, MakePose(place.b_at, place.b_turned)};
  if (place.between == Between::kAxis) return AboutAxis{a, b};
  return BetweenPoints{a, b};
}

LawDescription MakeLaw(double coefficient, const std::optional<io::CurveTable>& curve) {
  LawDescription law;
  law.coefficient = curve ? 0 : coefficient;
  if (curve) {
    for (size_t i = 0; i < curve->x.size(); ++i) law.points.push_back({curve->x[i], curve->y[i]});
  }
  return law;
}

using MotionSpline = math::CubicSpline<double, kMotionNodes>;

mechanism::Drive MakeDrive(const Motion& motion) {
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

void AddJoint(const std::string& name, const Joint& j, const Source& source,
              MechanismDescription& d) {
  JointDescription joint;
  joint.name = name;
  joint.type = j.type;
  joint.parent = {j.parent, MakePose(j.at, j.turned)};
  joint.child = {j.child, MakePose(j.child_at, j.child_turned)};
  joint.axis = MakeVector(j.axis);
  joint.second_axis = MakeVector(j.second_axis);
  joint.pitch = j.pitch;
  joint.source = source;
  const bool turns = j.type == JointType::kRevolute || j.type == JointType::kScrew;
  const bool slides = j.type == JointType::kPrismatic;
  const auto choose = [&](const std::optional<double>& one, const char* key, bool fits,
                          std::vector<double>& values) {
    if (!one) return;
    if (!fits || !values.empty()) {
      throw io::InputError(
          {.file = source.file,
           .line = source.line,
           .key = fmt::format("joints.{}.{}", name, key),
           .found = "a start value that this joint does not have, or has already",
           .expected =
               "angle for turning, displacement for sliding joints, position for the others"});
    }
    values = {*one};
  };
  joint.position = j.position;
  joint.velocity = j.velocity;
  choose(j.angle, "angle", turns, joint.position);
  choose(j.displacement, "displacement", slides, joint.position);
  choose(j.angle_rate, "angle_rate", turns, joint.velocity);
  choose(j.displacement_rate, "displacement_rate", slides, joint.velocity);
  d.joints.push_back(std::move(joint));
}

MechanismFile Translate(const File& file, const Places& places) {
  MechanismFile result;
  MechanismDescription& d = result.description;
  d.name = file.name;
  d.gravity = MakeVector(file.gravity);
  for (const auto& [name, b] : file.bodies) {
    d.bodies.push_back(
        {name,
         b.mass,
         MakeVector(b.centre),
         {b.inertia[0], b.inertia[1], b.inertia[2], b.products[0], b.products[1], b.products[2]},
         places.Find("bodies." + name)});
  }
  for (const auto& [name, j] : file.joints) AddJoint(name, j, places.Find("joints." + name), d);
  for (const auto& [name, c] : file.closures) {
    d.closures.push_back({name,
                          c.type,
                          {c.a, MakePose(c.a_at, c.a_turned)},
                          {c.b, MakePose(c.b_at, c.b_turned)},
                          c.length,
                          c.radius,
                          places.Find("closures." + name)});
  }
  for (const auto& [name, c] : file.couplings) {
    CouplingDescription coupling{name, {}, c.offset, c.rate_only, places.Find("couplings." + name)};
    for (const Term& term : c.terms)
      coupling.terms.push_back({term.joint, term.coordinate, term.factor});
    d.couplings.push_back(std::move(coupling));
  }
  for (const auto& [name, m] : file.motions) {
    d.motions.push_back(
        {name, m.joint, m.coordinate, MakeDrive(m), places.Find("motions." + name)});
    if (m.table)
      result.simulation.kinks.insert(result.simulation.kinks.end(), m.table->x.begin(),
                                     m.table->x.end());
  }
  for (const auto& [name, f] : file.frictions) {
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
    friction.source = places.Find("frictions." + name);
    d.frictions.push_back(std::move(friction));
  }
  for (const auto& [name, s] : file.springs) {
    SpringDescription spring;
    spring.name = name;
    spring.place = MakePlace(s.place);
    spring.stiffness = MakeLaw(s.stiffness, s.stiffness_curve);
    spring.damping = MakeLaw(s.damping, s.damping_curve);
    spring.free = s.free;
    spring.preload = s.preload;
    spring.source = places.Find("springs." + name);
    result.forces.emplace_back(std::move(spring));
  }
  for (const auto& [name, s] : file.stops) {
    StopDescription stop;
    stop.name = name;
    stop.place = MakePlace(s.place);
    stop.upper = s.upper;
    stop.limit = s.limit;
    stop.stiffness.coefficient = s.stiffness;
    stop.exponent = s.exponent;
    stop.damping = s.damping;
    stop.depth = s.depth;
    stop.source = places.Find("stops." + name);
    result.forces.emplace_back(std::move(stop));
  }
  for (const auto& [name, b] : file.bushings) {
    BushingDescription bushing;
    bushing.name = name;
    bushing.a = {b.a, MakePose(b.a_at, b.a_turned)};
    bushing.b = {b.b, MakePose(b.b_at, b.b_turned)};
    for (int i = 0; i < 3; ++i) {
      bushing.stiffness[i].coefficient = b.stiffness[i];
      bushing.stiffness[3 + i].coefficient = b.turning_stiffness[i];
      bushing.damping[i].coefficient = b.damping[i];
      bushing.damping[3 + i].coefficient = b.turning_damping[i];
    }
    bushing.source = places.Find("bushings." + name);
    result.forces.emplace_back(std::move(bushing));
  }
  for (const auto& [name, f] : file.forces) {
    BodyForceDescription force;
    force.name = name;
    force.at = {f.body, MakePose(f.at, {})};
    force.force = MakeVector(f.force);
    force.torque = MakeVector(f.torque);
    force.axes =
        f.follows_body ? BodyForceDescription::Axes::kFrame : BodyForceDescription::Axes::kWorld;
    if (f.history) {
      force.scale = [table = *f.history](double t) { return InterpolateLinearly(table, t); };
      result.simulation.kinks.insert(result.simulation.kinks.end(), f.history->x.begin(),
                                     f.history->x.end());
    }
    force.source = places.Find("forces." + name);
    result.forces.emplace_back(std::move(force));
  }
  for (const auto& [name, m] : file.motors) {
    MotorDescription motor;
    motor.name = name;
    motor.place = MakePlace(m.place);
    if (const double constant = m.force; constant != 0)
      motor.force = [constant](double) { return constant; };
    if (const double target = m.target; target != 0) {
      motor.target = [target](double) { return std::array<double, 3>{target, 0, 0}; };
    }
    motor.proportional = m.proportional;
    motor.derivative = m.derivative;
    motor.limit = m.limit;
    motor.source = places.Find("motors." + name);
    result.forces.emplace_back(std::move(motor));
  }
  result.start_at_rest = file.simulation.start_at_rest;
  result.simulation.duration = file.simulation.duration;
  result.simulation.sample_interval = file.simulation.sample_interval;
  result.simulation.stepper.method = file.simulation.method;
  result.simulation.stepper.step = file.simulation.step;
  result.simulation.stepper.relative_tolerance = file.simulation.relative_tolerance;
  result.simulation.stepper.absolute_tolerance = file.simulation.absolute_tolerance;
  result.simulation.stepper.projection_tolerance = file.simulation.constraint_tolerance;
  return result;
}

}  // namespace

MechanismFile ReadMechanismFile(const std::filesystem::path& path, const io::ReadOptions& options,
                                io::InputRecord* record) {
  io::InputRecord own;
  io::InputRecord& read = record != nullptr ? *record : own;
  const File file = io::ReadFile(FileSchema(), path, options, &read);
  return Translate(file, Places(read, path.string()));
}

MechanismFile ReadMechanismText(std::string_view text, const std::string& name,
                                const io::ReadOptions& options, io::InputRecord* record) {
  io::InputRecord own;
  io::InputRecord& read = record != nullptr ? *record : own;
  const File file = io::ReadText(FileSchema(), text, name, options, &read);
  return Translate(file, Places(read, name));
}

void AddInputKinds(io::InputKinds* kinds) {
  kinds->Add({FileSchema().name(), FileSchema().core(),
              [](const std::filesystem::path& path, const io::ReadOptions& options) {
                io::InputRecord record;
                MakeMechanism(ReadMechanismFile(path, options, &record));
                return record;
              }});
}

Mechanism MakeMechanism(const MechanismFile& file) {
  Mechanism mechanism = MakeMechanism(file.description);
  AddForces(file.forces, mechanism);
  if (file.start_at_rest) solve::FindEquilibrium(mechanism.system, {}, mechanism.start);
  return mechanism;
}

}  // namespace kingpin::joints
