#pragma once

#include <Eigen/Dense>
#include <span>

#include "core/mechanism/system.h"

namespace kingpin::mechanism {

/// Exact derivatives of the accelerations and state rates, (q̈, ż)(q, v, z), by forward
/// differentiation, eight directions at a time. Columns: velocities directions of position (the
/// position moved at unit joint velocity, so that quaternions have three), velocities, states. Size
/// (velocities + states) x (2 velocities + states).
///
/// Rows that are active in `active` constrain.
class JacobianEvaluator {
 public:
  explicit JacobianEvaluator(const System& system);

  /// @param reactions unless null, the same derivatives of the reactions R, rows x columns; 0 for
  /// rows that are redundant or not active
  /// @returns whether there are any: in a singular position, where rows depend on each other, there
  /// are none
  bool Calc(double time, std::span<const double> y, std::span<const double> active,
            Eigen::Ref<Eigen::MatrixXd> jacobian, Eigen::MatrixXd* reactions = nullptr);

  int rows() const { return system_.model.velocities + system_.states; }
  int columns() const { return 2 * system_.model.velocities + system_.states; }

 private:
  static constexpr int kLanes = 8;
  void Assemble(double time, std::span<const double> y, int first);
  bool SolveDensely();

  const System& system_;
  Workspace<Dual8> w_;
  std::vector<Dual8> q_, v_, states_, state_rates_, drive_;
  std::vector<double> unit_, direction_;
};

}  // namespace kingpin::mechanism
