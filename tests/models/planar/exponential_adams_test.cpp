#include "models/planar/exponential_adams.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/models/planar/planar_car.h"

namespace kingpin::planar {
namespace {

AdamsWeights<double> MakeWeightsWithoutRod() {
  Model<double> model = MakeModel(PlanarCar());
  model.constants.rod_stiffness = model.constants.rod_damping = 0;
  AdamsWeights<double> weights;
  MakeAdamsWeights(MakeRodMode(model.structure, model.constants, false), 2.5e-4, weights);
  return weights;
}

// Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, III.1.
constexpr double kBashforth[] = {198721, -447288, 705549, -688256, 407139, -134472, 19087};

TEST(ExponentialAdams, IsAdamsBashforthMoultonOfOrderSevenWithoutTheRod) {
  const AdamsWeights<double> weights = MakeWeightsWithoutRod();
  const double h2 = weights.h * weights.h;
  for (int j = 0; j < kAdamsOrder; ++j) {
    // Lagrange polynomials with coefficients near 100 are put together in doubles.
    EXPECT_NEAR(weights.v[j] / weights.h, kBashforth[j] / 60480, 1e-12) << j;
    EXPECT_NEAR(weights.rod_q[j] / h2, 0, 1e-12) << j;
    EXPECT_NEAR(weights.rod_v[j] / weights.h, 0, 1e-12) << j;
  }
  EXPECT_NEAR(weights.correct_v / weights.h, 19087.0 / 60480, 1e-13);
  EXPECT_NEAR(weights.rod_correct_v / weights.h, 0, 1e-13);
  EXPECT_NEAR(weights.rod_correct_q / h2, 0, 1e-13);
}

// Positions from accelerations that are polynomials of the sixth degree: ∫_0^1 (1 − s) s^m ds.
TEST(ExponentialAdams, PositionsAreExactForPolynomialsOfTheSixthDegree) {
  const AdamsWeights<double> weights = MakeWeightsWithoutRod();
  const double h2 = weights.h * weights.h;
  for (int m = 0; m < kAdamsOrder; ++m) {
    double sum = 0;
    double largest = 0;
    for (int j = 0; j < kAdamsOrder; ++j) {
      const double term = weights.q[j] / h2 * std::pow(-j, m);
      sum += term;
      largest = std::max(largest, std::abs(term));
    }
    EXPECT_NEAR(sum, 1.0 / ((m + 1) * (m + 2)), 1e-13 * std::max(1.0, largest)) << m;
  }
}

}  // namespace
}  // namespace kingpin::planar
