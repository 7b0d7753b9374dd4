#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/solve/stepper.h"

namespace kingpin::solve {

struct SimulationOptions {
  StepperOptions stepper;
  double duration = 1;            ///< [s]
  double sample_interval = 1e-3;  ///< [s]; 0: every step
  /// Times at which a drive or a force has a kink: steps end there, so that no method steps over
  /// it.
  std::vector<double> kinks;
};

/// Dry friction that began to stick (mode 0) or to slide (±1, the way it slides).
struct FrictionEvent {
  double time = 0;
  int element = 0;  ///< of System::friction
  int mode = 0;
};

/// The books of a run.
struct Ledger {
  static constexpr size_t kMostEvents = 1000;

  double energy_start = 0, energy_end = 0;  ///< kinetic and potential [J]
  double dissipated = 0, supplied = 0;      ///< over the run [J]
  double largest_energy_error = 0;  ///< of |E - E_start - supplied + dissipated| at any step [J]
  double largest_kinetic = 0;       ///< to judge it by [J]
  /// About the world's origin, world axes: linear in f [N s], angular in t [N m s]. The impulse is
  /// that of all that acts from outside over the run: gravity, forces and supports of the world.
  math::Wrench<double> momentum_start, momentum_end, impulse;
  double largest_momentum_error = 0;          ///< of |p - p_start - impulse| at any step [N s]
  double largest_angular_momentum_error = 0;  ///< the same of the angular part [N m s]
  double largest_position_residual = 0;       ///< [m, rad]
  double largest_velocity_residual = 0;       ///< [m/s, rad/s]
  long steps = 0, jacobians = 0, switches = 0;
  std::vector<FrictionEvent> events;  ///< the first kMostEvents, those at the start among them
};

/// Called at t = 0 and at every sample, after CalcRates there.
using Observer =
    std::function<void(double time, std::span<const double> y, mechanism::Evaluator& evaluator)>;

/// Integrates y from t = 0 in place. Dry friction switches where its conditions change sign: a step
/// over such an instant is cut there (to 1e-12 of the step), under every method.
///
/// @throws std::runtime_error if the motion cannot be continued; the message says when and why.
/// What was observed before
///     stands.
Ledger Simulate(const mechanism::System& system, const SimulationOptions& options,
                std::span<double> y, const Observer& observe);

/// The same with the caller's ledger, whose energies, residuals and events are up to date whenever
/// `observe` is called, and after a run that failed.
void Simulate(const mechanism::System& system, const SimulationOptions& options,
              std::span<double> y, const Observer& observe, Ledger& ledger);

}  // namespace kingpin::solve
