#include "models/planar/linear_model.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/planar/linear_entries.h"
#include "models/planar/linear_promotion.h"
#include "models/planar/planar_forces.h"
#include "tests/models/planar/paper_sets.h"
#include "tests/models/planar/planar_car.h"
#include "tests/models/planar/second_formulation.h"

namespace kingpin::planar {
namespace {

using Matrix5d = Eigen::Matrix<double, 5, 5>;

Matrix5d ToEigen(const Matrix5<double>& m) {
  Matrix5d result;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      result(i, j) = m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return result;
}

// Hessian of the exact potential: complex step for the gradient, eighth-order central differences
// of it. Written on the energies of second_formulation.h, which share no code with the model.
Matrix5d CalcHessian(const Parameters<double>& p) {
  const second::Model model(p);
  const auto gradient = [&](const std::array<double, 5>& q, std::size_t i) {
    second::Vector5<second::Complex> z{};
    for (std::size_t k = 0; k < 5; ++k) z[k] = q[k];
    z[i] += second::Complex{0.0, 1e-40};
    return model.Potential(z).imag() / 1e-40;
  };
  constexpr std::array<double, 4> kWeights{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  Matrix5d hessian = Matrix5d::Zero();
  for (std::size_t j = 0; j < 5; ++j) {
    const double h = j == 2 || j == 4 ? 1e-3 : 1e-4;
    for (std::size_t i = 0; i < 5; ++i) {
      double sum = 0.0;
      for (int k = 1; k <= 4; ++k) {
        std::array<double, 5> plus{}, minus{};
        plus[j] = k * h;
        minus[j] = -k * h;
        sum += kWeights[static_cast<std::size_t>(k - 1)] *
               (gradient(plus, i) - gradient(minus, i)) / h;
      }
      hessian(static_cast<int>(i), static_cast<int>(j)) = sum;
    }
  }
  return hessian;
}

// Largest deviation, each entry relative to the geometric mean of its two diagonal entries: a
// measure that does not depend on the units of the coordinates.
double CalcDeviation(const Matrix5d& a, const Matrix5d& reference) {
  double worst = 0.0;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const double scale = std::sqrt(reference(i, i) * reference(j, j));
      worst = std::max(worst, std::abs(a(i, j) - reference(i, j)) / scale);
    }
  }
  return worst;
}

Parameters<double> WithoutCurves(Parameters<double> p) {
  for (auto& f : p.longitudinal_force.f) f = 0.0;
  for (auto& f : p.assist_force.f) f = 0.0;
  return p;
}

std::vector<Parameters<double>> AllParameters() {
  std::vector<Parameters<double>> all;
  for (const auto& set : sets::AllSets()) all.push_back(set.parameters);
  all.push_back(PlanarCar());
  return all;
}

TEST(LinearEntries, StiffnessIsTheHessianOfTheExactPotential) {
  for (const auto& p : AllParameters()) {
    const auto bare = WithoutCurves(p);
    EXPECT_LT(CalcDeviation(ToEigen(CalcLinearEntries(bare).stiffness), CalcHessian(bare)), 1e-8);
  }
}

TEST(LinearEntries, ThePrintedEntryC13IsNotTheHessian) {
  const auto p = WithoutCurves(sets::SetA().parameters);
  const auto rod = CalcRodAtRest(p);
  const double printed =
      rod.stiffness * (rod.outer_x * rod.cosine * rod.sine - rod.outer_y * rod.cosine) +
      p.lateral_stiffness * (p.lateral_x * rod.cosine * rod.sine - p.lateral_y * rod.cosine);
  const double right = CalcHessian(p)(0, 2);
  EXPECT_GT(std::abs(printed - right), 0.01 * std::abs(right));
}

TEST(LinearEntries, FourSpringsLeaveExactlyOneZeroMode) {
  for (const auto& p : AllParameters()) {
    const auto entries = CalcLinearEntries(p);
    Matrix5d k = ToEigen(entries.stiffness);
    const Eigen::Map<const Eigen::Matrix<double, 5, 1>> row(entries.longitudinal_row.data());
    k += 4.9e5 * row * row.transpose();
    // Scaled by the diagonal, so that the rank does not depend on units.
    const Eigen::Matrix<double, 5, 1> scale = k.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix5d scaled = scale.asDiagonal() * k * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Matrix5d> solver(scaled);
    EXPECT_LT(std::abs(solver.eigenvalues()(0)), 1e-14);
    EXPECT_GT(solver.eigenvalues()(1), 1e-6);
    // The zero mode turns carrier, rack and wheel together: no spring is strained.
    const Eigen::Matrix<double, 5, 1> mode = scale.asDiagonal() * solver.eigenvectors().col(0);
    EXPECT_NEAR(mode(4) / (p.gear_ratio * mode(3)), 1.0, 1e-9);
  }
}

TEST(LinearModel, StiffnessAndDampingOfTheForceModelAreTheClosedEntries) {
  for (const auto& p : AllParameters()) {
    auto bare = WithoutCurves(p);
    bare.hands_damping = bare.rack_damping = bare.longitudinal_damping = 0.0;
    const auto entries = CalcLinearEntries(bare);
    const LinearModel model = MakeLinearModel(bare);
    // Rounding only: both are exact up to a few units in the last place of the largest term.
    EXPECT_LT(CalcDeviation(CalcStiffness(model), ToEigen(entries.stiffness)), 1e-13);
    EXPECT_LT(CalcDeviation(CalcDamping(model), ToEigen(entries.damping)), 1e-13);
  }
}

TEST(LinearModel, StiffnessWithTheLongitudinalSupportIsTheHessian) {
  for (const auto& p : AllParameters()) {
    auto passive = p;
    for (auto& f : passive.assist_force.f) f = 0.0;
    EXPECT_LT(CalcDeviation(CalcStiffness(MakeLinearModel(passive)), CalcHessian(passive)), 1e-8);
  }
}

TEST(LinearModel, EveryRowOfTheInputMatrixIsThere) {
  const auto p = sets::SetB().parameters;
  const auto entries = CalcLinearEntries(p);
  const LinearModel model = MakeLinearModel(p);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(model.b(i, 0), 0.0);
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(model.b(5 + i, 0) * entries.mass[k], entries.force_row[k], 1e-15);
  }
  EXPECT_DOUBLE_EQ(model.b(7, 1), 1.0 / p.carrier_yaw_inertia);
  EXPECT_EQ((model.b.col(1).array() != 0.0).count(), 1);
}

