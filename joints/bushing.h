#pragma once

#include <array>

#include "joints/rotation_vector.h"
#include "joints/scalar_law.h"

namespace kingpin::joints {

/// Six-axis bushing between frames A and B. Deflections x = (d, r): d the position of B's origin
/// from A's in the axes of A, r the rotation vector of R_AB (rotation_vector.h). Restoring
/// generalised forces
///
///   Q_i = k_i(x_i) + Σ_j K_ij x_j + preload_i + c_i(ẋ_i) + Σ_j C_ij ẋ_j
///
/// with ḋ the velocity of B's origin as seen from A, and ṙ from ω by the rotation vector's map.
/// Body b gets the force -Q_d at B's origin and the torque that does the work of -Q_r along ṙ; body
/// a the opposite wrench. Thus the power is -Q·ẋ exactly, the elastic part is the gradient of
///
///   U(x) = Σ ∫k_i + 1/2 xᵀK x + preload·x
///
/// at any deflection up to half a turn, and damping takes Σ c_i(ẋ_i) ẋ_i + ẋᵀC ẋ >= 0. A body that
/// is pushed and turned on one side carries the moment of the other: the origin of B is the point
/// where the bushing has no coupling.
struct Bushing {
  using Matrix6 = std::array<std::array<double, 6>, 6>;
  mechanism::Frame a, b;
  std::array<ScalarLaw, 6> stiffness, damping;
  bool coupled = false;  ///< K or C is not zero
  Matrix6 K{}, C{};      ///< symmetric, positive semi-definite
  std::array<double, 6> preload{};

  template <class S>
  void AddForces(const mechanism::ForceContext<S>& context) const;
  mechanism::EnergyRates CalcEnergy(const mechanism::ForceContext<double>& context) const;
};

extern template void Bushing::AddForces(const mechanism::ForceContext<double>&) const;
extern template void Bushing::AddForces(const mechanism::ForceContext<mechanism::Dual8>&) const;

}  // namespace kingpin::joints
