#pragma once

#include <span>
#include <vector>

#include "core/mechanism/system.h"

namespace kingpin::mechanism {

/// Energy of the whole system at an instant [J], [W].
struct Energy {
  double kinetic = 0;
  double potential = 0;   ///< of gravity (zero at the world's origin) and of all force elements
  double dissipated = 0;  ///< rate
  double supplied = 0;    ///< rate: by outside forces and by drives
};

/// One thread's evaluations of a system at states y = (q, v, states). Owns every scratch value;
/// nothing is allocated after construction on the regular path.
class Evaluator {
 public:
  explicit Evaluator(const System& system);

  const System& system() const { return system_; }

  /// Kinematics, closures and forces at (time, y), and the accelerations and reactions that follow.
  /// @param rate out: dy/dt
  /// @throws std::runtime_error if the constraints contradict each other there
  void CalcRates(double time, std::span<const double> y, std::span<double> rate);

  /// R of the last CalcRates, per row: on link a of the closure, in the row's direction [N, N m].
  std::span<const double> reactions() const { return reaction_; }
  std::span<const double> accelerations() const { return acceleration_; }
  const Workspace<double>& workspace() const { return w_; }

  /// Largest |Φ| [m or rad] and largest |Dᵀv - ṡ| [m/s or rad/s] at (time, y); redundant rows
  /// count, too.
  struct Residuals {
    double position = 0, velocity = 0;
  };
  Residuals CalcResiduals(double time, std::span<const double> y);

  /// Moves q, by the least kinetic-energy distance, until |Φ| <= tolerance, then v until |Dᵀv - ṡ|
  /// <= tolerance (in 1/s of the same), and brings quaternions back to unit length. Rows that are
  /// not active keep what they have.
  /// @throws std::runtime_error if that fails; the message names the worst row
  void Project(double time, std::span<double> y, double tolerance);

  /// At (time, y) after CalcRates there.
  Energy CalcEnergy(double time, std::span<const double> y);

 private:
  void UpdateKinematics(double time, std::span<const double> y);
  void UpdateDrives(double time);
  double CalcPositionResiduals(const double* q);  // into residual_
  double CalcVelocityResiduals(const double* v);  // into residual_
  int FindWorstRow() const;
  void SolveForCorrection();  // correction_ from residual_

  const System& system_;
  Workspace<double> w_;
  std::vector<double> drive_, drive_rate_, drive_acceleration_;
  std::vector<double> acceleration_, reaction_, residual_, correction_, none_;
};

}  // namespace kingpin::mechanism
