#include "models/planar/linear_frequency_response.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "models/planar/linear_entries.h"
#include "models/planar/planar_model.h"
#include "models/planar/simulate.h"
#include "tests/models/planar/paper_sets.h"
#include "tests/models/planar/planar_car.h"

namespace kingpin::planar {
namespace {

using Complex = std::complex<double>;
using Vector5c = Eigen::Matrix<Complex, 5, 1>;

// Amplitudes of q per newton of F_T: (K − ω² M + iω P)⁻¹ G, assembled here from elements.
Vector5c SolveDirectly(const Parameters<double>& p, double frequency) {
  const auto e = CalcLinearEntries(p);
  const auto k = MakeModel(p).constants;
  const Complex s{0.0, 2.0 * std::numbers::pi * frequency};
  Eigen::Matrix<Complex, 5, 5> z;
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 5; ++j) {
      z(static_cast<int>(i), static_cast<int>(j)) =
          e.stiffness[i][j] + s * e.damping[i][j] +
          e.longitudinal_row[i] * e.longitudinal_row[j] *
              (k.longitudinal_force.segment[3].b + s * p.longitudinal_damping);
    }
    z(static_cast<int>(i), static_cast<int>(i)) += s * s * e.mass[i];
  }
  const double assist = k.assist_force.segment[0].b * p.column_stiffness;
  z(3, 3) += assist * p.gear_ratio;
  z(3, 4) -= assist;
  Vector5c g;
  for (int i = 0; i < 5; ++i) g(i) = e.force_row[static_cast<std::size_t>(i)];
  return z.partialPivLu().solve(g);
}

TEST(FrequencyResponse, IsTheDynamicStiffnessSolvedDirectly) {
  auto all = std::vector<Parameters<double>>{PlanarCar()};
  for (const auto& set : sets::AllSets()) all.push_back(set.parameters);
  for (const auto& p : all) {
    const LinearModel model = MakeLinearModel(p);
    const auto grid = MakeFrequencyGrid(CalcModes(model), 0.5, 500.0, 20);
    const auto response = CalcFrequencyResponse(model, grid);
    const auto rod = CalcRodAtRest(p);
    const auto e = CalcLinearEntries(p);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const Vector5c q = SolveDirectly(p, grid[i]);
      const Complex s{0.0, 2.0 * std::numbers::pi * grid[i]};
      const Complex damper = 1.0 + s * p.damping_time;
      Complex elongation = 0.0;
      for (int k = 0; k < 5; ++k) elongation += e.rod_row[static_cast<std::size_t>(k)] * q(k);
      const Complex rod_force = rod.stiffness * damper * elongation;
      const Complex torque = p.column_stiffness * damper * (q(4) - p.gear_ratio * q(3));
      const auto near = [&](std::size_t output, Complex expected) {
        // The condition of the stiff rod against the soft column: ten digits remain.
        EXPECT_LT(std::abs(response.value[output][0][i] - expected), 1e-9 * std::abs(expected))
            << response.outputs[output] << " at " << grid[i];
      };
      near(0, rod_force);
      near(1, q(4));
      near(2, s * s * q(4) * p.rim_radius);
      near(3, torque);
      near(4, q(3));
      near(5, rod_force * rod.sine);
    }
  }
}

TEST(FrequencyResponse, IsWhatALongSineSettlesTo) {
  // A small sine, so that the curves stay straight; hands and aligning torque, so that the start
  // dies out. The last periods are projected on sine and cosine.
  auto p = PlanarCar();
  p.aligning_stiffness = 700.0;
  p.hands_stiffness = 5.0;
  p.hands_damping = 1.0;
  p.rack_damping = 600.0;
  // Straight lines only: the assistance's curve has curvature elsewhere.
  for (std::size_t i = 0; i < 7; ++i) {
    p.assist_force.f[i] = 150.0 * p.assist_force.x[i];
  }
  const LinearModel model = MakeLinearModel(p);
  for (const double frequency : {4.0, 16.0, 20.0, 40.0}) {
    Pulse sine;
    sine.kind = PulseKind::kRingDown;
    sine.amplitude = 0.1;
    sine.frequency = frequency;
    SimulationOptions options;
    options.duration = 8.0;
    options.sample_interval = 1.0 / 3200.0;
    options.step = 2e-5;
    // A tenth of a newton: the rounding of the rod's elongation, 1e-16 of its length, is much of
    // the forces' differences that the error estimate sums over eight seconds (2.4e-4).
    options.tolerance = 1e-3;
    const History history = Simulate(p, Excitation({sine}), options);
    const auto response = CalcFrequencyResponse(model, {frequency});
    const std::vector<const std::vector<double>*> signals{
        &history.tie_rod_force,  &history.q[4], &history.rim_acceleration,
        &history.torsion_torque, &history.q[3], &history.rack_force};
    for (std::size_t output = 0; output < signals.size(); ++output) {
      // Whole periods at the end: one second holds whole periods of every frequency here.
      Complex amplitude = 0.0;
      constexpr std::size_t kLast = 3200;
      const std::size_t first = history.size() - 1 - kLast;
      for (std::size_t i = first; i < first + kLast; ++i) {
        const double angle = 2.0 * std::numbers::pi * frequency * history.time[i];
        amplitude += (*signals[output])[i] * std::exp(Complex{0.0, -angle});
      }
      amplitude *= 2.0 / kLast;
      // F_T = A sin ωt = Im(A e^{iωt}): the cosine projection of a sine is −i A.
      const Complex measured = amplitude / (sine.amplitude * Complex{0.0, -1.0});
      const Complex expected = response.value[output][0][0];
      // Exact rotation and rod length at a tenth of a newton: second order, below 1e-6.
      EXPECT_LT(std::abs(measured - expected), 1e-6 * std::abs(expected))
          << response.outputs[output] << " at " << frequency << " Hz";
    }
  }
}

