#pragma once

#include "core/math/elementary.h"
#include "joints/scalar_law.h"

namespace kingpin::joints {

/// One-sided stop (StopDescription). Its force f(δ) has the potential ∫f; the damping part
/// F - f(δ) always takes energy: it has the sign of δ̇, and where F is cut off at zero,
/// F - f = -f < 0 only while δ̇ < 0.
struct StopLaw {
  double sign = 1;   ///< +1: acts above the limit
  double limit = 0;  ///< x at contact
  ScalarLaw stiffness;
  double coefficient = 0, exponent = 1;  ///< in use if the exponent is not 1
  double damping = 0, depth = 1e-3;

  template <class S>
  S CalcForce(const S& /*time*/, const S& x, const S& rate) const {
    using math::Max;
    const S delta = Max(sign * (x - limit), S(0.0));
    return -sign * CalcPush(delta, S(sign * rate));
  }
  mechanism::EnergyRates CalcEnergy(double /*time*/, double x, double rate) const {
    const double delta = std::max(sign * (x - limit), 0.0);
    const double elastic = CalcElastic(delta);
    const double potential = exponent == 1
                                 ? stiffness.CalcIntegral(delta)
                                 : coefficient * math::Power(delta, exponent + 1) / (exponent + 1);
    return {potential, (CalcPush(delta, sign * rate) - elastic) * (sign * rate), 0};
  }

 private:
  template <class S>
  S CalcElastic(const S& delta) const {
    return exponent == 1 ? stiffness(delta) : S(coefficient) * math::Power(delta, exponent);
  }
  template <class S>
  S CalcPush(const S& delta, const S& rate) const {
    using math::Max;
    using math::Min;
    const S t = Min(delta * (1 / depth), S(1.0));
    const S smooth = t * t * (3.0 - 2.0 * t);
    return Max(CalcElastic(delta) + damping * smooth * rate, S(0.0));
  }
};

}  // namespace kingpin::joints
