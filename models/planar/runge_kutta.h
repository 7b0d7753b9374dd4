#pragma once

#include "models/planar/planar_forces.h"

namespace kingpin::planar {

/// Work done since the start [J]: Ẇ = power, integrated with the same weights as the state.
template <class S>
struct Ledger {
  S dissipated{};
  S supplied{};
};

/// The numbers of a step of length h: c_i h/m and so on, so that the forces need not be divided by
/// the masses.
template <class S>
struct RungeKuttaWeights {
  S h, half_h, sixth_h;
  S half[kCoordinates];          ///< h/2 m⁻¹
  S full[kCoordinates];          ///< h m⁻¹
  S sixth[kCoordinates];         ///< h/6 m⁻¹
  S sixth_square[kCoordinates];  ///< h²/6 m⁻¹
};

template <class S>
KINGPIN_INLINE void MakeRungeKuttaWeights(const Constants<S>& k, const S& h,
                                          RungeKuttaWeights<S>& w) {
  w.h = h;
  w.half_h = h * 0.5;
  w.sixth_h = h * (1.0 / 6.0);
  for (int i = 0; i < kCoordinates; ++i) {
    w.half[i] = w.half_h * k.inverse_mass[i];
    w.full[i] = h * k.inverse_mass[i];
    w.sixth[i] = w.sixth_h * k.inverse_mass[i];
    w.sixth_square[i] = h * w.sixth[i];
  }
}

/// One step of the classical fourth-order Runge-Kutta method (the paper's) from `x`, in place,
/// written for q̈ = a(q, q̇): the rates of q at the stages are the stages' velocities, so that
///
///   q_2 = q + h/2 q̇,  q_3 = q + h/2 q̇_2,  q_4 = q + h q̇_3,   q̇_{2,3,4} = q̇ + (h/2, h/2, h)
///   a_{1,2,3}, q ← q + h q̇ + h²/6 (a_1 + a_2 + a_3),  q̇ ← q̇ + h/6 (a_1 + 2 a_2 + 2 a_3 + a_4),
///
/// which is the same formula with nearly half the operations.
/// `evaluate(state, c, out)` gives the forces at a stage; c = 0, 1, 2 stands for the beginning, the
/// middle and the end of the step.
template <bool kWithLedger, class S, class Evaluate>
KINGPIN_INLINE void StepRungeKutta4(const RungeKuttaWeights<S>& w, bool has_extra,
                                    const Evaluate& evaluate, State<S>& x, Ledger<S>& ledger) {
  State<S> at;
  Dynamics<S> d;
  S inner[kCoordinates], outer[kCoordinates];
  S extra[kExtraStates];  // Σ b_i rates of the extra states

  const auto note = [&](int stage) {
    const bool middle = stage == 1 || stage == 2;
    if (kWithLedger) {
      const S weight = middle ? 2.0 * w.sixth_h : w.sixth_h;
      ledger.dissipated = ledger.dissipated + weight * d.dissipated_power;
      ledger.supplied = ledger.supplied + weight * d.supplied_power;
    }
    if (has_extra) {
      const S& shift = stage == 2 ? w.h : w.half_h;
      for (int i = 0; i < kExtraStates; ++i) {
        const S rate = middle ? 2.0 * d.extra_rate[i] : d.extra_rate[i];
        extra[i] = stage == 0 ? rate : extra[i] + rate;
        at.extra[i] = x.extra[i] + shift * d.extra_rate[i];
      }
    } else {
      for (int i = 0; i < kExtraStates; ++i) at.extra[i] = x.extra[i];
    }
  };

  evaluate(x, 0, d);
  note(0);
  for (int i = 0; i < kCoordinates; ++i) {
    outer[i] = d.resistance[i];
    at.q[i] = x.q[i] + w.half_h * x.v[i];
    at.v[i] = x.v[i] - w.half[i] * d.resistance[i];
  }
  evaluate(at, 1, d);
  note(1);
  for (int i = 0; i < kCoordinates; ++i) {
    inner[i] = d.resistance[i];
    at.q[i] = x.q[i] + w.half_h * at.v[i];
    at.v[i] = x.v[i] - w.half[i] * d.resistance[i];
  }
  evaluate(at, 1, d);
  note(2);
  for (int i = 0; i < kCoordinates; ++i) {
    inner[i] = inner[i] + d.resistance[i];
    outer[i] = outer[i] + inner[i];  // of stages 1, 2, 3
    at.q[i] = x.q[i] + w.h * at.v[i];
    at.v[i] = x.v[i] - w.full[i] * d.resistance[i];
    x.q[i] = (x.q[i] + w.h * x.v[i]) - w.sixth_square[i] * outer[i];
  }
  evaluate(at, 2, d);
  note(3);
  for (int i = 0; i < kCoordinates; ++i) {
    x.v[i] = x.v[i] - w.sixth[i] * (outer[i] + (inner[i] + d.resistance[i]));
  }
  if (has_extra) {
    for (int i = 0; i < kExtraStates; ++i) x.extra[i] = x.extra[i] + w.sixth_h * extra[i];
  }
}

/// Forces at a stage, of any structure: one function for all stages.
template <class S, class F, class Curves>
[[gnu::noinline]] void EvaluateStage(const Structure& st, const Constants<S>& k, const State<S>& x,
                                     const F& force, const S& slip, Curves& curves,
                                     Dynamics<S>& d) {
  Tangent<S> unused;
  CalcDynamics<false>(st, k, x, force, slip, curves, d, unused);
}

/// The same of any structure. `f0`, `f1`, `f2`: road force at the beginning, the middle and the end
/// of the step. F: S, or double when all lanes have the same road force.
template <bool kWithLedger, class S, class F>
KINGPIN_INLINE void StepRungeKutta4(const Structure& st, const Constants<S>& k, const S& h,
                                    const F& f0, const F& f1, const F& f2, const S& slip,
                                    State<S>& x, Ledger<S>& ledger) {
  RungeKuttaWeights<S> w;
  MakeRungeKuttaWeights(k, h, w);
  const auto evaluate = [&](const State<S>& at, int c, Dynamics<S>& d) {
    SegmentCurves<S> curves;
    EvaluateStage(st, k, at, c == 0 ? f0 : c == 1 ? f1 : f2, slip, curves, d);
  };
  StepRungeKutta4<kWithLedger>(w, st.has_extra_states(), evaluate, x, ledger);
}

}  // namespace kingpin::planar
