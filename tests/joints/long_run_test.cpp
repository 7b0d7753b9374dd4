#include <gtest/gtest.h>

#include "core/solve/simulate.h"
#include "tests/joints/example_mechanisms.h"

namespace kingpin::joints {
namespace {

using solve::Method;

// A tenth as long where the sanitizers slow everything down.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr long kSteps = 100'000;
#else
constexpr long kSteps = 1'000'000;
#endif

solve::Ledger RunFourBar(Method method, double step, long steps, double tolerance) {
  const Mechanism four_bar = MakeMechanism(MakeFourBar(5));
  solve::SimulationOptions options;
  options.stepper.method = method;
  options.stepper.step = step;
  options.stepper.projection_tolerance = tolerance;
  options.duration = step * static_cast<double>(steps);
  options.sample_interval = options.duration;
  std::vector<double> y = four_bar.start;
  return Simulate(four_bar.system, options, y, [](double, auto, auto&) {});
}

// Runge-Kutta's energy error grows with time, at a rate that falls with the fifth power of the step
// per step, the fourth per second: a run of a tenth of the steps tells what the long one may have.
TEST(LongRun, ResidualsStayBelowTheToleranceAndEnergyDriftIsBoundedAndReported) {
  for (double tolerance : {1e-8, 1e-12}) {
    const long steps = tolerance == 1e-8 ? kSteps / 10 : kSteps;
    const solve::Ledger ledger = RunFourBar(Method::kRungeKutta4, 1e-3, steps, tolerance);
    EXPECT_GE(ledger.steps, steps);
    EXPECT_LE(ledger.largest_position_residual, tolerance);
    EXPECT_LE(ledger.largest_velocity_residual, tolerance);
    const double drift = std::abs(ledger.energy_end - ledger.energy_start);
    EXPECT_GE(ledger.largest_energy_error, drift * (1 - 1e-12));
    EXPECT_LT(ledger.largest_energy_error, 1e-5 * ledger.largest_kinetic);
    EXPECT_EQ(ledger.dissipated, 0);
    EXPECT_EQ(ledger.supplied, 0);
  }
}

TEST(LongRun, EnergyDriftFallsWithTheMethodsOrder) {
  for (Method method : {Method::kRungeKutta4, Method::kRosenbrock}) {
    const int order = method == Method::kRungeKutta4 ? 4 : 3;
    const solve::Ledger coarse = RunFourBar(method, 2e-3, 5000, 1e-12),
                        fine = RunFourBar(method, 1e-3, 10000, 1e-12);
    EXPECT_GT(std::log2(coarse.largest_energy_error / fine.largest_energy_error), order - 0.3);
  }
}

}  // namespace
}  // namespace kingpin::joints
