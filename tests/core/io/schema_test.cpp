#include "core/io/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kingpin::io {
namespace {

enum class Assistance { kNone, kHydraulic, kElectric };

struct Rack {
  double mass = 0.0;
  double travel = 0.0;
  std::optional<double> preload;
};

struct LoadCase {
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
  int teeth = 0;
  bool locked = false;
  std::vector<LoadCase> load_cases;
  NamedList<LoadCase> named;
};

Schema<Rack> MakeRackSchema() {
  Schema<Rack> s("rack", "the rack");
  s.Quantity("mass", &Rack::mass, "kg", "mass of the rack").Positive();
  s.Quantity("travel", &Rack::travel, "m", "from stop to stop").Positive().Default("150 mm");
  s.Quantity("preload", &Rack::preload, "N", "yoke force").NonNegative().Optional();
  return s;
}

Schema<Steering> MakeSchema() {
  Schema<LoadCase> load_case("load_case", "one excitation");
  load_case.Quantity("speed", &LoadCase::speed, "m/s", "of the car").Positive();
  load_case.Quantity("weight", &LoadCase::weight, "1", "in the sum").Default(1.0);
  Schema<Steering> s("steering", "the steering of one car");
  s.Include("rack", &Steering::rack, MakeRackSchema(), "the rack");
  s.Section("second_rack", &Steering::second_rack, MakeRackSchema(), "another one").Optional();
  s.Choice("assistance", &Steering::assistance,
           {{"none", Assistance::kNone, "no power assistance"},
            {"hydraulic", Assistance::kHydraulic, "boost valve"},
            {"electric", Assistance::kElectric, "motor on the rack"}},
           "power assistance");
  s.Point("outer_joint", &Steering::outer_joint, "m", "tie rod's outer ball joint");
  s.Curve("boost", &Steering::boost, {"torque", "N m"}, {"force", "N"}, "boost curve")
      .Increasing()
      .Monotone()
      .OnlyIf("assistance", {"hydraulic"});
  s.Quantity("motor_inertia", &Steering::motor_inertia, "kg m^2", "rotor")
      .Positive()
      .OnlyIf("assistance", {"electric"});
  s.Integer("teeth", &Steering::teeth, "of the pinion").Min(3).Default(8);
  s.Boolean("locked", &Steering::locked, "whether it is locked").Default(false);
  s.List("load_cases", &Steering::load_cases, load_case, "excitations").Optional();
  s.Map("named", &Steering::named, load_case, "excitations by name").Optional();
  s.Check([](const Steering& steering, Check& check) {
    if (steering.rack.travel > 0.3) {
      check.Fail("rack.travel", "a long rack", "at most 0.3 m");
    }
  });
  return s;
}

constexpr const char* kGood = R"(kind: steering
source: a workshop manual
rack:
  mass: {value: 2.1 kg, source: weighed, certainty: D}
assistance: hydraulic
outer_joint: {value: [-132.5, -25, 0], unit: mm}
boost: [[0, 0], [2 N m, 1.5 kN], [4, 2000]]
load_cases:
  - speed: 35 km/h
  - {speed: 10, weight: 50 %}
named:
  slow: {speed: 18 km/h}
)";

TEST(Schema, ValuesReachTheStructInSi) {
  InputRecord record;
  const Steering steering = ReadText(MakeSchema(), kGood, "a.yaml", {}, &record);
  EXPECT_EQ(steering.rack.mass, 2.1);
  EXPECT_EQ(steering.rack.travel, 0.15);
  EXPECT_FALSE(steering.rack.preload.has_value());
  EXPECT_FALSE(steering.second_rack.has_value());
  EXPECT_EQ(steering.assistance, Assistance::kHydraulic);
  EXPECT_EQ(steering.outer_joint, (std::array<double, 3>{-0.1325, -0.025, 0.0}));
  EXPECT_EQ(steering.boost.x, (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(steering.boost.y, (std::vector<double>{0, 1500, 2000}));
  EXPECT_EQ(steering.teeth, 8);
  ASSERT_EQ(steering.load_cases.size(), 2u);
  EXPECT_EQ(steering.load_cases[0].speed, 35.0 / 3.6);
  EXPECT_EQ(steering.load_cases[1].weight, 0.5);
  ASSERT_EQ(steering.named.size(), 1u);
  EXPECT_EQ(steering.named[0].first, "slow");
  EXPECT_EQ(steering.named[0].second.speed, 5.0);
}

TEST(Schema, OriginTravelsWithEachValue) {
  InputRecord record;
  ReadOptions options;
  options.overrides.push_back(ParseOverride("load_cases[1].speed=72 km/h"));
  const Steering steering = ReadText(MakeSchema(), kGood, "a.yaml", options, &record);
  EXPECT_EQ(steering.load_cases[1].speed, 20.0);
  const ValueRecord* mass = record.Find("rack.mass");
  ASSERT_NE(mass, nullptr);
  EXPECT_EQ(mass->origin.line, 4);
  EXPECT_EQ(mass->origin.source, "weighed");
  EXPECT_EQ(mass->origin.certainty, "D");
  EXPECT_EQ(mass->text, "2.1 kg");
  EXPECT_EQ(record.Find("rack.travel")->origin.kind, ValueOrigin::Kind::kDefault);
  EXPECT_EQ(record.Find("outer_joint")->origin.source, "a workshop manual");
  EXPECT_EQ(record.Find("load_cases[1].speed")->origin.kind, ValueOrigin::Kind::kCommandLine);
  EXPECT_EQ(record.Find("load_cases[1].speed")->origin.source, "");
}

}  // namespace
}  // namespace kingpin::io
