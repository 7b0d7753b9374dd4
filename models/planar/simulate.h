#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "models/planar/excitation.h"
#include "models/planar/parameters.h"

namespace kingpin::planar {

enum class Method {
  kFast,         ///< exponential Adams of seventh order (exponential_adams.h); the default
  kRungeKutta4,  ///< classical, fixed step: the paper's, and the reference of the fixed-step
                 ///< methods
};

struct SimulationOptions {
  double duration = 1.0;          ///< [s]
  double sample_interval = 1e-3;  ///< of the output [s]; the duration is a whole number of these
  Method method = Method::kFast;
  double step = 0;  ///< largest step [s]; 0: 0.25 ms (fast), 10 µs (RK4)
  /// Fast method: bound of its error estimate; the step is halved until it holds. See BatchOptions.
  double tolerance = 1.5e-4;
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
  std::size_t size() const { return time.size(); }

  /// Largest |kinetic + potential + dissipated − supplied| over the largest |supplied|; rounding
  /// and the integration error are all that may remain (not for the one-way rod, which follows from
  /// no potential).
  double CalcEnergyResidual() const;
};

/// Runs the model from rest. Steps end at every sample and, with RK4, at every kink of the
/// excitation; between them they are equal and at most `options.step` long. Coulomb friction, stops
/// and free play are located as events to rounding; such runs, and the smoothed friction, are
/// always done with RK4.
/// Throws io::InputError for parameters or options that make no run, io::RunError for a state that
/// diverges, with the time and the coordinate.
History Simulate(const Parameters<double>& parameters, const Excitation& excitation,
                 const SimulationOptions& options);

/// Number of sample intervals; throws io::InputError (keys `duration`, `sample_interval`, `step`)
/// for options that make no grid.
int CalcSampleIntervals(double duration, double sample_interval, double step);

/// Index of the first coordinate whose position or speed is not a number or beyond any use (1e3 m
/// or rad, 1e6 per second); −1 when there is none.
int FindDivergedCoordinate(const double* q, const double* v);

}  // namespace kingpin::planar
