#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "joints/mechanism.h"

namespace kingpin::joints {

/// Motion of a frame, all in world axes; what is linear is of the frame's origin.
struct FrameMotion {
  Transform<double> X_WF;
  Vector3<double> v;      ///< velocity [m/s]
  Vector3<double> w;      ///< angular velocity [rad/s]
  Vector3<double> acc;    ///< second derivative of the position, without gravity [m/s²]
  Vector3<double> alpha;  ///< angular acceleration [rad/s²]
};

/// The dynamics of a mechanism's tree in one state: M v̇ + bias = τ. Closures, couplings, friction
/// and force elements play no part.
struct TreeEvaluation {
  Eigen::MatrixXd M;
  Eigen::VectorXd bias;    ///< Coriolis, centrifugal and gravity terms
  Eigen::VectorXd qdd;     ///< v̇ that the given τ causes
  Eigen::VectorXd tau;     ///< τ that the given v̇ needs
  double kinetic = 0;      ///< [J]
  double potential = 0;    ///< of gravity, zero at the world's origin [J]
  double mass = 0;         ///< of all links that move [kg]
  Vector3<double> centre;  ///< of this mass, in the world [m]; the origin when there is none
  std::vector<FrameMotion> frames;
};

/// Evaluates at (q, v): M and bias by the composite-rigid-body and Newton-Euler recursions, `qdd`
/// by the sparse factorisation, `tau` by the Newton-Euler recursion alone, so that the two can be
/// held against each other. What is fixed to the world has neither mass nor energy here.
///
/// The coordinates of a free joint are those of `mechanism::JointKind::kFree`: v̇ is the derivative
/// of the components of (linear, angular) velocity in the link's axes.
///
/// @param mechanism without rows (closures, couplings, motions)
/// @param frames where `FrameMotion`s are wanted, at v̇ = `acceleration`
/// @throws std::invalid_argument if the mechanism has rows
TreeEvaluation CalcTreeEvaluation(const Mechanism& mechanism, std::span<const double> q,
                                  std::span<const double> v, std::span<const double> force,
                                  std::span<const double> acceleration,
                                  std::span<const mechanism::Frame> frames);

}  // namespace kingpin::joints
