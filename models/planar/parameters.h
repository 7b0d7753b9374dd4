#pragma once

#include <array>
#include <cstddef>

/// Parameters of the planar steering model: one front corner seen from above, the rack, the
/// steering wheel.
///
/// Frame: origin at the centre of mass of the wheel carrier at rest, x forward, y to the left
/// (which is outboard: the corner is the left one), z up; ψ counter-clockwise seen from above. SI
/// units.
///
/// Coordinates q = [x_s, y_s, ψ_s, y, φ]: displacement of the carrier's centre of mass, its yaw,
/// the rack's travel along +y, the steering wheel's angle (φ = i_U y when the column is
/// undeformed: positive φ drives the rack to +y, which steers to the left with the rack ahead of
/// the steering axis and to the right with it behind). All are zero at rest.
///
/// Source: Szczotka, J. Theor. Appl. Mech. 49(1), 2011, section 2, with the corrections listed in
/// docs/theory/planar-model.md.
namespace kingpin::planar {

inline constexpr int kMaxCurveNodes = 16;

/// How a curve runs between its nodes; see core/math/cubic_spline.h.
enum class CurveKind {
  kNatural,   ///< C2; may overshoot. The law of the identified paper sets
  kMonotone,  ///< C1, monotone wherever the nodes are; else the natural one. Car mode
};

/// A curve through (x_k, f_k): cubic spline, continued linearly outside its nodes.
template <class S>
struct Curve {
  CurveKind kind = CurveKind::kNatural;
  int count = 0;
  std::array<double, kMaxCurveNodes> x{};  ///< strictly increasing
  std::array<S, kMaxCurveNodes> f{};
};

enum class FrictionLaw {
  kNone,
  kSmoothed,  ///< −μ |N| v / sqrt(v² + v_s²); the law of the identified paper sets
  kCoulomb,   ///< set-valued: an unknown reaction while sticking, bounded by the limit
};

enum class AssistLag { kNone, kFirstOrder, kSecondOrder };

template <class S>
struct Parameters {
  // Wheel carrier: knuckle, hub and wheel as one body.
  S carrier_mass{};         ///< m_s [kg]
  S carrier_yaw_inertia{};  ///< I_s about the centre of mass [kg m^2]

  // Road force: (−F_T, −ρ F_T) at (x_F, y_F), a point fixed to the carrier.
  S force_x{};        ///< x_F [m]
  S force_y{};        ///< y_F [m]
  S lateral_share{};  ///< ρ [-]

  // Tie rod, from the rack's end at (o_x + r_X, r_L − B + y) to the carrier's point o + (x_tr,
  // y_tr).
  S design_origin_x{};   ///< o_x [m]: where r_X and x_tr are measured from (paper sets: 0)
  S design_origin_y{};   ///< o_y [m]: where y_tr is measured from (paper sets: 0)
  S rack_half_length{};  ///< r_L [m]
  S rack_position{};     ///< r_X [m]
  S outer_joint_x{};     ///< x_tr [m]
  S outer_joint_y{};     ///< y_tr [m]
  S half_track{};        ///< B [m]: the centre of mass lies this far from the car's centre plane
  S rod_rigidity{};      ///< E A [N]
  S rod_compliance{};    ///< of joints and rack mounts, in series with l_0/(E A) [m/N]
  S rod_free_play{};     ///< total clearance at the inner joint [m]; 0 for none
  bool two_way =
      true;  ///< false: the paper's literal form, in which the rod does not feel the rack

  // Lateral support L: linear, along the fixed direction (cos β, sin β).
  S lateral_stiffness{};  ///< c_L [N/m]
  S lateral_x{};          ///< [m]
  S lateral_y{};          ///< [m]
  S lateral_angle{};      ///< β [rad]

  // Longitudinal support N: nonlinear, along the fixed direction (cos α, sin α).
  Curve<S> longitudinal_force;  ///< F_N over elongation [N over m], tension positive, F_N(0) = 0
  S longitudinal_damping{};     ///< b_N [N s/m]
  S longitudinal_x{};           ///< [m]
  S longitudinal_y{};           ///< [m]
  S longitudinal_angle{};       ///< α [rad]

  S damping_time{};  ///< η [s] of P = η K: rod, lateral support, column

  // Tyre aligning stiffness: −k_ψ (ψ + η ψ̇) directly, or through a first-order lag.
  S aligning_stiffness{};  ///< k_ψ [N m/rad]
  S aligning_lag{};        ///< σ/V [s]; 0 for none

