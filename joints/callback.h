#pragma once

#include <cmath>
#include <functional>

#include "joints/relative_motion.h"

/// Forces written by the user. Their power counts as supplied.
namespace kingpin::joints {

using mechanism::Dual8;
using mechanism::ForceContext;

/// Step of central differences: their error is least near the cube root of the rounding error.
inline constexpr double kDifferenceStep = 6e-6;

/// F(t, x, ẋ) by a function of doubles, its derivatives by central differences.
struct CallbackLaw {
  std::function<double(double time, double x, double rate)> force;

  double CalcForce(double time, double x, double rate) const { return force(time, x, rate); }
  Dual8 CalcForce(const Dual8& time, const Dual8& x, const Dual8& rate) const;
  mechanism::EnergyRates CalcEnergy(double time, double x, double rate) const {
    return {0, 0, force(time, x, rate) * rate};
  }
};

/// A wrench between two frames: `function(time, motion)` gives it on b, about b's origin, in the
/// axes of a. Function takes double and Dual8 (a templated call operator), so that derivatives are
/// exact; add it by System::Add(std::make_unique<ElementGroup<WrenchFunction<F>>>()).
template <class Function>
struct WrenchFunction {
  mechanism::Frame a, b;
  Function function;

  template <class S>
  void AddForces(const ForceContext<S>& context) const {
    const FramePair<S> pair(context.w, a, b);
    const math::Wrench<S> wrench =
        function(context.time, pair.CalcMotion(context.w, a.link, b.link));
    AddBetween(context.w, a.link, b.link, pair.p_B, pair.R_A * wrench.f, pair.R_A * wrench.t);
  }
  mechanism::EnergyRates CalcEnergy(const ForceContext<double>& context) const {
    const FramePair<double> pair(context.w, a, b);
    const RelativeMotion<double> motion = pair.CalcMotion(context.w, a.link, b.link);
    const math::Wrench<double> wrench = function(context.time, motion);
    return {0, 0, Dot(wrench.f, motion.v) + Dot(wrench.t, motion.w)};
  }
};

/// Makes a function of doubles one of Dual8, by central differences along each direction; rotations
/// are moved on the sphere, so that the function never sees a matrix that is not one.
struct DifferencedWrench {
  std::function<math::Wrench<double>(double time, const RelativeMotion<double>& motion)> function;

  math::Wrench<double> operator()(double time, const RelativeMotion<double>& motion) const {
    return function(time, motion);
  }
  math::Wrench<Dual8> operator()(const Dual8& time, const RelativeMotion<Dual8>& motion) const;
};

}  // namespace kingpin::joints
