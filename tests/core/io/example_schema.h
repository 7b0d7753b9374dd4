#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/schema.h"

/// A schema with a field of every kind, for tests and for fuzzing.
namespace kingpin::io::example {

enum class Assistance { kNone, kHydraulic, kElectric };

struct Rack {
  double mass = 0.0;
  double travel = 0.0;
  std::optional<double> preload;
};

struct LoadCase {
  std::string name;
  double speed = 0.0;
  double weight = 0.0;
};

struct Steering {
  Rack rack;
  std::optional<Rack> second_rack;
  Assistance assistance = Assistance::kNone;
  std::array<double, 3> outer_joint{};
  CurveTable boost;
  double motor_inertia = 0.0;
  double column_stiffness = 0.0;
  double natural_frequency = 0.0;
  double wheel_speed = 0.0;
  double share = 0.0;
  int teeth = 0;
  bool locked = false;
  std::vector<double> nodes;
  std::vector<std::string> free_variables;
  std::optional<std::filesystem::path> road;
  std::vector<LoadCase> load_cases;
  NamedList<LoadCase> named;
  std::vector<std::vector<double>> points;
};

inline Schema<Steering> MakeSchema() {
  Schema<Rack> rack("rack", "the rack with what is rigidly fixed to it");
  rack.Quantity("mass", &Rack::mass, "kg", "mass of the rack").Positive();
  rack.Quantity("travel", &Rack::travel, "m", "from stop to stop").Positive().Default("150 mm");
  rack.Quantity("preload", &Rack::preload, "N", "yoke force").NonNegative().Optional();

  Schema<LoadCase> load_case("load_case", "one excitation");
  load_case.Text("name", &LoadCase::name, "shown in the report").Default("unnamed");
  load_case.Quantity("speed", &LoadCase::speed, "m/s", "of the car").Positive();
  load_case.Quantity("weight", &LoadCase::weight, "1", "in the sum").Default(1.0);

  Schema<Steering> s("steering", "the steering of one car");
  s.Include("rack", &Steering::rack, rack, "the rack");
  s.Section("second_rack", &Steering::second_rack, rack, "another one").Optional();
  s.Choice("assistance", &Steering::assistance,
           {{"none", Assistance::kNone, "no power assistance"},
            {"hydraulic", Assistance::kHydraulic, "boost valve"},
            {"electric", Assistance::kElectric, "motor on the rack"}},
           "power assistance")
      .Default("none");
  s.Point("outer_joint", &Steering::outer_joint, "m", "tie rod's outer ball joint")
      .Default("[0, 0, 0]");
  s.Curve("boost", &Steering::boost, {"torque", "N m"}, {"force", "N"}, "boost curve")
      .Increasing()
      .Monotone()
      .OnlyIf("assistance", {"hydraulic"});
  s.Quantity("motor_inertia", &Steering::motor_inertia, "kg m^2", "of the motor's rotor")
      .Positive()
      .OnlyIf("assistance", {"electric"});
  s.Quantity("column_stiffness", &Steering::column_stiffness, "N m/rad", "torsion bar")
      .Default("60 N m/rad");
  s.Quantity("natural_frequency", &Steering::natural_frequency, "Hz", "first mode")
      .Default("45 Hz");
  s.Quantity("wheel_speed", &Steering::wheel_speed, "rad/s", "of the road wheel").Default(0.0);
  s.Quantity("share", &Steering::share, "1", "of the force").Min(0.0).Max(1.0).Default("50 %");
  s.Integer("teeth", &Steering::teeth, "of the pinion").Min(3).Max(40).Default(8);
  s.Boolean("locked", &Steering::locked, "whether it is locked").Default(false);
  s.Quantities("nodes", &Steering::nodes, "m", "of the spline")
      .Count(2, 16)
      .Increasing()
      .Default("[-10 mm, 0, 10 mm]");
  s.Texts("free_variables", &Steering::free_variables, "what may change")
      .OneOf({"r_L", "r_X", "x_tr", "y_tr"})
      .Default("[r_L]");
  s.FilePath("road", &Steering::road, "road profile").Optional();
  s.List("load_cases", &Steering::load_cases, load_case, "excitations").Optional();
  s.Map("named", &Steering::named, load_case, "excitations by name").Optional();
  s.Table("points", &Steering::points, {{"x", "m"}, {"y", "m"}, {"angle", "rad"}}, "a path")
      .Optional();
  s.Check([](const Steering& steering, io::Check& check) {
    if (steering.rack.travel > 0.5) {
      check.Fail("rack.travel", FormatQuantity(steering.rack.travel, "m"), "at most 0.5 m");
    }
    if (steering.load_cases.size() == 1 && steering.load_cases[0].weight == 0.0) {
      check.Fail("load_cases[0].weight", "0 for the only load case", "more than 0");
    }
  });
  return s;
}

}  // namespace kingpin::io::example
