#pragma once

#include <type_traits>

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
  // Of the predictor: of g_0, g_{−1}, ... in q and v; of their projections, and of (dᵀq, dᵀv),
  // along b/μ.
  double q[kAdamsOrder], v[kAdamsOrder];
  S rod_q[kAdamsOrder], rod_v[kAdamsOrder];
  S e[2][2];
  // Of the correction: of Δ, and of its projection.
  double correct_q, correct_v;
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
  Weights<S, n> predictor;
  SetWeights(coefficient, 1.0, free, full, predictor);
  const double h2 = h * h;
  for (int j = 0; j < n; ++j) {
    w.q[j] = predictor.q[j] * h2;
    w.v[j] = predictor.v[j] * h;
    w.rod_q[j] = predictor.rod_q[j] * h2;
    w.rod_v[j] = predictor.rod_v[j] * h;
  }
  w.e[0][0] = predictor.e[0][0];
  w.e[0][1] = predictor.e[0][1] * h;
  w.e[1][0] = predictor.e[1][0] * (1.0 / h);
  w.e[1][1] = predictor.e[1][1];
  lagrange(1, coefficient);
  Weights<S, n> corrector;
  SetWeights(coefficient, 1.0, free, full, corrector);
  w.correct_q = corrector.q[0] * h2;
  w.correct_v = corrector.v[0] * h;
  w.rod_correct_q = corrector.rod_q[0] * h2;
  w.rod_correct_v = corrector.rod_v[0] * h;
}

