#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/schema.h"
#include "core/solve/simulate.h"
#include "joints/beam_file.h"
#include "joints/file_frame.h"
#include "joints/mechanism_description.h"
#include "joints/mechanism_file.h"
#include "joints/urdf.h"

/// What a mechanism file says, in its own terms; mechanism_file.cpp makes a mechanism of it.
namespace kingpin::joints::file {

using Point = FilePoint;

/// Most points of a motion's table.
inline constexpr int kMotionNodes = 512;

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

// Start values of a joint that is not described here: of a URDF file or of a beam.
struct Start {
  std::optional<double> angle, displacement, angle_rate, displacement_rate;
  std::vector<double> position, velocity;
};

struct Report {
  std::vector<std::string> coordinates, reactions;
};

struct Response {
  std::string from, to;
  std::array<double, 2> band{0.1, 100};
  int points = 200;
};

struct Vary {
  std::string of;
  MechanismFile::Trim::Quantity quantity = MechanismFile::Trim::Quantity::kPreload;
};

struct Target {
  std::string of;
  double value = 0;
};

struct Equilibrium {
  std::vector<Vary> vary;
  std::vector<Target> targets;
};

struct File {
  std::string name;
  Point gravity{0, 0, -9.80665};
  std::optional<std::filesystem::path> urdf;
  UrdfBase root = UrdfBase::kFixed;
  bool urdf_dynamics = true;
  io::NamedList<Body> bodies;
  io::NamedList<Joint> joints;
  io::NamedList<FileBeam> beams;
  io::NamedList<Start> start;
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
  Report report;
  std::optional<Equilibrium> equilibrium;
  io::NamedList<Response> responses;
};

const io::Schema<File>& FileSchema();

}  // namespace kingpin::joints::file
