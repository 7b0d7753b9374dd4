#pragma once

#include <Eigen/Dense>
#include <complex>
#include <span>
#include <vector>

#include "core/mechanism/system.h"

namespace kingpin::solve {

/// ẋ = A x about a state of a constrained system, in independent coordinates: x = (positions,
/// velocities, states) with as many positions as the holonomic rows leave and as many velocities as
/// all active rows leave.
///
/// Directions of motion are bases of the constraints' null spaces, orthonormal in the mass matrix
/// (Tᵀ M T = 1): δq = T_q ξ, δv = T_v η + E ξ with Dᵀ E = -∂(Dᵀv)/∂q T_q and T_vᵀ M E = 0, so that
/// the velocities go on meeting the constraints as they turn. Exact derivatives, no differences.
/// Exact for states at rest and for steady motions along which the constraints keep their place in
/// the coordinates (a wheel's spin about its axis of symmetry); dry friction is left out.
struct Linearisation {
  Eigen::MatrixXd A;
  Eigen::MatrixXd position_basis;    ///< velocities x independent positions: δq directions per ξ
  Eigen::MatrixXd velocity_basis;    ///< velocities x independent velocities
  Eigen::MatrixXd velocity_inverse;  ///< T_vᵀ M: η of a δv
  // δ of each quantity per x = (ξ, η, states), all coordinates or rows:
  Eigen::MatrixXd displacement;  ///< δq along the velocity coordinates: [T_q, 0, 0]
  Eigen::MatrixXd rate;          ///< δv: [E, T_v, 0]
  Eigen::MatrixXd acceleration;  ///< δa
  Eigen::MatrixXd reaction;      ///< δR
  int positions = 0, velocities = 0, states = 0;
};

/// @param y a state that meets the constraints; it need not rest (steady motions linearise, too)
Linearisation Linearise(const mechanism::System& system, double time, std::span<const double> y);

/// The column of B that a generalised input has: x changes by this per unit of an input under which
/// the coordinates accelerate by `acceleration`.
Eigen::VectorXd MakeInputColumn(const Linearisation& linearisation,
                                const Eigen::Ref<const Eigen::VectorXd>& acceleration);

/// C (iω - A)⁻¹ B + D for one output and one input, per frequency [Hz]; A is not empty.
std::vector<std::complex<double>> CalcFrequencyResponse(const Eigen::MatrixXd& A,
                                                        const Eigen::VectorXd& B,
                                                        const Eigen::RowVectorXd& C, double D,
                                                        std::span<const double> frequencies);

/// An eigenvalue of A with its motion.
struct Mode {
  std::complex<double> eigenvalue;
  double frequency = 0;      ///< |λ|/2π for a pair, 0 for real ones [Hz]
  double damping_ratio = 0;  ///< -Re λ/|λ|
  Eigen::VectorXcd shape;    ///< per velocity coordinate, largest component 1
};

/// Modes of A: pairs once (positive imaginary part), by rising frequency, then real ones.
std::vector<Mode> CalcModes(const Linearisation& linearisation);

}  // namespace kingpin::solve
