#include "models/planar/linear_export.h"

#include <complex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/io/error.h"
#include "core/io/json_text.h"
#include "tests/models/planar/paper_sets.h"
#include "tests/models/planar/planar_car.h"

namespace kingpin::planar {
namespace {

TEST(LinearExport, MatricesReadBackToTheLastBit) {
  const LinearModel model = MakeLinearModel(sets::SetB().parameters);
  const auto json = nlohmann::ordered_json::parse(io::FormatJson(MakeJson(model)));
  ASSERT_EQ(json["A"].size(), 10u);
  ASSERT_EQ(json["states"].size(), 10u);
  EXPECT_EQ(json["states"][3]["name"], "rack.travel");
  EXPECT_EQ(json["outputs"][2]["unit"], "m/s^2");
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      EXPECT_EQ(json["A"][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>(),
                model.a(i, j));
    }
  }
}

TEST(LinearExport, AnalysisHoldsFreeAndHeldWheel) {
  const LinearAnalysis analysis = AnalyseLinearly(PlanarCar());
  EXPECT_EQ(analysis.free.a.rows(), 10);
  EXPECT_EQ(analysis.held.a.rows(), 8);
  EXPECT_GT(analysis.road_feel_gain, 0.0);
  const auto json = MakeJson(analysis);
  EXPECT_EQ(json["free"]["modes"][0]["kind"], "drift");
  EXPECT_EQ(json["held"]["modes"][0]["kind"], "oscillatory");
  EXPECT_EQ(json["held"]["modes"][0]["shares"].size(), 4u);
  for (const auto& mode : json["free"]["modes"]) {
    ASSERT_EQ(mode["shape"].size(), 10u);
    EXPECT_EQ(mode["shape"][3]["state"], "rack.travel");
    EXPECT_EQ(mode["shape"][3]["unit"], "m");
  }
  EXPECT_EQ(json["road_feel_gain"]["unit"], "N m/(N m)");
  const auto& response = json["free"]["frequency_response"];
  ASSERT_EQ(response["responses"].size(), 2u * 6u);
  EXPECT_EQ(response["responses"][0]["input"], "road.force");
  EXPECT_EQ(response["responses"][0]["output"], "tie_rod.force");
  EXPECT_EQ(response["responses"][0]["unit"], "(N)/(N)");
  EXPECT_EQ(response["frequency"]["values"].size(), analysis.free_response.frequency.size());
  EXPECT_EQ(response["responses"][0]["magnitude"][7].get<double>(),
            std::abs(analysis.free_response.value[0][0][7]));
}

TEST(LinearExport, ParametersAreValidatedFirst) {
  auto p = PlanarCar();
  p.rack_mass = 0.0;
  EXPECT_THROW(AnalyseLinearly(p), io::InputError);
}

}  // namespace
}  // namespace kingpin::planar
