#pragma once

#include <functional>

#include "joints/relative_motion.h"

namespace kingpin::joints {

/// A force at the frame's origin and a torque, in world axes or in those of the frame, times
/// scale(t). It comes from outside: no reaction, all power supplied.
struct BodyForce {
  mechanism::Frame at;
  Vector3<double> force, torque;
  bool turns = false;  ///< with the frame
  std::function<double(double)> scale;

  template <class S>
  void AddForces(const mechanism::ForceContext<S>& context) const {
    auto& w = context.w;
    w.f[at.link] = w.f[at.link] + CalcWrench(context);
  }
  mechanism::EnergyRates CalcEnergy(const mechanism::ForceContext<double>& context) const {
    return {0, 0, Dot(context.w.V[at.link], CalcWrench(context))};
  }

 private:
  template <class S>
  math::Wrench<S> CalcWrench(const mechanism::ForceContext<S>& context) const {
    using math::Value;
    const auto& w = context.w;
    const S factor(scale ? scale(Value(context.time)) : 1.0);
    Vector3<S> f = factor * math::Convert<S>(force), t = factor * math::Convert<S>(torque);
    if (turns) {
      const Rotation<S> R = w.R[at.link] * math::Convert<S>(at.X_LF.R);
      f = R * f, t = R * t;
    }
    const Vector3<S> p = w.R[at.link] * math::Convert<S>(at.X_LF.p) + w.p[at.link];
    return {Cross(p, f) + t, f};
  }
};

}  // namespace kingpin::joints
