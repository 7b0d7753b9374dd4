#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "models/planar/parameters.h"

/// The planar model linearised at a state: ẋ = A x + B u, z = C x + D u (the paper's 2.5 to 2.7).
///
/// A, B, C, D are exact forward derivatives (`math::Dual`) of the force model that simulates, so
/// they carry every option that is smooth at the state: exact rod geometry, tangent of the
/// longitudinal support, assistance with its lag, aligning torque with its lag, hands, stops, the
/// smoothed friction law. Set-valued friction has no derivative: the rack slides without it, which
/// is said in `notes`. Inside its free play the rod carries nothing; the linear model is that of
/// the rod in contact, which is said in `notes`, too.
///
/// Deviations: x, u and z are deviations from the operating point (x_0, u_0, z_0); x_0 need not be
/// an equilibrium, `rate` holds ẋ there.
namespace kingpin::planar {

struct LinearModel {
  Eigen::MatrixXd a, b, c, d;
  std::vector<std::string> state_names, input_names, output_names;
  std::vector<std::string> state_units, input_units, output_units;
  /// Coordinates come first, then their velocities, then extra states.
  int coordinates = 5;
  std::vector<std::string> coordinate_names;
  std::vector<double> mass;  ///< diagonal of M, one per coordinate [kg or kg m²]
  Eigen::VectorXd state;     ///< x_0
  Eigen::VectorXd rate;      ///< ẋ at (x_0, u_0)
  std::vector<std::string> notes;
};

/// Where to linearise.
struct OperatingPoint {
  std::array<double, 5> position{};
  std::array<double, 5> velocity{};
  std::vector<double> extra;  ///< extra states in use; empty for their equilibrium at rest (zero)
  double road_force = 0.0;    ///< F_T [N]
};

/// Inputs: `road.force` F_T [N], `kingpin.moment` M_z on the carrier [N m].
/// Outputs: `tie_rod.force` [N], `steering.wheel.angle` [rad], `steering.wheel.rim_acceleration`
/// r_sw φ̈ [m/s^2], `steering.column.torque` [N m], `rack.travel` [m], `rack.force` F_R e_y [N].
/// @throws io::RunError when a derivative is not finite.
LinearModel MakeLinearModel(const Parameters<double>& parameters, const OperatingPoint& at = {});

/// The same with the steering wheel held by the driver: φ and φ̇ leave the states. The output for
/// the rim acceleration is then zero.
LinearModel HoldSteeringWheel(const LinearModel& model);

/// Mass, damping and stiffness read back from A: the lower blocks times −M.
Eigen::MatrixXd CalcStiffness(const LinearModel& model);
Eigen::MatrixXd CalcDamping(const LinearModel& model);

}  // namespace kingpin::planar