/// The last kAdamsOrder remainders, newest first.
template <class S>
struct AdamsHistory {
  Remainder<S> ring[8];
  int head = 0;
  // dᵀq and dᵀv of the state that the last step of this method ended in.
  S rod_q, rod_v;
  bool rod_known = false;
  KINGPIN_INLINE Remainder<S>& get(int age) { return ring[(head + age) & 7]; }
  KINGPIN_INLINE Remainder<S>& Push() {
    head = (head - 1) & 7;
    rod_known = false;
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
template <class St, class S, class F, class Curves>
KINGPIN_INLINE void StepAdams(const St& st, const Constants<S>& k, const RodMode<S>& rod,
                              const AdamsWeights<S>& w, const F& force, Curves& curves,
                              AdamsHistory<S>& history, State<S>& x, S* error, AdamsEnd<S>& end) {
  using math::Abs;
  constexpr int n = kAdamsOrder;
  // Extrapolation to θ = 1: (−1)^j C(7, j + 1).
  constexpr double kExtrapolate[n] = {7, -21, 35, -35, 21, -7, 1};
  const bool extra = st.has_extra_states();
  const double h = w.h;
  const Remainder<S>* r[n];
  for (int j = 0; j < n; ++j) r[j] = &history.get(j);
  const auto project = [&](const S* a) __attribute__((always_inline)) {
    return rod.d[0] * a[0] + rod.d[1] * a[1] + rod.d[2] * a[2] + rod.d[3] * a[3];
  };
  if (!history.rod_known) {
    history.rod_q = project(x.q);
    history.rod_v = project(x.v);
  }

  // Predictor, and what the remainders extrapolate to. One pass through the history, the newest
  // remainder last: it is the one that has just been computed.
  State<S> p;
  S extrapolated[kCoordinates];
  S rod_q = w.e[0][0] * history.rod_q + w.e[0][1] * history.rod_v;
  S rod_v = w.e[1][0] * history.rod_q + w.e[1][1] * history.rod_v;
  for (int i = 0; i < kCoordinates; ++i) {
    p.q[i] = x.q[i] + x.v[i] * h;
    p.v[i] = x.v[i];
  }
  // All coordinates at once as far as registers go; duals take two for each number.
  using math::Value;
  using V = decltype(Value(S{}));
  constexpr int kGroup = std::is_same_v<V, S> ? kCoordinates : 1;
  for (int begin = 0; begin < kCoordinates; begin += kGroup) {
    for (int j = n - 1; j >= 0; --j) {
      for (int i = begin; i < begin + kGroup && i < kCoordinates; ++i) {
        const S& g = r[j]->g[i];
        p.q[i] = p.q[i] + g * w.q[j];
        p.v[i] = p.v[i] + g * w.v[j];
        extrapolated[i] = j == n - 1 ? g * kExtrapolate[j] : extrapolated[i] + g * kExtrapolate[j];
      }
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    rod_q = rod_q + w.rod_q[j] * r[j]->projection;
    rod_v = rod_v + w.rod_v[j] * r[j]->projection;
  }
  for (int i = 0; i < 4; ++i) {
    p.q[i] = p.q[i] + rod.b_over_mu[i] * rod_q;
    p.v[i] = p.v[i] + rod.b_over_mu[i] * rod_v;
  }
  for (int i = 0; i < kExtraStates; ++i) {
    p.extra[i] = x.extra[i];
    if (!extra) continue;
    for (int j = 0; j < n; ++j) p.extra[i] = p.extra[i] + r[j]->extra[i] * w.v[j];
  }

  Dynamics<S> d;
  Tangent<S> tangent;
  CalcDynamics<true>(st, k, p, force, S(0.0), curves, d, tangent);
  const S p_rod_q = project(p.q);
  const S p_rod_v = project(p.v);
  const S pull = rod.stiffness * p_rod_q + rod.damping * p_rod_v;
  Remainder<S> g;  // of the predicted state, then of the corrected one
  S delta[kCoordinates];
  for (int i = 0; i < kCoordinates; ++i) {
    g.g[i] = i < 4 ? d.a[i] + rod.b[i] * pull : d.a[i];
    delta[i] = g.g[i] - extrapolated[i];
    error[i] = error[i] + Abs(delta[i]);
  }
  if (extra) {
    for (int i = 0; i < kExtraStates; ++i) g.extra[i] = d.extra_rate[i];
  }

  // Correction. Its projections need no sums, as dᵀb = μ.
  const S delta_projection = project(delta);
  rod_q = w.rod_correct_q * delta_projection;
  rod_v = w.rod_correct_v * delta_projection;
  S dq[kCoordinates], dv[kCoordinates];
  for (int i = 0; i < kCoordinates; ++i) {
    dq[i] = delta[i] * w.correct_q;
    dv[i] = delta[i] * w.correct_v;
    if (i < 4) {
      dq[i] = dq[i] + rod.b_over_mu[i] * rod_q;
      dv[i] = dv[i] + rod.b_over_mu[i] * rod_v;
    }
    x.q[i] = p.q[i] + dq[i];
    x.v[i] = p.v[i] + dv[i];
  }
  rod_q = rod_q + delta_projection * w.correct_q;
  rod_v = rod_v + delta_projection * w.correct_v;
  const S pull_change = rod.stiffness * rod_q + rod.damping * rod_v;

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
  S longitudinal = tangent.longitudinal_stiffness *
                   (o.nx * dq[0] + o.ny * dq[1] + tangent.longitudinal_lever * dq[2]);
  if (st.has_own_dampers()) {
    longitudinal = longitudinal + k.longitudinal_damping * (o.nx * dv[0] + o.ny * dv[1] +
                                                            tangent.longitudinal_lever * dv[2]);
  }
  const S twist = dq[4] - k.gear_ratio * dq[3];
  const S bar = k.column_stiffness * twist;
  const S torque = bar + k.column_damping * (dv[4] - k.gear_ratio * dv[3]);
  S change[kCoordinates];  // of the resisting forces
  change[0] = rod_force * ex + lateral * l.nx + longitudinal * o.nx;
  change[1] = rod_force * ey + lateral * l.ny + longitudinal * o.ny;
  change[2] = rod_force * tangent.rod_lever + lateral * tangent.lateral_lever +
              longitudinal * tangent.longitudinal_lever;
  change[3] = -(rod_force * ey) - k.gear_ratio * torque;
  change[4] = torque;
  if (st.has_own_dampers()) change[3] = change[3] + k.rack_damping * dv[3];
  if (st.has_hands()) {
    change[4] = change[4] + k.hands_stiffness * dq[4] + k.hands_damping * dv[4];
  }
  if (st.has_aligning && !st.has_aligning_lag) {
    change[2] = change[2] + k.aligning_stiffness * dq[2] + k.aligning_damping * dv[2];
  }
  if (st.has_assist() && st.assist_lag == AssistLag::kNone) {
    change[3] = change[3] - tangent.assist_slope * bar;
  }
  if (extra) {
    S de[kExtraStates];
    for (int i = 0; i < kExtraStates; ++i) {
      S sum = g.extra[i];
      for (int j = 0; j < n; ++j) sum = sum - r[j]->extra[i] * kExtrapolate[j];
      de[i] = sum * w.correct_v;
      x.extra[i] = p.extra[i] + de[i];
    }
    if (st.has_aligning_lag) {
      g.extra[kAligningState] =
          g.extra[kAligningState] + (dq[2] - de[kAligningState]) * k.aligning_rate;
      change[2] = change[2] + k.aligning_stiffness * de[kAligningState];
    }
    if (st.assist_lag == AssistLag::kFirstOrder) {
      g.extra[kAssistState] =
          g.extra[kAssistState] + (tangent.assist_slope * bar - de[kAssistState]) * k.assist_rate;
      change[3] = change[3] - de[kAssistState];
    } else if (st.assist_lag == AssistLag::kSecondOrder) {
      g.extra[kAssistState] = g.extra[kAssistState] + de[kAssistRateState];
      g.extra[kAssistRateState] =
          g.extra[kAssistRateState] +
          k.assist_frequency_squared * (tangent.assist_slope * bar - de[kAssistState]) -
          k.assist_two_zeta_omega * de[kAssistRateState];
      change[3] = change[3] - de[kAssistState];
    }
  }
  end.rod_force = d.rod_force + rod_force;
  end.rod_direction_y = ey;

  Remainder<S>& stored = history.Push();
  for (int i = 0; i < kCoordinates; ++i) {
    g.g[i] = g.g[i] - change[i] * k.inverse_mass[i];
    if (i < 4) g.g[i] = g.g[i] + rod.b[i] * pull_change;
    stored.g[i] = g.g[i];
  }
  stored.projection = project(g.g);
  history.rod_q = p_rod_q + rod_q;
  history.rod_v = p_rod_v + rod_v;
  history.rod_known = true;
  if (extra) {
    for (int i = 0; i < kExtraStates; ++i) stored.extra[i] = g.extra[i];
  }
}

}  // namespace kingpin::planar
