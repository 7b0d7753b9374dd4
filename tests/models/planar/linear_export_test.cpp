#include "models/planar/linear_export.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/io/csv.h"
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
  std::istringstream csv(FormatMatricesAsCsv(model));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "# A (10 x 10)");
  for (int i = 0; i < 10; ++i) {
    std::getline(csv, line);
    std::istringstream fields(line);
    for (int j = 0; j < 10; ++j) {
      std::string field;
      std::getline(fields, field, ',');
      EXPECT_EQ(std::stod(field), model.a(i, j));
    }
  }
  std::getline(csv, line);
  EXPECT_EQ(line, "# B (10 x 2)");
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
  const auto table = io::ParseCsv(FormatResponseAsCsv(analysis.free_response), "response.csv");
  EXPECT_EQ(table.columns.size(), 1u + 2u * 2u * 6u);
  const auto* column = table.Find("tie_rod.force/road.force.magnitude");
  ASSERT_NE(column, nullptr);
  EXPECT_EQ(column->values.size(), analysis.free_response.frequency.size());
  EXPECT_EQ(column->values[7], std::abs(analysis.free_response.value[0][0][7]));
}

TEST(LinearExport, ParametersAreValidatedFirst) {
  auto p = PlanarCar();
  p.rack_mass = 0.0;
  EXPECT_THROW(AnalyseLinearly(p), io::InputError);
}

}  // namespace
}  // namespace kingpin::planar
