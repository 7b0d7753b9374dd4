#pragma once

#include "core/math/scalar.h"
#include "models/planar/planar_model.h"

/// Forces and accelerations of the planar model, written once for every scalar.
///
/// All elastic forces are −∂V/∂q of one potential and all damping forces −∂D/∂q̇ of one dissipation
/// function:
///
///   V = ½ c_R δ_R² + ½ c_L d_L² + ∫S_N(d_N) + ½ c_k θ² (+ stops) + ½ k_ψ ψ² + ½ k_h φ²
///   D = ½ η c_R l̇² + ½ η c_L ḋ_L² + ½ b_N ḋ_N² + ½ η c_k θ̇² + ½ η k_ψ ψ̇² + ½ b_R ẏ² + ½ b_h φ̇²
///
/// with the exact rotation Rot(ψ) of the carrier, the rod's elongation δ_R = |outer − inner| − l_0
/// (tension positive), the twist θ = φ − i_U y, d_L and d_N along fixed directions. Mass matrix
/// diag(m_s, m_s, I_s, m_R, I_sw). Added to these: the road force (−F_T, −ρ F_T) at Rot(ψ) (x_F,
/// y_F); the assistance F_A = sign(M) f(|M|), M = c_k θ, on the rack; rack friction.
///
/// Options:
/// - one-way rod (`two_way = false`, the literal form of the paper): δ_R ignores the rack, F e_y
/// still pushes it. Not derived
///   from a potential, so its energy balance does not close.
/// - free play g: δ_R is replaced by its excess beyond ±g/2, and the rod's damper acts only there.
/// - stops: beyond |θ| = θ_s the elastic torque grows with the stop's stiffness; the assistance
/// still follows c_k θ.
/// - lagged aligning torque −k_ψ z, ż = (ψ − z) V/σ: not conservative, its work is counted as the
/// tyre's.
/// - assistance lag: Ḟ = (F_A − F)/τ, or F̈ = ω² (F_A − F) − 2 ζ ω Ḟ.
/// - friction limit μ (|F_R e_x| + preload) + constant; smoothed −limit v/√(v² + v_s²), or
/// set-valued with the
///   direction given by the caller (which locates the events).
///
/// Source: Szczotka 2011, section 2, corrected; docs/theory/planar-model.md.
namespace kingpin::planar {

/// Order of the extra states.
enum ExtraState { kAligningState, kAssistState, kAssistRateState, kExtraStates };

template <class S>
struct State {
  S q[kCoordinates];
  S v[kCoordinates];
  S extra[kExtraStates];  ///< lagged yaw [rad], lagged assistance [N], its rate [N/s]
};

/// What Coulomb friction does at the moment; not used by the other laws.
enum class FrictionMode { kSlip, kStick };

template <class S>
struct Dynamics {
  S resistance[kCoordinates];  ///< minus the sum of all forces: m a = −resistance [N], [N m]
  S a[kCoordinates];
  S extra_rate[kExtraStates];
  S rod_force;        ///< axial, tension positive [N]
  S rod_rate;         ///< l̇ [m/s]
  S rod_direction_x;  ///< from the rack to the carrier
  S rod_direction_y;
  S rack_rod_force;    ///< of the rod on the rack, along +y [N]
  S torsion_torque;    ///< of the column, elastic and damping [N m]; + turns the rack to the left
  S assist_force;      ///< on the rack, along +y [N]
  S friction_force;    ///< on the rack, along +y [N]
  S friction_limit;    ///< [N]
  S dissipated_power;  ///< by dampers and friction, never negative [W]
  S supplied_power;    ///< by the road, the assistance and a lagged aligning torque [W]
};

/// What the change of the forces with a small change of the state needs, besides constants.
template <class S>
struct Tangent {
  S rod_lever;               ///< of the rod about the carrier's centre of mass [m]
  S lateral_lever;           ///< [m]
  S longitudinal_lever;      ///< [m]
  S longitudinal_stiffness;  ///< dS_N/dd [N/m]
  S assist_slope;            ///< df/d|M| [N/(N m)]
};

/// Whether a road force is zero for all lanes, as most of a run's is. Not looked at lane by lane.
KINGPIN_INLINE bool IsZero(double force) { return force == 0.0; }
template <class F>
KINGPIN_INLINE bool IsZero(const F&) {
  return false;
}

/// The two characteristics, evaluated from all their segments.
template <class S>
struct SegmentCurves {
  template <bool kWithSlope, class St>
  KINGPIN_INLINE S EvaluateLongitudinal(const St& st, const Constants<S>& k, const S& d,
                                        S& slope) const {
    return math::EvaluateSpline<kWithSlope>(st.longitudinal, k.longitudinal_force, d, slope);
  }
  template <bool kWithSlope, class St>
  KINGPIN_INLINE S EvaluateAssist(const St& st, const Constants<S>& k, const S& m, S& slope) const {
    return math::EvaluateSpline<kWithSlope>(st.assist, k.assist_force, m, slope);
  }
};

/// The same, remembering on which pieces they were last found: for runs of packs, which evaluate
/// them at arguments that move little.
template <class S, int kLanes>
struct PieceCurves {
  math::SplinePiece<S> longitudinal, assist;

