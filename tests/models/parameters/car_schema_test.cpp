#include "models/parameters/car_schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/input_record.h"
#include "models/parameters/input_kinds.h"
#include "tests/models/parameters/c_segment.h"

namespace kingpin::parameters {
namespace {

using testing::HasSubstr;

const std::string& CarFile() {
  static const std::string file =
      std::string(KINGPIN_SOURCE_DIR) + "/models/data/cars/c_segment/car.yaml";
  return file;
}

std::string ReadWith(std::initializer_list<std::string> changes) {
  io::ReadOptions options;
  for (const std::string& change : changes) {
    options.overrides.push_back(io::ParseOverride(change));
  }
  try {
    io::ReadFile(CarSchema(), CarFile(), options);
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CarSchema, EveryValueOfTheShippedCarSaysWhereItIsFrom) {
  io::InputRecord record;
  io::ReadFile(CarSchema(), CarFile(), {}, &record);
  EXPECT_EQ(record.files.size(), 7U);
  EXPECT_GT(record.values.size(), 150U);
  for (const io::ValueRecord& value : record.values) {
    // The products of inertia that the data set leaves out are zero by default.
    if (value.path == "name" || value.path.ends_with("inertia_xz")) continue;
    EXPECT_EQ(value.origin.kind, io::ValueOrigin::Kind::kFile) << value.path;
    EXPECT_FALSE(value.origin.source.empty()) << value.path;
    EXPECT_FALSE(value.origin.certainty.empty()) << value.path;
  }
  EXPECT_EQ(record.Find("steering.wheel.inertia")->origin.certainty, "P");
  EXPECT_EQ(record.Find("front_suspension.hardpoints.strut_top")->origin.certainty, "S");
}

TEST(CarSchema, ValuesArriveInSi) {
  const Car& car = CSegment();
  EXPECT_DOUBLE_EQ(car.front.strut.spring_rate, 23000.0);
  EXPECT_DOUBLE_EQ(car.front.arm_rear.y.progression, 0.0048);
  EXPECT_DOUBLE_EQ(car.front.strut.bumper.x[1], 0.02);
  EXPECT_DOUBLE_EQ(car.front.strut.bumper.y[1], 500.0);
  EXPECT_DOUBLE_EQ(car.steering.hydraulic.pressure.y[3], 12e5);
  EXPECT_NEAR(car.steering.hydraulic.pump_flow, 8e-3 / 60.0, 1e-18);
  EXPECT_NEAR(car.steering.electric.torsion_bar_stiffness, 2.25 * 180.0 / std::acos(-1.0), 1e-10);
  EXPECT_NEAR(car.steering.electric.speed_factor.x[1], 35.0 / 3.6, 1e-14);
}

TEST(CarSchema, CheckEchoesValuesAndWhatFollowsFromThem) {
  io::InputKinds kinds;
  AddInputKinds(&kinds);
  const io::InputRecord record = kinds.Detect(CarFile()).read(CarFile(), {});
  const std::string text = io::FormatRecordAsText(record);
  EXPECT_THAT(text, HasSubstr("front_suspension.arm_rear.y.stiffness"));
  EXPECT_THAT(text, HasSubstr("[P] Szczotka 2011, table 1"));
  EXPECT_THAT(text, HasSubstr("1399.7 kg"));
  EXPECT_THAT(text, HasSubstr("m g b/(2 L) [statics]"));
  EXPECT_THAT(io::FormatRecordAsJson(record), HasSubstr("\"formula\": \"m g b/(2 L)\""));
}

TEST(CarSchema, EverySubsystemFileCanBeCheckedByItself) {
  io::InputKinds kinds;
  AddInputKinds(&kinds);
  const std::filesystem::path folder = std::filesystem::path(CarFile()).parent_path();
  for (const char* name :
       {"body", "front_suspension", "rear_suspension", "steering", "driveline", "tyres"}) {
    const std::filesystem::path file = folder / (std::string(name) + ".yaml");
    EXPECT_FALSE(kinds.Detect(file).read(file, {}).values.empty()) << name;
  }
}

TEST(CarSchema, ARightSidePointIsAnError) {
  const std::string text = ReadWith({"front_suspension.hardpoints.wheel_centre=[0, -0.75, 0]"});
  EXPECT_THAT(text, HasSubstr("front_suspension.hardpoints.wheel_centre"));
  EXPECT_THAT(text, HasSubstr("y = -0.75 m"));
  EXPECT_THAT(text, HasSubstr("list the left side; y is positive to the left"));
}

TEST(CarSchema, AnImpossibleInertiaIsAnError) {
  const std::string text = ReadWith({"body.body.inertia=[450, 1600, 3000]"});
  EXPECT_THAT(text, HasSubstr("body.body.inertia"));
  EXPECT_THAT(text, HasSubstr("each at most the sum of the other two"));
  EXPECT_THAT(ReadWith({"tyres.belt.spin_inertia=0.7"}),
              HasSubstr("at most 0.6 kg m^2, twice diameter_inertia"));
  EXPECT_THAT(ReadWith({"body.body.inertia_xz=1000"}),
              HasSubstr("a tensor with positive principal moments"));
}

TEST(CarSchema, AColumnThatDoesNotAddUpIsAnError) {
  const std::string text = ReadWith({"steering.column.torsion_bar_stiffness=70 N m/rad"});
  EXPECT_THAT(text, HasSubstr("steering.column.total_stiffness"));
  EXPECT_THAT(text, HasSubstr("64.47 N m/rad within 0.5 %"));
}

TEST(CarSchema, AFallingBoostCurveIsAnError) {
  const std::string text =
      ReadWith({"steering.hydraulic.pressure={units: [N m, bar], rows: [[0, 0], [1, 3], [2, 2]]}"});
  EXPECT_THAT(text, HasSubstr("steering.hydraulic.pressure"));
  EXPECT_THAT(text, HasSubstr("never falls"));
  EXPECT_THAT(ReadWith({"steering.hydraulic.pressure={units: [N m, bar], rows: [[0, 1], [1, 3]]}"}),
              HasSubstr("first row 0, 0"));
}

TEST(CarSchema, AStiffChainOfASoftBarIsAnError) {
  const std::string text = ReadWith({"front_suspension.tie_rod.diameter=6 mm"});
  EXPECT_THAT(text, HasSubstr("front_suspension.tie_rod.chain_stiffness"));
  EXPECT_THAT(text, HasSubstr("at most the bar's own E A/l"));
}

TEST(CarSchema, AGroundThatIsNotUnderTheTyresIsAnError) {
  const std::string text = ReadWith({"body.ground_height=-0.32 m"});
  EXPECT_THAT(text, HasSubstr("body.ground_height"));
  EXPECT_THAT(text, HasSubstr("within 5 mm"));
}

TEST(CarSchema, ATieRodThroughTheSteeringAxisIsAnError) {
  EXPECT_THAT(ReadWith({"front_suspension.hardpoints.tie_rod_outer=[-0.0018, 0.6877, 0.028]",
                        "front_suspension.hardpoints.tie_rod_inner=[-0.0018, 0.33, 0.028]"}),
              HasSubstr("the tie rod must not point at the steering axis"));
}

TEST(CarSchema, ACarOnItsNoseIsAnError) {
  EXPECT_THAT(ReadWith({"body.body.centre_of_mass=[0.5, 0, 0.273]"}),
              HasSubstr("between the axles, 0 to 2.6 m"));
}

}  // namespace
}  // namespace kingpin::parameters
