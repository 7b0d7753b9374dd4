#pragma once

#include "models/planar/rod_mode.h"

/// The one-step method: Krogstad's exponential Runge-Kutta method of fourth order (J. Comput. Phys.
/// 203 (2005), 72-88) with the rod mode as its linear part. It starts the multistep method after
/// kinks of the excitation, and carries designs whose forces switch.
namespace kingpin::planar {

/// H: S, or double when all lanes take the same step.
template <class S, class H>
struct OneStepWeights {
  H h;
  Weights<S, 1> second;
  Weights<S, 2> third;
  Weights<S, 2> fourth;
  Weights<S, 4> last;
};

template <class S, class H>
void MakeOneStepWeights(const RodMode<S>& rod, const H& h, OneStepWeights<S, H>& w) {
  w.h = h;
  Response<S, 3> half, full;
  Response<double, 3> free_half, free_full;
  MakeRodResponse<S, 3>(rod.mu * rod.stiffness * (h * h), rod.mu * rod.damping * h, half, full);
  MakeFreeResponse(0.5, free_half);
  MakeFreeResponse(1.0, free_full);
  // hφ_{m+1}(h) acts as z_m(1); (h/2)φ_1(h/2) as z_0(1/2), hφ_2(h/2) as 4 z_1(1/2).
  SetWeights({{1, 0, 0}}, 0.5, free_half, half, w.second);
  SetWeights({{1, -4, 0}, {0, 4, 0}}, 0.5, free_half, half, w.third);
  SetWeights({{1, -2, 0}, {0, 2, 0}}, 1.0, free_full, full, w.fourth);
  SetWeights({{1, -3, 4}, {0, 2, -4}, {0, 2, -4}, {0, -1, 4}}, 1.0, free_full, full, w.last);
}

/// Forces and remainder at a state: one function for all stages, out of the way of the hot loops.
template <class S, class F>
[[gnu::noinline]] void EvaluateRemainder(const Structure& st, const Constants<S>& k,
                                         const RodMode<S>& rod, const State<S>& x, const F& force,
                                         const S& slip, Remainder<S>& r) {
  Dynamics<S> d;
  CalcDynamics(st, k, x, force, slip, d);
  SplitRemainder(rod, x, d, st.has_extra_states(), r);
}

/// One step in place. `f0`, `f1`, `f2`: road force at its beginning, middle and end.
template <class S, class H, class F>
[[gnu::noinline]] void StepOneStep(const Structure& st, const Constants<S>& k,
                                   const RodMode<S>& rod, const OneStepWeights<S, H>& w,
                                   const F& f0, const F& f1, const F& f2, const S& slip,
                                   State<S>& x) {
  const bool extra = st.has_extra_states();
  Remainder<S> r1, r2, r3, r4;
  State<S> at;
  EvaluateRemainder(st, k, rod, x, f0, slip, r1);
  const Remainder<S>* const all[] = {&r1, &r2, &r3, &r4};
  const Remainder<S>* const first_and_third[] = {&r1, &r3};
  UpdateState(rod, w.second, w.h, extra, x, all, at);
  EvaluateRemainder(st, k, rod, at, f1, slip, r2);
  UpdateState(rod, w.third, w.h, extra, x, all, at);
  EvaluateRemainder(st, k, rod, at, f1, slip, r3);
  UpdateState(rod, w.fourth, w.h, extra, x, first_and_third, at);
  EvaluateRemainder(st, k, rod, at, f2, slip, r4);
  UpdateState(rod, w.last, w.h, extra, x, all, x);
}

}  // namespace kingpin::planar