TEST(LinearModel, RodForceOutputHoldsTheRackColumn) {
  const auto p = sets::SetA().parameters;
  const auto rod = CalcRodAtRest(p);
  const LinearModel model = MakeLinearModel(p);
  ASSERT_EQ(model.output_names[0], "tie_rod.force");
  ASSERT_EQ(model.c.cols(), 10);
  const double scale = rod.stiffness * 1e-14;
  EXPECT_NEAR(model.c(0, 0), rod.stiffness * rod.cosine, scale);
  EXPECT_NEAR(model.c(0, 1), rod.stiffness * rod.sine, scale);
  EXPECT_NEAR(model.c(0, 2), rod.stiffness * (rod.outer_x * rod.sine - rod.outer_y * rod.cosine),
              scale);
  EXPECT_NEAR(model.c(0, 3), -rod.stiffness * rod.sine, scale);
  EXPECT_EQ(model.c(0, 4), 0.0);
  for (int j = 0; j < 5; ++j) {
    EXPECT_NEAR(model.c(0, 5 + j), p.damping_time * model.c(0, j), scale);
  }
  EXPECT_EQ(model.d.cwiseAbs().maxCoeff(), 0.0);
}

// All options that are smooth at the state, extra states included.
Parameters<double> WithEverySmoothOption() {
  auto p = PlanarCar();
  p.rod_compliance = 1.5e-7;
  p.aligning_stiffness = 2700.0;
  p.aligning_lag = 0.05;
  p.friction_law = FrictionLaw::kSmoothed;
  p.friction_coefficient = 0.08;
  p.friction_preload = 1200.0;
  p.friction_constant = 20.0;
  p.friction_speed = 1e-3;
  p.stop_angle = 0.02;
  p.stop_stiffness = 800.0;
  p.hands_damping = 0.4;
  p.hands_stiffness = 5.0;
  p.rack_damping = 600.0;
  p.assist_lag = AssistLag::kSecondOrder;
  p.assist_frequency = 377.0;
  p.assist_damping = 0.7;
  return p;
}

