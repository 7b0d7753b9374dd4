#pragma once

#include "models/planar/rod_mode.h"

/// The fast method: exponential Adams-Bashforth-Moulton of seventh order with the rod mode as its
/// linear part, in the form predict - evaluate - correct - linearise. One evaluation of the forces
/// a step.
///
/// With Δ = g(predicted) − (extrapolated g) the corrector is the predictor plus fixed multiples of
/// Δ. The usual second evaluation, without which the order-seven pair is unstable at useful steps,
/// is replaced by g(predicted) plus the tangent of the forces times the correction; they differ by
/// the square of the correction (prototype: the same largest error of the measures, 5.5e-7 at
/// 0.25 ms; docs/decisions.md).
///
/// Error check: |Δ| is the seventh difference of g, and γ*_7 h |Δ| the local error of the corrector
/// in the velocity. Its sum over the run against the largest velocity is the estimate reported per
/// lane; an instability shows in it long before the state overflows.
namespace kingpin::planar {

inline constexpr int kAdamsOrder = 7;
/// |γ*_7| of the Adams-Moulton series.
inline constexpr double kAdamsErrorConstant = 275.0 / 24192.0;

template <class S>
struct AdamsWeights {
  double h;
  Weights<S, kAdamsOrder> predictor;  ///< of g_0, g_{−1}, ...
  double correct_q, correct_v;        ///< of h² Δ and h Δ
  S rod_correct_q, rod_correct_v;
};

template <class S>
void MakeAdamsWeights(const RodMode<S>& rod, double h, AdamsWeights<S>& w) {
  constexpr int n = kAdamsOrder;
  w.h = h;
  Response<S, n> half, full;
  Response<double, n> free;
  MakeRodResponse<S, n>(rod.mu * rod.stiffness * (h * h), rod.mu * rod.damping * h, half, full);
  MakeFreeResponse(1.0, free);
  // Lagrange polynomials on the nodes first, first − 1, ...; coefficient of θ^m times m!.
  const auto lagrange = [](int first, double(&coefficient)[n][n]) {
    for (int j = 0; j < n; ++j) {
      double p[n] = {1.0};
      double denominator = 1.0;
      int degree = 0;
      for (int i = 0; i < n; ++i) {
        if (i == j) continue;
        const double node = first - i;
        ++degree;
        for (int m = degree; m >= 0; --m) p[m] = (m > 0 ? p[m - 1] : 0.0) - node * p[m];
        denominator *= i - j;
      }
      double factorial = 1.0;
      for (int m = 0; m < n; ++m) {
        if (m > 0) factorial *= m;
        coefficient[j][m] = p[m] / denominator * factorial;
      }
    }
  };
  double coefficient[n][n];
  lagrange(0, coefficient);
  SetWeights(coefficient, 1.0, free, full, w.predictor);
  lagrange(1, coefficient);
  Weights<S, n> corrector;
  SetWeights(coefficient, 1.0, free, full, corrector);
  w.correct_q = corrector.q[0];
  w.correct_v = corrector.v[0];
  w.rod_correct_q = corrector.rod_q[0];
  w.rod_correct_v = corrector.rod_v[0];
}

/// The last kAdamsOrder remainders, newest first.
template <class S>
struct AdamsHistory {
  Remainder<S> ring[8];
  int head = 0;
  KINGPIN_INLINE Remainder<S>& get(int age) { return ring[(head + age) & 7]; }
  KINGPIN_INLINE Remainder<S>& Push() {
    head = (head - 1) & 7;
    return ring[head];
  }
};

/// What a step leaves for the samples, besides the state.
template <class S>
struct AdamsEnd {
  S rod_force;  ///< at the corrected state
  S rod_direction_y;
};

/// One step in place; `force` is the road force at its end. Adds |Δ| of every coordinate to
/// `error`.
template <class S, class F>
KINGPIN_INLINE void StepAdams(const Structure& st, const Constants<S>& k, const RodMode<S>& rod,
                              const AdamsWeights<S>& w, const F& force, AdamsHistory<S>& history,
                              State<S>& x, S* error, AdamsEnd<S>& end) {
  using math::Abs;
  constexpr int n = kAdamsOrder;
  // Extrapolation to θ = 1: (−1)^j C(7, j + 1).
  constexpr double kExtrapolate[n] = {7, -21, 35, -35, 21, -7, 1};
  const bool extra = st.has_extra_states();
  const double h = w.h;
  const double h2 = h * h;
  const Remainder<S>* r[n];
  for (int j = 0; j < n; ++j) r[j] = &history.get(j);

  State<S> p;
  UpdateState(rod, w.predictor, h, extra, x, r, p);
  Remainder<S> delta;  // g(predicted) − extrapolated g
  Dynamics<S> d;
  Tangent<S> tangent;
  CalcDynamics<true>(st, k, p, force, S(0.0), d, tangent);
  Remainder<S> g;
  SplitRemainder(rod, p, d, extra, g);
  for (int i = 0; i < kCoordinates; ++i) {
    S sum = g.g[i];
    for (int j = 0; j < n; ++j) sum = sum - r[j]->g[i] * kExtrapolate[j];
    delta.g[i] = sum;
    error[i] = error[i] + Abs(sum);
  }
  delta.projection =
      rod.d[0] * delta.g[0] + rod.d[1] * delta.g[1] + rod.d[2] * delta.g[2] + rod.d[3] * delta.g[3];

  // Correction.
  const S rod_q = w.rod_correct_q * delta.projection * h2;
  const S rod_v = w.rod_correct_v * delta.projection * h;
  S dq[kCoordinates], dv[kCoordinates];
  for (int i = 0; i < kCoordinates; ++i) {
    dq[i] = delta.g[i] * (w.correct_q * h2);
    dv[i] = delta.g[i] * (w.correct_v * h);
    if (i < 4) {
      dq[i] = dq[i] + rod.b_over_mu[i] * rod_q;
      dv[i] = dv[i] + rod.b_over_mu[i] * rod_v;
    }
    x.q[i] = p.q[i] + dq[i];
    x.v[i] = p.v[i] + dv[i];
  }

  // Change of the forces with the correction.
  const S &ex = d.rod_direction_x, &ey = d.rod_direction_y;
  S rod_q_change = ex * dq[0] + ey * dq[1] + tangent.rod_lever * dq[2];
  S rod_v_change = ex * dv[0] + ey * dv[1] + tangent.rod_lever * dv[2];
  if (st.two_way) {
    rod_q_change = rod_q_change - ey * dq[3];
    rod_v_change = rod_v_change - ey * dv[3];
  }
  const S rod_force = k.rod_stiffness * rod_q_change + k.rod_damping * rod_v_change;
  const auto& l = k.lateral;
  const S lateral =
      k.lateral_stiffness * (l.nx * dq[0] + l.ny * dq[1] + tangent.lateral_lever * dq[2]) +
      k.lateral_damping * (l.nx * dv[0] + l.ny * dv[1] + tangent.lateral_lever * dv[2]);
  const auto& o = k.longitudinal;
  const S longitudinal =
      tangent.longitudinal_stiffness *
          (o.nx * dq[0] + o.ny * dq[1] + tangent.longitudinal_lever * dq[2]) +
      k.longitudinal_damping * (o.nx * dv[0] + o.ny * dv[1] + tangent.longitudinal_lever * dv[2]);
  const S twist = dq[4] - k.gear_ratio * dq[3];
  const S bar = k.column_stiffness * twist;
  const S torque = bar + k.column_damping * (dv[4] - k.gear_ratio * dv[3]);
  S change[kCoordinates];
  change[0] = -(rod_force * ex) - lateral * l.nx - longitudinal * o.nx;
  change[1] = -(rod_force * ey) - lateral * l.ny - longitudinal * o.ny;
  change[2] = -(rod_force * tangent.rod_lever) - lateral * tangent.lateral_lever -
              longitudinal * tangent.longitudinal_lever;
  change[3] = rod_force * ey + k.gear_ratio * torque - k.rack_damping * dv[3];
  change[4] = -torque - k.hands_stiffness * dq[4] - k.hands_damping * dv[4];
  if (st.has_aligning && !st.has_aligning_lag) {
    change[2] = change[2] - k.aligning_stiffness * dq[2] - k.aligning_damping * dv[2];
  }
  if (st.assist.count > 0 && st.assist_lag == AssistLag::kNone) {
    change[3] = change[3] + tangent.assist_slope * bar;
  }
  if (extra) {
    S de[kExtraStates];
    for (int i = 0; i < kExtraStates; ++i) {
      S sum = g.extra[i];
      for (int j = 0; j < n; ++j) sum = sum - r[j]->extra[i] * kExtrapolate[j];
      de[i] = sum * (w.correct_v * h);
      x.extra[i] = p.extra[i] + de[i];
    }
    if (st.has_aligning_lag) {
      g.extra[kAligningState] =
          g.extra[kAligningState] + (dq[2] - de[kAligningState]) * k.aligning_rate;
      change[2] = change[2] - k.aligning_stiffness * de[kAligningState];
    }
    if (st.assist_lag == AssistLag::kFirstOrder) {
      g.extra[kAssistState] =
          g.extra[kAssistState] + (tangent.assist_slope * bar - de[kAssistState]) * k.assist_rate;
      change[3] = change[3] + de[kAssistState];
    } else if (st.assist_lag == AssistLag::kSecondOrder) {
      g.extra[kAssistState] = g.extra[kAssistState] + de[kAssistRateState];
      g.extra[kAssistRateState] =
          g.extra[kAssistRateState] +
          k.assist_frequency_squared * (tangent.assist_slope * bar - de[kAssistState]) -
          k.assist_two_zeta_omega * de[kAssistRateState];
      change[3] = change[3] + de[kAssistState];
    }
  }
  end.rod_force = d.rod_force + rod_force;
  end.rod_direction_y = ey;

  Dynamics<S> change_rates;
  for (int i = 0; i < kCoordinates; ++i) change_rates.a[i] = change[i] * k.inverse_mass[i];
  State<S> correction;
  for (int i = 0; i < kCoordinates; ++i) {
    correction.q[i] = dq[i];
    correction.v[i] = dv[i];
  }
  Remainder<S> dg;
  SplitRemainder(rod, correction, change_rates, false, dg);
  Remainder<S>& stored = history.Push();
  for (int i = 0; i < kCoordinates; ++i) stored.g[i] = g.g[i] + dg.g[i];
  stored.projection = g.projection + dg.projection;
  if (extra) {
    for (int i = 0; i < kExtraStates; ++i) stored.extra[i] = g.extra[i];
  }
}

}  // namespace kingpin::planar