  // Rack.
  S rack_mass{};     ///< m_R with everything rigidly geared to it: motor, opposite wheel [kg]
  S rack_damping{};  ///< [N s/m]
  FrictionLaw friction_law = FrictionLaw::kNone;
  S friction_coefficient{};  ///< μ [-], on the normal force |F_R e_x| + preload
  S friction_preload{};      ///< yoke and mesh force [N]
  S friction_constant{};     ///< limit that does not depend on the normal force [N]
  S friction_speed{};        ///< v_s of the smoothed law [m/s]

  // Column and steering wheel.
  S wheel_inertia{};     ///< I_sw, with the driver's hands [kg m^2]
  S column_stiffness{};  ///< c_k [N m/rad]
  S gear_ratio{};        ///< i_U [rad/m]
  S stop_angle{};        ///< torsion-bar stop, half range of the column's twist [rad]; 0 for none
  S stop_stiffness{};    ///< c_k beyond the stop [N m/rad]
  S hands_damping{};     ///< driver's hands and column bearings [N m s/rad]
  S hands_stiffness{};   ///< driver's hands [N m/rad]
  S rim_radius{};        ///< r_sw [m]

  // Power assistance F_A(M) = sign(M) f(|M|), M the elastic torsion torque; + pushes the rack to
  // +y.
  Curve<S> assist_force;  ///< f over |M| [N over N m]
  AssistLag assist_lag = AssistLag::kNone;
  S assist_time{};       ///< time constant of the first-order lag [s]
  S assist_frequency{};  ///< natural frequency of the second-order lag [rad/s]
  S assist_damping{};    ///< its damping ratio [-]
};

/// The same parameters on another scalar: `convert(value)` for every number that is an S.
template <class To, class From, class Convert>
Parameters<To> ConvertParameters(const Parameters<From>& p, const Convert& convert) {
  Parameters<To> r;
  r.carrier_mass = convert(p.carrier_mass);
  r.carrier_yaw_inertia = convert(p.carrier_yaw_inertia);
  r.force_x = convert(p.force_x);
  r.force_y = convert(p.force_y);
  r.lateral_share = convert(p.lateral_share);
  r.design_origin_x = convert(p.design_origin_x);
  r.design_origin_y = convert(p.design_origin_y);
  r.rack_half_length = convert(p.rack_half_length);
  r.rack_position = convert(p.rack_position);
  r.outer_joint_x = convert(p.outer_joint_x);
  r.outer_joint_y = convert(p.outer_joint_y);
  r.half_track = convert(p.half_track);
  r.rod_rigidity = convert(p.rod_rigidity);
  r.rod_compliance = convert(p.rod_compliance);
  r.rod_free_play = convert(p.rod_free_play);
  r.lateral_stiffness = convert(p.lateral_stiffness);
  r.lateral_x = convert(p.lateral_x);
  r.lateral_y = convert(p.lateral_y);
  r.lateral_angle = convert(p.lateral_angle);
  r.longitudinal_damping = convert(p.longitudinal_damping);
  r.longitudinal_x = convert(p.longitudinal_x);
  r.longitudinal_y = convert(p.longitudinal_y);
  r.longitudinal_angle = convert(p.longitudinal_angle);
  r.damping_time = convert(p.damping_time);
  r.aligning_stiffness = convert(p.aligning_stiffness);
  r.aligning_lag = convert(p.aligning_lag);
  r.rack_mass = convert(p.rack_mass);
  r.rack_damping = convert(p.rack_damping);
  r.friction_coefficient = convert(p.friction_coefficient);
  r.friction_preload = convert(p.friction_preload);
  r.friction_constant = convert(p.friction_constant);
  r.friction_speed = convert(p.friction_speed);
  r.wheel_inertia = convert(p.wheel_inertia);
  r.column_stiffness = convert(p.column_stiffness);
  r.gear_ratio = convert(p.gear_ratio);
  r.stop_angle = convert(p.stop_angle);
  r.stop_stiffness = convert(p.stop_stiffness);
  r.hands_damping = convert(p.hands_damping);
  r.hands_stiffness = convert(p.hands_stiffness);
  r.rim_radius = convert(p.rim_radius);
  r.assist_time = convert(p.assist_time);
  r.assist_frequency = convert(p.assist_frequency);
  r.assist_damping = convert(p.assist_damping);
  r.two_way = p.two_way;
  r.friction_law = p.friction_law;
  r.assist_lag = p.assist_lag;
  const auto convert_curve = [&](const Curve<From>& from, Curve<To>& to) {
    to.kind = from.kind;
    to.count = from.count;
    to.x = from.x;
    for (int i = 0; i < from.count; ++i) {
      to.f[static_cast<std::size_t>(i)] = convert(from.f[static_cast<std::size_t>(i)]);
    }
  };
  convert_curve(p.longitudinal_force, r.longitudinal_force);
  convert_curve(p.assist_force, r.assist_force);
  return r;
}

}  // namespace kingpin::planar