TEST(LinearModel, AgreesWithDifferencesOfTheForcesAtRandomStates) {
  const auto p = WithEverySmoothOption();
  const Model<double> compiled = MakeModel(p);
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    OperatingPoint at;
    const double size = 1.0;
    const std::array<double, 5> q_size{5e-3, 2e-3, 0.02, 5e-4, 0.1};
    const std::array<double, 5> v_size{0.3, 0.1, 1.0, 0.05, 5.0};
    for (std::size_t i = 0; i < 5; ++i) {
      at.position[i] = size * q_size[i] * uniform(random);
      at.velocity[i] = size * v_size[i] * uniform(random);
    }
    at.extra = {0.01 * uniform(random), 300.0 * uniform(random), 1e4 * uniform(random)};
    at.road_force = 3000.0 * uniform(random);
    const LinearModel model = MakeLinearModel(p, at);
    ASSERT_EQ(model.a.rows(), 13);

    const auto rate = [&](const Eigen::VectorXd& x) {
      State<double> state{};
      for (int i = 0; i < 5; ++i) {
        state.q[i] = x(i);
        state.v[i] = x(5 + i);
      }
      for (int i = 0; i < 3; ++i) state.extra[i] = x(10 + i);
      Dynamics<double> out{};
      CalcDynamics<double>(compiled.structure, compiled.constants, state, at.road_force, 0.0, out);
      Eigen::VectorXd r(13);
      for (int i = 0; i < 5; ++i) {
        r(i) = x(5 + i);
        r(5 + i) = out.a[i];
      }
      for (int i = 0; i < 3; ++i) r(10 + i) = out.extra_rate[i];
      return r;
    };
    EXPECT_LT((rate(model.state) - model.rate).cwiseAbs().maxCoeff(),
              1e-12 * model.rate.cwiseAbs().maxCoeff());
    const double yaw_size = 0.01;
    for (int j = 0; j < 13; ++j) {
      // Steps small against the smoothed friction's speed and the curves' node spacing.
      const double h = j < 5     ? 1e-3 * q_size[static_cast<std::size_t>(j)]
                       : j < 10  ? (j == 8 ? 1e-5 : 1e-3 * v_size[static_cast<std::size_t>(j - 5)])
                       : j == 10 ? 1e-3 * yaw_size
                                 : 0.1;
      constexpr std::array<double, 4> kWeights{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
      Eigen::VectorXd difference = Eigen::VectorXd::Zero(13);
      for (int k = 1; k <= 4; ++k) {
        Eigen::VectorXd plus = model.state, minus = model.state;
        plus(j) += k * h;
        minus(j) -= k * h;
        difference += kWeights[static_cast<std::size_t>(k - 1)] / h * (rate(plus) - rate(minus));
      }
      for (int i = 0; i < 13; ++i) {
        const double scale = model.a.row(i).cwiseAbs().maxCoeff();
        EXPECT_NEAR(difference(i), model.a(i, j), 1e-8 * scale) << i << " " << j;
      }
    }
  }
}

TEST(LinearModel, HeldWheelLosesItsTwoStates) {
  const LinearModel model = MakeLinearModel(WithEverySmoothOption());
  const LinearModel held = HoldSteeringWheel(model);
  EXPECT_EQ(held.a.rows(), 11);
  EXPECT_EQ(held.coordinates, 4);
  EXPECT_EQ(held.a(8, 8), model.a(10, 10));
  EXPECT_EQ(held.c.row(2).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_THAT(held.state_names, testing::Not(testing::Contains("steering.wheel.angle")));
}

TEST(LinearModel, SaysWhatItLeavesOut) {
  auto p = sets::SetA().parameters;
  p.friction_law = FrictionLaw::kCoulomb;
  p.friction_constant = 250.0;
  p.rod_free_play = 1e-4;
  const LinearModel model = MakeLinearModel(p);
  EXPECT_THAT(model.notes, testing::ElementsAre(testing::HasSubstr("set-valued rack friction"),
                                                testing::HasSubstr("free play")));
  EXPECT_LT((model.a - MakeLinearModel(sets::SetA().parameters).a).cwiseAbs().maxCoeff(), 1e-300);
}

}  // namespace
}  // namespace kingpin::planar
