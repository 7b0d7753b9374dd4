#include <fmt/format.h>

#include "joints/mechanism_file_entries.h"

namespace kingpin::joints::file {

namespace {

// Rows of signals.csv that a machine can be asked to hold.
constexpr double kMostSamples = 1e7;

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

template <class T>
void AddStart(io::Schema<T>& s) {
  s.Quantity("angle", &T::angle, "rad", "start value of a joint with one angle").Optional();
  s.Quantity("displacement", &T::displacement, "m", "start value of a joint with one displacement")
      .Optional();
  s.Quantity("angle_rate", &T::angle_rate, "rad/s", "start value").Optional();
  s.Quantity("displacement_rate", &T::displacement_rate, "m/s", "start value").Optional();
  s.Quantities("position", &T::position, "1",
               "start values of all coordinates, SI; quaternions are w, x, y, z")
      .Optional();
  s.Quantities("velocity", &T::velocity, "1", "start values of all velocity coordinates, SI")
      .Optional();
}

const io::Schema<Start>& StartSchema() {
  static const io::Schema<Start> schema = [] {
    io::Schema<Start> s("start", "Where a joint starts.");
    AddStart(s);
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
          "two displacements across the axis (x and y if it is z), then angle about it"},
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
    AddStart(s);
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
    term.Quantity("factor", &Term::factor, "1", "in SI: 1, 1/m or m; not 0").Default("1");
    term.Check([](const Term& t, io::Check& check) {
      if (t.factor == 0) check.Fail("factor", "0", "a factor that couples the coordinate");
    });
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
    s.Check([](const FrictionEntry& f, io::Check& check) {
      const bool loaded = f.preload > 0 || f.from_joint || !f.from_closures.empty();
      const bool force = f.static_force > 0 || f.kinetic_force > 0;
      const bool coefficient = f.static_coefficient > 0 || f.kinetic_coefficient > 0;
      if (force || (coefficient && loaded)) return;
      if (coefficient) {
        check.Fail("", "coefficients without a normal force",
                   "preload, from_joint or from_closures beside them");
      } else {
        check.Fail("", "dry friction whose limits are all 0",
                   "static_force and kinetic_force, or static_coefficient and "
                   "kinetic_coefficient");
      }
    });
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
    s.Check([](const Simulation& simulation, io::Check& check) {
      if (simulation.duration / simulation.sample_interval <= kMostSamples) return;
      check.Fail(
          "sample_interval", fmt::format("{:g} s", simulation.sample_interval),
          fmt::format("at least {:g} s: no more than {:g} samples of a run of {:g} s",
                      simulation.duration / kMostSamples, kMostSamples, simulation.duration));
    });
    return s;
  }();
  return schema;
}

const io::Schema<Report>& ReportSchema() {
  static const io::Schema<Report> schema = [] {
    io::Schema<Report> s("report", "What report.html shows; absent: what is not inside a beam.");
    s.Texts("coordinates", &Report::coordinates, "joints, or coordinates as signals.csv has them")
        .Optional();
    s.Texts("reactions", &Report::reactions, "closures, couplings, motions, frictions, or rows")
        .Optional();
    return s;
  }();
  return schema;
}

const io::Schema<Response>& ResponseSchema() {
  static const io::Schema<Response> schema = [] {
    io::Schema<Response> s("response", "A frequency response about the start, for kingpin modes.");
    s.Text("from", &Response::from, "a motor, or a force on a body");
    s.Text("to", &Response::to,
           "a channel of signals.csv: COORDINATE, COORDINATE.rate, COORDINATE.acceleration, "
           "ROW.reaction");
    s.Point("band", &Response::band, "Hz", "lowest and highest frequency").Default("[0.1, 100]");
    s.Integer("points", &Response::points, "evenly spaced in the logarithm")
        .Min(2)
        .Max(10000)
        .Default("200");
    s.Check([](const Response& response, io::Check& check) {
      if (response.band[0] > 0 && response.band[1] > response.band[0]) return;
      check.Fail("band", fmt::format("{:g} to {:g} Hz", response.band[0], response.band[1]),
                 "two rising frequencies above zero");
    });
    return s;
  }();
  return schema;
}

const io::Schema<Equilibrium>& EquilibriumSchema() {
  static const io::Schema<Equilibrium> schema = [] {
    using Quantity = MechanismFile::Trim::Quantity;
    io::Schema<Vary> vary("vary", "A quantity that is varied.");
    vary.Text("of", &Vary::of, "a spring or a motor");
    vary.Choice("quantity", &Vary::quantity,
                {{"free", Quantity::kFree, "of a spring"},
                 {"preload", Quantity::kPreload, "of a spring"},
                 {"force", Quantity::kForce, "of a motor"},
                 {"target", Quantity::kTarget, "of a motor"}},
                "what is varied, from its value here");
    io::Schema<Target> target("target", "What the equilibrium shall have.");
    target.Text("of", &Target::of, "a coordinate, or ROW.reaction");
    target.Quantity("value", &Target::value, "1", "SI");
    io::Schema<Equilibrium> s("equilibrium",
                              "Starts at rest, with quantities varied until targets are met.");
    s.List("vary", &Equilibrium::vary, vary, "as many as targets");
    s.List("targets", &Equilibrium::targets, target, "what to meet");
    return s;
  }();
  return schema;
}

}  // namespace

const io::Schema<File>& FileSchema() {
  static const io::Schema<File> schema = [] {
    io::Schema<File> s(
        "mechanism",
        "A mechanism: bodies on a tree of joints, closures, forces; and its simulation.");
    s.Text("name", &File::name, "title").Default("mechanism");
    s.Point("gravity", &File::gravity, "m/s^2", "gravity").Default("[0, 0, -9.80665]");
    s.FilePath("urdf", &File::urdf,
               "URDF file whose links and joints are bodies and joints here, by their names")
        .Optional();
    s.Choice("root", &File::root,
             {{"fixed", UrdfBase::kFixed, "welded to the world"},
              {"free", UrdfBase::kFloating, "moves on the free joint floating_base"}},
             "how the root link of the URDF file stands in the world")
        .Default("fixed");
    s.Boolean("urdf_dynamics", &File::urdf_dynamics,
              "damping and friction of its joints act: springs NAME.damping, frictions "
              "NAME.friction")
        .Default("true");
    s.Map("bodies", &File::bodies, BodySchema(), "rigid bodies").Optional();
    s.Map("joints", &File::joints, JointSchema(), "joints of the tree").Optional();
    s.Map("beams", &File::beams, FileBeamSchema(), "flexible beams and shafts").Optional();
    s.Map("start", &File::start, StartSchema(),
          "start values of joints that a URDF file or a beam brings")
        .Optional();
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
    s.Section("equilibrium", &File::equilibrium, EquilibriumSchema(),
              "quantities to be varied until the equilibrium meets targets")
        .Optional();
    s.Map("responses", &File::responses, ResponseSchema(), "frequency responses").Optional();
    s.Section("report", &File::report, ReportSchema(), "what report.html shows").Optional();
    s.Check([](const File& file, io::Check& check) {
      if (!file.urdf && file.bodies.empty() && file.beams.empty()) {
        check.Fail("", "a mechanism without bodies", "bodies, beams or urdf");
      }
    });
    return s;
  }();
  return schema;
}

}  // namespace kingpin::joints::file
