#include "models/planar/assist_stability.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "models/planar/car_reduction.h"
#include "models/planar/simulate.h"
#include "tests/models/parameters/c_segment.h"

namespace kingpin::planar {
namespace {

using O = CarModeOptions;
using parameters::CSegment;

Parameters<double> MakeCar(O::Assistance assistance, bool lag) {
  O options;
  options.assistance = assistance;
  options.assist_lag = lag;
  options.friction = O::Friction::kNone;
  options.torsion_bar_stops = false;
  options.aligning = O::Aligning::kNone;
  return MakePlanarParameters(CSegment(), options);
}

// Largest rim acceleration in the second half of a run over that in the first, after a push of 1 N.
double Growth(Parameters<double> p, double slope) {
  p.assist_force.count = 2;
  p.assist_force.x = {0.0, 1.0};
  p.assist_force.f = {0.0, slope};
  Pulse pulse;
  pulse.amplitude = 1.0;
  pulse.start = 0.01;
  pulse.duration = 0.02;
  SimulationOptions options;
  options.duration = 2.0;
  options.step = 2e-5;
  const History history = Simulate(p, Excitation({pulse}), options);
  double first = 0.0;
  double second = 0.0;
  for (std::size_t i = 0; i < history.size(); ++i) {
    const double a = std::abs(history.rim_acceleration[i]);
    if (history.time[i] > 1.5) {
      second = std::max(second, a);
    } else if (history.time[i] > 0.5 && history.time[i] < 1.0) {
      first = std::max(first, a);
    }
  }
  return second / first;
}

// Second route: the time integration of the full nonlinear model decays below the limit and grows
// above it.
TEST(AssistStability, LimitSeparatesDecayFromGrowth) {
  for (const auto assistance : {O::Assistance::kHydraulic, O::Assistance::kElectric}) {
    const Parameters<double> p = MakeCar(assistance, true);
    const double limit = CalcLargestStableSlope(p);
    ASSERT_TRUE(std::isfinite(limit));
    ASSERT_GT(limit, 0.0);
    EXPECT_LT(Growth(p, 0.8 * limit), 1.0);
    EXPECT_GT(Growth(p, 1.2 * limit), 1.0);
    EXPECT_LT(CalcAssistStability(p, 0.99 * limit).growth, 0.0);
    EXPECT_GT(CalcAssistStability(p, 1.01 * limit).growth, 0.0);
  }
}

TEST(AssistStability, ShippedCarIsStableWithoutLagAndNotWithIt) {
  for (const auto assistance : {O::Assistance::kHydraulic, O::Assistance::kElectric}) {
    const Parameters<double> prompt = MakeCar(assistance, false);
    const Parameters<double> lagged = MakeCar(assistance, true);
    const double steepest = CalcSteepestChord(prompt.assist_force);
    EXPECT_GT(CalcLargestStableSlope(prompt), CalcLargestStableSlope(lagged));
    EXPECT_LT(CalcLargestStableSlope(lagged), steepest);
    EXPECT_LT(CalcAssistStability(prompt, steepest).growth, 0.0);
    EXPECT_GT(CalcAssistStability(lagged, steepest).growth, 10.0);
  }
}

TEST(AssistStability, DampingOfTheRackRaisesTheLimit) {
  Parameters<double> p = MakeCar(O::Assistance::kHydraulic, true);
  double last = 0.0;
  for (const double damping : {600.0, 2000.0, 6000.0, 2e4, 6e4}) {
    p.rack_damping = damping;
    const double limit = CalcLargestStableSlope(p);
    EXPECT_GT(limit, last);
    last = limit;
  }
}

}  // namespace
}  // namespace kingpin::planar
