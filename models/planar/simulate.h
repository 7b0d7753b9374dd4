#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "models/planar/excitation.h"
#include "models/planar/parameters.h"

namespace kingpin::planar {

template <class S>
struct Dynamics;
template <class S>
struct Model;
template <class S>
struct State;

enum class Method {
  kFast,         ///< exponential Adams of seventh order (exponential_adams.h); the default
  kRungeKutta4,  ///< classical, fixed step: the paper's, and the reference of the fixed-step
                 ///< methods
};

struct SimulationOptions {
  double duration = 1.0;          ///< [s]
  double sample_interval = 1e-3;  ///< of the output [s]; the duration is a whole number of these
  Method method = Method::kFast;
  /// Largest step [s]; 0: 0.25 ms (fast), 10 µs (RK4, and what kFast leaves to RK4: at most that).
  double step = 0;
  /// Fast method: bound of its error estimate; the step is halved, at most six times, until it
  /// holds. See BatchOptions.
  double tolerance = 1.5e-4;
};

/// How a run of fixed steps was integrated.
struct IntegrationRecord {
  double step = 0;  ///< largest, after all halvings [s]
  long steps = 0;   ///< of the run that was kept; pieces between events count as one step
  /// Estimated relative error of the velocities and its bound; NaN without an estimate (RK4).
  double error_estimate = std::numeric_limits<double>::quiet_NaN();
  double error_bound = std::numeric_limits<double>::quiet_NaN();
};

/// Signals of one run at t_i = i · sample_interval, i = 0 ... duration / sample_interval, both ends
/// included. SI units.
struct History {
  std::vector<double> time;
  std::vector<double> q[5];               ///< x_s, y_s [m], ψ_s [rad], y [m], φ [rad]
  std::vector<double> v[5];               ///< their rates
  std::vector<double> a[5];               ///< their accelerations
  std::vector<double> rim_acceleration;   ///< φ̈ r_sw [m/s^2]
  std::vector<double> torsion_torque;     ///< of the column, elastic and damping [N m]
  std::vector<double> tie_rod_force;      ///< axial, tension positive [N]
  std::vector<double> rack_force;         ///< of the tie rod on the rack, along +y [N]
  std::vector<double> friction_force;     ///< on the rack, along +y [N]
  std::vector<double> assist_force;       ///< on the rack, along +y [N]
  std::vector<double> road_force;         ///< F_T [N]
  std::vector<double> kinetic_energy;     ///< [J]
  std::vector<double> potential_energy;   ///< [J]
  std::vector<double> dissipated_energy;  ///< by dampers and friction since the start [J]
  std::vector<double>
      supplied_energy;  ///< by road, assistance and lagged aligning torque since the start [J]
  IntegrationRecord integration;  ///< of Simulate
  std::size_t size() const { return time.size(); }

  /// One more sample: `now` and what `forces` gives there under the road force F_T, and the
  /// energies dissipated and supplied so far.
  void Append(double t, double force, const Model<double>& model, const State<double>& now,
              const Dynamics<double>& forces, double dissipated, double supplied);

  /// Largest |kinetic + potential + dissipated − supplied| over the largest |supplied|; rounding
  /// and the integration error are all that may remain (not for the one-way rod, which follows from
  /// no potential).
  double CalcEnergyResidual() const;
};

/// Runs the model from rest. Steps end at every sample and, with RK4, at every kink of the
/// excitation; between them they are equal and at most `options.step` long. Coulomb friction, stops
/// and free play are located as events to rounding; such runs, and the smoothed friction, are
/// always done with RK4.
/// Throws io::InputError for parameters or options that make no run (a step above 10 µs where kFast
/// leaves the run to RK4 is one), io::RunError for a state that diverges, with the time and the
/// coordinate, and for an error estimate that stays above its bound.
History Simulate(const Parameters<double>& parameters, const Excitation& excitation,
                 const SimulationOptions& options);

/// Number of sample intervals; throws io::InputError (keys `duration`, `sample_interval`, `step`)
/// for options that make no grid.
int CalcSampleIntervals(double duration, double sample_interval, double step);

/// Index of the first coordinate whose position or speed is not a number or beyond any use (1e3 m
/// or rad, 1e6 per second); −1 when there is none.
int FindDivergedCoordinate(const double* q, const double* v);

}  // namespace kingpin::planar
