#pragma once

#include "joints/scalar_law.h"

namespace kingpin::joints {

/// Spring and damper side by side: F = -(k(x - free) + preload + d(ẋ)). Potential
/// ∫₀^(x - free) k + preload (x - free).
struct SpringLaw {
  ScalarLaw stiffness, damping;
  double free = 0, preload = 0;

  template <class S>
  S CalcForce(const S& /*time*/, const S& x, const S& rate) const {
    return -(stiffness(x - free) + preload + damping(rate));
  }
  mechanism::EnergyRates CalcEnergy(double /*time*/, double x, double rate) const {
    return {stiffness.CalcIntegral(x - free) + preload * (x - free), damping(rate) * rate, 0};
  }
};

}  // namespace kingpin::joints