TEST(FrequencyResponse, GridPutsNinePointsInsideEveryPeak) {
  const LinearModel model = MakeLinearModel(sets::SetA().parameters);
  const Modes modes = CalcModes(model);
  const auto grid = MakeFrequencyGrid(modes, 1.0, 300.0, 10);
  EXPECT_EQ(grid.front(), 1.0);
  EXPECT_EQ(grid.back(), 300.0);
  for (std::size_t i = 1; i < grid.size(); ++i) ASSERT_LT(grid[i - 1], grid[i]);
  int narrow = 0;
  for (const auto& mode : modes.modes) {
    if (mode.kind != ModeKind::kOscillatory || mode.damping_ratio > 0.1 || mode.frequency > 300.0) {
      continue;
    }
    ++narrow;
    const double half = mode.damping_ratio * mode.frequency;
    const auto inside = std::count_if(grid.begin(), grid.end(), [&](double f) {
      return std::abs(f - mode.damped_frequency) <= 1.01 * half;
    });
    EXPECT_GE(inside, 9) << mode.summary;
  }
  EXPECT_GE(narrow, 1);  // set A swings almost undamped near 15 Hz
}

TEST(FrequencyResponse, HeldWheelFeelsNothingAtItsRimAndMoreInItsColumn) {
  const auto p = PlanarCar();
  const LinearModel free = MakeLinearModel(p);
  const LinearModel held = HoldSteeringWheel(free);
  const std::vector<double> grid{0.5};
  const auto free_response = CalcFrequencyResponse(free, grid);
  const auto held_response = CalcFrequencyResponse(held, grid);
  EXPECT_EQ(held_response.value[2][0][0], 0.0);
  EXPECT_GT(std::abs(held_response.value[3][0][0]), std::abs(free_response.value[3][0][0]));
}

TEST(FrequencyResponse, BodePhaseIsUnwrapped) {
  const LinearModel model = MakeLinearModel(sets::SetC().parameters);
  const auto grid = MakeFrequencyGrid(CalcModes(model), 0.5, 500.0);
  const auto response = CalcFrequencyResponse(model, grid);
  const auto curve = CalcBodeCurve(response, "road.force", "steering.wheel.angle");
  EXPECT_EQ(curve.unit, "(rad)/(N)");
  for (std::size_t i = 0; i < grid.size(); ++i) {
    EXPECT_NEAR(curve.magnitude_db[i], 20.0 * std::log10(curve.magnitude[i]), 1e-12);
    if (i > 0) {
      EXPECT_LT(std::abs(curve.phase[i] - curve.phase[i - 1]), 90.0);
    }
    const Complex back = std::polar(curve.magnitude[i], curve.phase[i] * std::numbers::pi / 180.0);
    EXPECT_LT(std::abs(back - response.value[1][0][i]), 1e-12 * curve.magnitude[i]);
  }
}

TEST(FrequencyResponse, ErrorsSayWhatToDo) {
  const LinearModel model = MakeLinearModel(sets::SetA().parameters);
  EXPECT_THAT([&] { CalcFrequencyResponse(model, {0.0}); },
              testing::ThrowsMessage<io::RunError>(testing::HasSubstr("leave that frequency out")));
  const auto response = CalcFrequencyResponse(model, {1.0});
  EXPECT_THAT([&] { CalcBodeCurve(response, "road.force", "phi"); },
              testing::ThrowsMessage<std::invalid_argument>(
                  testing::HasSubstr("no output 'phi' among: tie_rod.force")));
  EXPECT_THAT([&] { MakeFrequencyGrid(CalcModes(model), 0.0, 10.0); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("0 < lowest")));
}

}  // namespace
}  // namespace kingpin::planar