  template <bool kWithSlope, class St>
  KINGPIN_INLINE S EvaluateLongitudinal(const St& st, const Constants<S>& k, const S& d, S& slope) {
    return math::EvaluatePiece<kLanes, kWithSlope>(st.longitudinal, k.longitudinal_force, d,
                                                   longitudinal, slope);
  }
  template <bool kWithSlope, class St>
  KINGPIN_INLINE S EvaluateAssist(const St& st, const Constants<S>& k, const S& m, S& slope) {
    return math::EvaluatePiece<kLanes, kWithSlope>(st.assist, k.assist_force, m, assist, slope);
  }
};

/// Accelerations, rates of the extra states and loads at (x, F_T).
/// `slip` (Coulomb only): the sign of the sliding speed, lane by lane; 0 means that the rack
/// sticks: its acceleration is zero and friction_force is the reaction that this takes, which the
/// caller compares with friction_limit.
/// F: S, or double when all lanes have the same road force. St: Structure or PlainStructure;
/// Curves: SegmentCurves or PieceCurves.
template <bool kWithTangent, class St, class S, class F, class Curves>
KINGPIN_INLINE void CalcDynamics(const St& st, const Constants<S>& k, const State<S>& x,
                                 const F& road_force, const S& slip, Curves& curves,
                                 Dynamics<S>& out, Tangent<S>& tangent) {
  using math::Abs;
  using math::InverseSqrtNearOne;
  using math::Max;
  using math::Min;
  using math::Select;
  using math::SinCosMinusOne;
  using math::Sqrt;
  const S zero(0.0);
  const S &dx = x.q[0], &dy = x.q[1], &psi = x.q[2], &rack = x.q[3], &phi = x.q[4];
  const S &vx = x.v[0], &vy = x.v[1], &w = x.v[2], &rack_v = x.v[3], &phi_v = x.v[4];
  S s, c1;
  SinCosMinusOne(psi, s, c1);

  // Tie rod.
  const S turn_x = c1 * k.outer_x - s * k.outer_y;
  const S turn_y = s * k.outer_x + c1 * k.outer_y;
  const S rx = k.outer_x + turn_x;
  const S ry = k.outer_y + turn_y;
  const S move_x = dx + turn_x;
  S move_y = dy + turn_y;
  const S rate_x = vx - w * ry;
  S rate_y = vy + w * rx;
  if (st.two_way) {
    move_y = move_y - rack;
    rate_y = rate_y - rack_v;
  }
  const S length_x = k.rod_x + move_x;
  const S length_y = k.rod_y + move_y;
  const S growth = move_x * (k.rod_x + length_x) + move_y * (k.rod_y + length_y);  // l² − l_0²
  const S u = growth * k.inverse_rod_length_squared;
  const S inverse = InverseSqrtNearOne(u);  // l_0 / l
  const S inverse_length = inverse * k.inverse_rod_length;
  const S ex = length_x * inverse_length;
  const S ey = length_y * inverse_length;
  const S strain = (1.0 + u) * inverse - 1.0;
  const S rod_rate = ex * rate_x + ey * rate_y;
  S rod_damping_force = k.rod_damping * rod_rate;
  S rod_elastic_force;
  if (st.has_free_play) {
    const S elongation = k.rod_length * strain;
    const S slack = Max(Min(elongation, k.rod_half_play), -k.rod_half_play);
    rod_damping_force = Select(Abs(elongation) > k.rod_half_play, rod_damping_force, zero);
    rod_elastic_force = k.rod_stiffness * (elongation - slack);
  } else {
    rod_elastic_force = k.rod_force_scale * strain;
  }
  const S rod_force = rod_elastic_force + rod_damping_force;
  const S rod_fx = rod_force * ex;
  const S rod_fy = rod_force * ey;

  // Supports.
  const auto& l = k.lateral;
  const S lateral_lever = l.lever + (c1 * l.lever - s * l.offset);
  const S lateral_d = l.nx * dx + l.ny * dy + (s * l.lever + c1 * l.offset);
  const S lateral_rate = l.nx * vx + l.ny * vy + w * lateral_lever;
  const S lateral_force = k.lateral_stiffness * lateral_d + k.lateral_damping * lateral_rate;
  const auto& n = k.longitudinal;
  const S longitudinal_lever = n.lever + (c1 * n.lever - s * n.offset);
  const S longitudinal_d = n.nx * dx + n.ny * dy + (s * n.lever + c1 * n.offset);
  const S longitudinal_rate = n.nx * vx + n.ny * vy + w * longitudinal_lever;
  S longitudinal_force = curves.template EvaluateLongitudinal<kWithTangent>(
      st, k, longitudinal_d, tangent.longitudinal_stiffness);
  if (st.has_own_dampers()) {
    longitudinal_force = longitudinal_force + k.longitudinal_damping * longitudinal_rate;
  }

  // Column and assistance.
  const S twist = phi - k.gear_ratio * rack;
  const S twist_rate = phi_v - k.gear_ratio * rack_v;
  const S bar_torque = k.column_stiffness * twist;
  S elastic_torque = bar_torque;
  if (st.has_stops) {
    const S beyond = twist - Max(Min(twist, k.stop_angle), -k.stop_angle);
    elastic_torque = bar_torque + (k.stop_stiffness - k.column_stiffness) * beyond;
  }
  const S torque = elastic_torque + k.column_damping * twist_rate;
  S assist = zero;
  if constexpr (kWithTangent) tangent.assist_slope = zero;
  out.extra_rate[kAligningState] = zero;
  out.extra_rate[kAssistState] = zero;
  out.extra_rate[kAssistRateState] = zero;
  if (st.has_assist()) {
    const auto negative = bar_torque < zero;
    const S magnitude = Abs(bar_torque);
    const S curve =
        curves.template EvaluateAssist<kWithTangent>(st, k, magnitude, tangent.assist_slope);
    assist = Select(negative, -curve, curve);
    if (st.assist_lag == AssistLag::kFirstOrder) {
      out.extra_rate[kAssistState] = (assist - x.extra[kAssistState]) * k.assist_rate;
      assist = x.extra[kAssistState];
    } else if (st.assist_lag == AssistLag::kSecondOrder) {
      out.extra_rate[kAssistState] = x.extra[kAssistRateState];
      out.extra_rate[kAssistRateState] =
          k.assist_frequency_squared * (assist - x.extra[kAssistState]) -
          k.assist_two_zeta_omega * x.extra[kAssistRateState];
      assist = x.extra[kAssistState];
    }
  }

  // Carrier. The sums are those of the resisting forces.

  S sum_x = rod_fx + lateral_force * l.nx + longitudinal_force * n.nx;
  S sum_y = rod_fy + lateral_force * l.ny + longitudinal_force * n.ny;
  S sum_psi = (rx * rod_fy - ry * rod_fx) + lateral_force * lateral_lever +
              longitudinal_force * longitudinal_lever;
  out.supplied_power = zero;
  if (!IsZero(road_force)) {
    const S road_lever = k.road_lever + (c1 * k.road_lever - s * k.road_offset);
    sum_x = sum_x + road_force;
    sum_y = sum_y + road_force * k.road_lateral_share;
    sum_psi = sum_psi - road_force * road_lever;
    out.supplied_power = road_force * (w * road_lever - vx - k.road_lateral_share * vy);
  }
  S lagged_power = zero;
  S aligning_dissipation = zero;
  if (st.has_aligning_lag) {
    const S moment = k.aligning_stiffness * x.extra[kAligningState];
    sum_psi = sum_psi + moment;
    lagged_power = -(moment * w);
    out.extra_rate[kAligningState] = (psi - x.extra[kAligningState]) * k.aligning_rate;
  } else if (st.has_aligning) {
    sum_psi = sum_psi + k.aligning_stiffness * psi + k.aligning_damping * w;
    aligning_dissipation = k.aligning_damping * w * w;
  }

  // Rack.
  S sum_rack = -(rod_fy + assist) - k.gear_ratio * torque;
  if (st.has_own_dampers()) sum_rack = sum_rack + k.rack_damping * rack_v;
  S friction = zero;
  S limit = zero;
  if (st.friction_law != FrictionLaw::kNone) {
    limit = k.friction_coefficient * Abs(rod_fx) + k.friction_base;
    if (st.friction_law == FrictionLaw::kSmoothed) {
      friction = -(limit * rack_v) / Sqrt(rack_v * rack_v + k.friction_speed_squared);
      sum_rack = sum_rack - friction;
    } else {
      const auto sticks = slip == zero;
      friction = Select(sticks, sum_rack, -(slip * limit));
      sum_rack = Select(sticks, zero, sum_rack - friction);
    }
  }
  S sum_phi = torque;
  if (st.has_hands()) sum_phi = sum_phi + k.hands_stiffness * phi + k.hands_damping * phi_v;

  if constexpr (kWithTangent) {
    tangent.rod_lever = rx * ey - ry * ex;
    tangent.lateral_lever = lateral_lever;
    tangent.longitudinal_lever = longitudinal_lever;
  }
  out.resistance[0] = sum_x;
  out.resistance[1] = sum_y;
  out.resistance[2] = sum_psi;
  out.resistance[3] = sum_rack;
  out.resistance[4] = sum_phi;
  for (int i = 0; i < kCoordinates; ++i) out.a[i] = -(out.resistance[i] * k.inverse_mass[i]);
  out.rod_force = rod_force;
  out.rod_rate = rod_rate;
  out.rod_direction_x = ex;
  out.rod_direction_y = ey;
  out.rack_rod_force = rod_fy;
  out.torsion_torque = torque;
  out.assist_force = assist;
  out.friction_force = friction;
  out.friction_limit = limit;
  out.dissipated_power =
      rod_damping_force * rod_rate + k.lateral_damping * lateral_rate * lateral_rate +
      k.longitudinal_damping * longitudinal_rate * longitudinal_rate +
      k.column_damping * twist_rate * twist_rate + aligning_dissipation +
      k.rack_damping * rack_v * rack_v + k.hands_damping * phi_v * phi_v - friction * rack_v;
  out.supplied_power = out.supplied_power + assist * rack_v + lagged_power;
}

template <class S, class F>
KINGPIN_INLINE void CalcDynamics(const Structure& st, const Constants<S>& k, const State<S>& x,
                                 const F& road_force, const S& slip, Dynamics<S>& out) {
  SegmentCurves<S> curves;
  Tangent<S> unused;
  CalcDynamics<false>(st, k, x, road_force, slip, curves, out, unused);
}

/// ½ q̇ᵀ M q̇ [J].
template <class S>
S CalcKineticEnergy(const Constants<S>& k, const State<S>& x) {
  S sum(0.0);
  for (int i = 0; i < kCoordinates; ++i) sum = sum + x.v[i] * x.v[i] / k.inverse_mass[i];
  return 0.5 * sum;
}

/// V(q) [J], zero at rest.
template <class S>
S CalcPotentialEnergy(const Structure& st, const Constants<S>& k, const State<S>& x) {
  using math::InverseSqrtNearOne;
  using math::Max;
  using math::Min;
  using math::SinCos;
  const S &psi = x.q[2], &rack = x.q[3], &phi = x.q[4];
  S s, c;
  SinCos(psi, s, c);
  const S c1 = c - 1.0;
  const S move_x = x.q[0] + (c1 * k.outer_x - s * k.outer_y);
  S move_y = x.q[1] + (s * k.outer_x + c1 * k.outer_y);
  if (st.two_way) move_y = move_y - rack;
  const S growth = move_x * (2.0 * k.rod_x + move_x) + move_y * (2.0 * k.rod_y + move_y);
  const S u = growth * k.inverse_rod_length_squared;
  S elongation = k.rod_length * ((1.0 + u) * InverseSqrtNearOne(u) - 1.0);
  if (st.has_free_play) {
    elongation = elongation - Max(Min(elongation, k.rod_half_play), -k.rod_half_play);
  }
  const auto elongate = [&](const Line<S>& line) {
    return line.nx * x.q[0] + line.ny * x.q[1] + (s * line.lever + c1 * line.offset);
  };
  const S lateral = elongate(k.lateral);
  const S longitudinal = elongate(k.longitudinal);
  const S twist = phi - k.gear_ratio * rack;
  S energy =
      0.5 * (k.rod_stiffness * elongation * elongation + k.lateral_stiffness * lateral * lateral +
             k.column_stiffness * twist * twist + k.hands_stiffness * phi * phi) +
      math::EvaluateSplineIntegral(st.longitudinal, k.longitudinal_force, longitudinal) -
      math::EvaluateSplineIntegral(st.longitudinal, k.longitudinal_force, S(0.0));
  if (st.has_stops) {
    const S beyond = twist - Max(Min(twist, k.stop_angle), -k.stop_angle);
    energy = energy + 0.5 * (k.stop_stiffness - k.column_stiffness) * beyond * beyond;
  }
  if (st.has_aligning && !st.has_aligning_lag) {
    energy = energy + 0.5 * k.aligning_stiffness * psi * psi;
  }
  return energy;
}

}  // namespace kingpin::planar
