#pragma once

#include <Eigen/Core>
#include <limits>

namespace kingpin::parameters {

/// One axis of a rubber or hydraulic bushing:
///
///     F = k d (1 + (|d|/d0)^4) + b ḋ,    b = (loss factor) k/(2π f)
///
/// F [N] is the force that resists the displacement d [m]. k is the static stiffness; rubber is
/// stiffer by the car's dynamic factor between 10 and 100 Hz. The loss factor is tan δ, measured
/// at the frequency f.
struct BushingAxis {
  double stiffness = 0.0;                                        ///< k [N/m]
  double progression = std::numeric_limits<double>::infinity();  ///< d0 [m]; infinite: linear
  double loss_factor = 0.0;                                      ///< tan δ [-]
  double loss_frequency = 15.0;                                  ///< f [Hz]
};

/// A bushing with its axes along the car's x, y, z in design position.
struct Bushing {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< centre, car frame [m]
  BushingAxis x, y, z;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< stiffness about x, y, z [N m/rad]
};

}  // namespace kingpin::parameters
