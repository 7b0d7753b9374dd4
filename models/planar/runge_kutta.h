#pragma once

#include "models/planar/planar_forces.h"

namespace kingpin::planar {

/// Work done since the start [J]: Ẇ = power, integrated with the same weights as the state.
template <class S>
struct Ledger {
  S dissipated{};
  S supplied{};
};

/// One step of the classical fourth-order Runge-Kutta method (the paper's) from `x`, in place.
/// `f0`, `f1`, `f2`: road force at the beginning, the middle and the end of the step.
/// F: S, or double when all lanes have the same road force.
template <bool kWithLedger, class S, class F>
KINGPIN_INLINE void StepRungeKutta4(const Structure& st, const Constants<S>& k, const S& h,
                                    const F& f0, const F& f1, const F& f2, const S& slip,
                                    State<S>& x, Ledger<S>& ledger) {
  const S half = 0.5 * h;
  const S sixth = h * (1.0 / 6.0);
  State<S> at = x;
  State<S> sum = x;
  Dynamics<S> d;
  // sum += weight · rates(at); at = x + shift · rates(at)
  const auto stage = [&](const F& force, const S& weight, const S& shift, bool last) {
    CalcDynamics(st, k, at, force, slip, d);
    for (int i = 0; i < kCoordinates; ++i) {
      sum.q[i] = sum.q[i] + weight * at.v[i];
      sum.v[i] = sum.v[i] + weight * d.a[i];
    }
    if (kWithLedger) {
      ledger.dissipated = ledger.dissipated + weight * d.dissipated_power;
      ledger.supplied = ledger.supplied + weight * d.supplied_power;
    }
    if (st.has_extra_states()) {
      for (int i = 0; i < kExtraStates; ++i) {
        sum.extra[i] = sum.extra[i] + weight * d.extra_rate[i];
        at.extra[i] = x.extra[i] + shift * d.extra_rate[i];
      }
    }
    if (last) return;
    for (int i = 0; i < kCoordinates; ++i) {
      at.q[i] = x.q[i] + shift * at.v[i];
      at.v[i] = x.v[i] + shift * d.a[i];
    }
  };
  const S third = h * (1.0 / 3.0);
  // A loop, so that the forces are compiled once.
  for (int i = 0; i < 4; ++i) {
    const bool outer = i == 0 || i == 3;
    stage(i == 0 ? f0 : i == 3 ? f2 : f1, outer ? sixth : third, i < 2 ? half : h, i == 3);
  }
  x = sum;
}

}  // namespace kingpin::planar
