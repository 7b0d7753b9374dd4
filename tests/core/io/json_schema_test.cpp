#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/io/error.h"
#include "tests/core/io/example_schema.h"
#include "tests/core/io/json_schema_checker.h"

namespace kingpin::io {
namespace {

Json GetSchema() { return Json::parse(FormatJsonSchema(*example::MakeSchema().core())); }

std::string Check(const char* yaml) {
  return FindSchemaViolation(GetSchema(), MakeJson(*ParseYaml(yaml, "a.yaml")));
}

TEST(JsonSchema, SaysWhichDraftItIs) {
  const Json schema = GetSchema();
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["properties"]["kind"]["const"], "steering");
  EXPECT_EQ(schema["properties"]["share"]["description"],
            "of the force [1], at least 0, at most 1");
  EXPECT_EQ(schema["properties"]["assistance"]["default"], "none");
}

// Each thing once: sections of the same schema, quantities with the same limits.
TEST(JsonSchema, SharesWhatStandsInSeveralPlaces) {
  const Json schema = GetSchema();
  EXPECT_EQ(schema["properties"]["second_rack"]["$ref"], "#/$defs/section_rack");
  EXPECT_EQ(schema["properties"]["rack"]["anyOf"][1]["$ref"], "#/$defs/section_rack");
  EXPECT_EQ(schema["$defs"]["section_rack"]["properties"]["mass"]["$ref"],
            "#/$defs/quantity_above_0");
  EXPECT_EQ(schema["properties"]["share"]["$ref"], "#/$defs/quantity_from_0_to_1");
}

TEST(JsonSchema, AcceptsWhatTheReaderAccepts) {
  for (const char* yaml :
       {"kind: steering\nrack: {mass: 2}", "kind: steering\nrack: rack.yaml",
        "kind: steering\nrack: {mass: {value: 2.5 kg, source: x, certainty: D, note: y}}",
        "kind: steering\nsource: manual\nrack: {mass: 2 kg, travel: .5e1 mm, preload: 0}\n"
        "assistance: hydraulic\nboost: [[0, 0], [1 N m, 2 kN]]\nlocked: yes\nteeth: 9\n"
        "outer_joint: {value: [1, 2, 3], unit: mm}\nnodes: [0, 1 mm]\nfree_variables: [r_L, r_X]\n"
        "load_cases: [{speed: 3}]\nnamed: {a: {speed: 3 km/h, weight: 50 %}}\n"
        "points: {units: [mm, mm, deg], rows: [[1, 2, 3]]}",
        "kind: steering\nrack: {mass: 2}\nassistance: hydraulic\nboost: {file: a.csv}"}) {
    EXPECT_EQ(Check(yaml), "") << yaml;
  }
}

TEST(JsonSchema, RefusesWhatTheReaderRefuses) {
  for (const char* yaml : {"rack: {mass: 2}",
                           "kind: car\nrack: {mass: 2}",
                           "kind: steering",
                           "kind: steering\nrack: {}",
                           "kind: steering\nrack: {mass: heavy}",
                           "kind: steering\nrack: {mass: -2}",
                           "kind: steering\nrack: {mas: 2}",
                           "kind: steering\nrack: {mass: [2]}",
                           "kind: steering\nrack: {mass: {val: 2}}",
                           "kind: steering\nrack: {mass: {value: 2, certainty: Q}}",
                           "kind: steering\nrack: {mass: 2}\nassistance: hydrolic",
                           "kind: steering\nrack: {mass: 2}\nteeth: 8.5",
                           "kind: steering\nrack: {mass: 2}\nteeth: 2",
                           "kind: steering\nrack: {mass: 2}\nouter_joint: [1, 2]",
                           "kind: steering\nrack: {mass: 2}\nnodes: [1]",
                           "kind: steering\nrack: {mass: 2}\nboost: [[1, 2]]",
                           "kind: steering\nrack: {mass: 2}\npoints: [[1, 2]]",
                           "kind: steering\nrack: {mass: 2}\nload_cases: {speed: 3}",
                           "kind: steering\nrack: {mass: 2}\nnamed: {a: {sped: 3}}",
                           "kind: steering\nrack: {mass: 2}\nlocked: maybe",
                           "kind: steering\nrack: {mass: 2}\nfree_variables: [rx]"}) {
    EXPECT_NE(Check(yaml), "") << yaml;
    EXPECT_THROW(ReadText(example::MakeSchema(), yaml, "a.yaml"), InputError) << yaml;
  }
}

}  // namespace
}  // namespace kingpin::io
