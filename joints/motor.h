#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/mechanism/system.h"

namespace kingpin::joints {

/// Motor (MotorDescription). All of its power is supplied from outside, also what it brakes.
struct MotorLaw {
  std::function<double(double)> force;
  mechanism::Drive target;
  double proportional = 0, derivative = 0;
  double limit = std::numeric_limits<double>::infinity();

  template <class S>
  S CalcForce(const S& time, const S& x, const S& rate) const {
    using math::Max;
    using math::Min;
    using math::Value;
    const double t = Value(time);
    S sum = S(force ? force(t) : 0.0);
    if (proportional != 0 || derivative != 0) {
      const std::array<double, 3> s = target ? target(t) : std::array<double, 3>{};
      sum += proportional * (s[0] - x) + derivative * (s[1] - rate);
    }
    // a limit must not make a force of what is not a number
    return std::isfinite(Value(sum)) ? Max(Min(sum, S(limit)), S(-limit)) : sum;
  }
  mechanism::EnergyRates CalcEnergy(double time, double x, double rate) const {
    return {0, 0, CalcForce(time, x, rate) * rate};
  }
};

}  // namespace kingpin::joints
