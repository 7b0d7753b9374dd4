#include "core/io/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/core/io/example_schema.h"

namespace kingpin::io {
namespace {

using example::Assistance;
using example::MakeSchema;
using example::Steering;

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

// The echo holds everything that was understood: fed back as overrides over an empty input, the
// struct comes out the same.
TEST(Schema, TheEchoReadsBackAsTheSameInput) {
  InputRecord record;
  const Steering steering = ReadText(MakeSchema(), kGood, "a.yaml", {}, &record);
  ReadOptions options;
  for (const ValueRecord& value : record.values) {
    if (value.path.starts_with("load_cases") || value.path.starts_with("named")) continue;
    const bool has_unit = value.numbers.size() == 1 && !value.value.starts_with('[');
    const std::string text = has_unit ? FormatQuantity(value.numbers[0], value.unit) : value.value;
    options.overrides.push_back(ParseOverride(value.path + "=" + text));
  }
  options.overrides.push_back(ParseOverride("load_cases=[{speed: 35 km/h}, {speed: 1}]"));
  options.overrides.push_back(ParseOverride("load_cases[1].speed=10 m/s"));
  options.overrides.push_back(ParseOverride("load_cases[1].weight=0.5"));
  options.overrides.push_back(ParseOverride("named={slow: {speed: 5}}"));
  InputRecord again;
  const Steering read = ReadText(MakeSchema(), "kind: steering\n", "b.yaml", options, &again);
  ASSERT_EQ(again.values.size(), record.values.size());
  for (std::size_t i = 0; i < record.values.size(); ++i) {
    EXPECT_EQ(again.values[i].path, record.values[i].path);
    EXPECT_EQ(again.values[i].value, record.values[i].value) << record.values[i].path;
    EXPECT_EQ(again.values[i].numbers, record.values[i].numbers) << record.values[i].path;
  }
  EXPECT_EQ(read.boost.y, steering.boost.y);
  EXPECT_EQ(read.outer_joint, steering.outer_joint);
}

TEST(Schema, TheEchoIsPrintedWithUnitAndOrigin) {
  InputRecord record;
  ReadText(MakeSchema(),
           "kind: steering\nrack: {mass: {value: 300 g, source: weighed, certainty: D}}\n",
           "a.yaml", {}, &record);
  const std::string text = FormatRecordAsText(record);
  EXPECT_THAT(text, testing::ContainsRegex("rack.mass +0.3 kg +300 g +a.yaml:2 .D. weighed\n"));
  EXPECT_THAT(text, testing::ContainsRegex("rack.travel +0.15 m +150 mm +default\n"));
  const auto json = nlohmann::json::parse(FormatRecordAsJson(record));
  EXPECT_EQ(json["kind"], "steering");
  EXPECT_EQ(json["values"][0]["value"], 0.3);
  EXPECT_EQ(json["values"][0]["unit"], "kg");
  EXPECT_EQ(json["values"][0]["text"], "300 g");
  EXPECT_EQ(json["values"][0]["origin"]["line"], 2);
  EXPECT_EQ(json["values"][0]["origin"]["source"], "weighed");
  EXPECT_EQ(json["values"][1]["origin"]["kind"], "default");
}

TEST(Schema, TheLastOverrideOfAPathWins) {
  ReadOptions options;
  options.overrides.push_back(ParseOverride("rack.mass=1 kg"));
  options.overrides.push_back(ParseOverride("rack.mass=2 kg"));
  EXPECT_EQ(ReadText(MakeSchema(), "kind: steering\n", "a.yaml", options).rack.mass, 2.0);
}

TEST(Schema, DeclarationsThatMakeNoSenseAreRefused) {
  struct Thing {
    double a = 0.0;
  };
  Schema<Thing> s("thing", "a thing");
  s.Quantity("a", &Thing::a, "kg", "first");
  EXPECT_THROW(s.Quantity("a", &Thing::a, "kg", "again"), std::logic_error);
  EXPECT_THROW(s.Quantity("kind", &Thing::a, "kg", "reserved"), std::logic_error);
  EXPECT_THROW(s.Quantity("b", &Thing::a, "mm", "not SI"), std::logic_error);
  Schema<Thing> wrong("thing", "a thing");
  wrong.Quantity("a", &Thing::a, "kg", "first").Default("3 m");
  EXPECT_THROW(ReadText(wrong, "kind: thing\n", "a.yaml"), std::logic_error);
}

TEST(Schema, MarkdownListsEveryKeyWithUnitRangeAndDefault) {
  const std::string text = FormatSchemaAsMarkdown(*MakeSchema().core());
  EXPECT_THAT(text, testing::HasSubstr("| `rack.mass` | quantity [kg], more than 0 kg | required | "
                                       "mass of the rack |"));
  EXPECT_THAT(text,
              testing::HasSubstr("| `rack.travel` | quantity [m], more than 0 m | `150 mm` |"));
  EXPECT_THAT(text, testing::HasSubstr("| `load_cases[i].speed` | "));
}

}  // namespace
}  // namespace kingpin::io
