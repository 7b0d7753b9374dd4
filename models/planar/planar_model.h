#pragma once

#include "core/math/cubic_spline.h"
#include "core/math/scalar.h"
#include "models/planar/curve_spline.h"
#include "models/planar/parameters.h"

/// The compiled form of the planar model: what is the same for all lanes (`Structure`) apart from
/// the numbers (`Constants<S>`), which are nothing but scalars so that lanes are packed from scalar
/// models.
namespace kingpin::planar {

inline constexpr int kCoordinates = 5;
/// Names for messages and tables, in the order of q.
inline constexpr const char* kCoordinateNames[kCoordinates] = {"x_s", "y_s", "psi_s", "y", "phi"};

/// Which elements exist. Lanes of one pack share it.
struct Structure {
  math::SplineShape longitudinal;
  math::SplineShape assist;
  bool two_way = true;
  bool has_free_play = false;
  bool has_aligning = false;
  bool has_aligning_lag = false;
  bool has_stops = false;
  /// Neither aligning stiffness nor hands, dampers of the longitudinal support or the rack. Designs
  /// with and without do not share a pack: their code differs in the order of rounding.
  bool is_bare = false;
  FrictionLaw friction_law = FrictionLaw::kNone;
  AssistLag assist_lag = AssistLag::kNone;

  /// Switching forces: their events are located, one design at a time.
  bool has_events() const {
    return friction_law == FrictionLaw::kCoulomb || has_stops || has_free_play;
  }
  bool has_assist() const { return assist.count > 0; }
  // Kept also with zero stiffness and damping, whose derivatives may not be zero.
  static constexpr bool has_hands() { return true; }
  static constexpr bool has_own_dampers() { return true; }
  bool has_extra_states() const { return has_aligning_lag || assist_lag != AssistLag::kNone; }
  friend bool operator==(const Structure& a, const Structure& b) {
    return a.longitudinal.count == b.longitudinal.count &&
           a.longitudinal.anchor == b.longitudinal.anchor && a.assist.count == b.assist.count &&
           a.assist.anchor == b.assist.anchor && a.two_way == b.two_way &&
           a.has_free_play == b.has_free_play && a.has_aligning == b.has_aligning &&
           a.has_aligning_lag == b.has_aligning_lag && a.has_stops == b.has_stops &&
           a.is_bare == b.is_bare && a.friction_law == b.friction_law &&
           a.assist_lag == b.assist_lag;
  }
};

/// The structure that most runs have, and whose branches the compiler therefore knows: a two-way
/// rod, assistance without lag, none of the elements that switch, rub or remember.
/// `kBare`: Structure::is_bare.
template <bool kBare>
struct PlainStructure {
  math::SplineShape longitudinal;
  math::SplineShape assist;
  static constexpr bool two_way = true;
  static constexpr bool has_free_play = false;
  static constexpr bool has_aligning = !kBare;
  static constexpr bool has_aligning_lag = false;
  static constexpr bool has_stops = false;
  static constexpr FrictionLaw friction_law = FrictionLaw::kNone;
  static constexpr AssistLag assist_lag = AssistLag::kNone;

  explicit PlainStructure(const Structure& st) : longitudinal(st.longitudinal), assist(st.assist) {}
  static constexpr bool has_assist() { return true; }
  static constexpr bool has_extra_states() { return false; }
  static constexpr bool has_hands() { return !kBare; }
  static constexpr bool has_own_dampers() { return !kBare; }
};

inline bool IsPlain(const Structure& st) {
  return st.two_way && !st.has_free_play && !st.has_aligning_lag && !st.has_stops &&
         st.friction_law == FrictionLaw::kNone && st.assist_lag == AssistLag::kNone;
}

/// A support along a fixed direction n at the carrier's point p: its elongation is
///   d = n·(x, y) + lever sin ψ + offset (cos ψ − 1),  lever = p_x n_y − p_y n_x,  offset = n·p,
/// its lever about the centre of mass at yaw ψ: lever cos ψ − offset sin ψ.
template <class S>
struct Line {
  S nx, ny, lever, offset;
};

template <class S>
struct Constants {
  S inverse_mass[kCoordinates];
  // Tie rod: outer joint on the carrier, vector from the inner to the outer joint at rest.
  S outer_x, outer_y, rod_x, rod_y, rod_length, rod_length_squared, inverse_rod_length,
      inverse_rod_length_squared;
  S rod_stiffness, rod_damping, rod_half_play;
  S rod_force_scale;  ///< stiffness times length: force per strain [N]
  Line<S> lateral;
  S lateral_stiffness, lateral_damping;
  Line<S> longitudinal;
  S longitudinal_damping;
  math::SplineSegments<S, kMaxCurveNodes> longitudinal_force;
  S aligning_stiffness, aligning_damping, aligning_rate;
  S road_lateral_share, road_lever, road_offset;  ///< of the force (−F_T, −ρ F_T)
  S rack_damping;
  S friction_coefficient, friction_base, friction_speed_squared;
  S gear_ratio, column_stiffness, column_damping, stop_angle, stop_stiffness;
  S hands_stiffness, hands_damping;
  math::SplineSegments<S, kMaxCurveNodes> assist_force;
  S assist_rate, assist_frequency_squared, assist_two_zeta_omega;
  S rim_radius;
};

template <class S>
struct Model {
  Structure structure;
  Constants<S> constants;
};

/// S = double or Dual<double, N> (instantiated for N = 1). Expects valid parameters; see
/// validate.h.
template <class S>
Model<S> MakeModel(const Parameters<S>& p) {
  using math::Abs;
  using math::SinCos;
  using math::Sqrt;
  using math::Value;
  Model<S> model{};
  Structure& st = model.structure;
  Constants<S>& k = model.constants;

  k.inverse_mass[0] = k.inverse_mass[1] = 1.0 / p.carrier_mass;
  k.inverse_mass[2] = 1.0 / p.carrier_yaw_inertia;
  k.inverse_mass[3] = 1.0 / p.rack_mass;
  k.inverse_mass[4] = 1.0 / p.wheel_inertia;

  k.outer_x = p.design_origin_x + p.outer_joint_x;
  k.outer_y = p.design_origin_y + p.outer_joint_y;
  k.rod_x = k.outer_x - (p.design_origin_x + p.rack_position);
  k.rod_y = k.outer_y - (p.rack_half_length - p.half_track);
  k.rod_length_squared = k.rod_x * k.rod_x + k.rod_y * k.rod_y;
  k.rod_length = Sqrt(k.rod_length_squared);
  k.inverse_rod_length = 1.0 / k.rod_length;
  k.inverse_rod_length_squared = k.inverse_rod_length * k.inverse_rod_length;
  k.rod_stiffness = 1.0 / (k.rod_length / p.rod_rigidity + p.rod_compliance);
  k.rod_damping = p.damping_time * k.rod_stiffness;
  k.rod_force_scale = k.rod_stiffness * k.rod_length;
  k.rod_half_play = 0.5 * p.rod_free_play;
  st.two_way = p.two_way;
  st.has_free_play = Value(p.rod_free_play) > 0.0;

  const auto set_line = [](Line<S>& line, const S& x, const S& y, const S& angle) {
    SinCos(angle, line.ny, line.nx);
    line.lever = x * line.ny - y * line.nx;
    line.offset = x * line.nx + y * line.ny;
  };
  set_line(k.lateral, p.lateral_x, p.lateral_y, p.lateral_angle);
  k.lateral_stiffness = p.lateral_stiffness;
  k.lateral_damping = p.damping_time * p.lateral_stiffness;
  set_line(k.longitudinal, p.longitudinal_x, p.longitudinal_y, p.longitudinal_angle);
  k.longitudinal_damping = p.longitudinal_damping;
  const auto longitudinal = MakeSpline(p.longitudinal_force);
  k.longitudinal_force = longitudinal.segments();
  st.longitudinal = longitudinal.shape();

  st.has_aligning = Value(p.aligning_stiffness) > 0.0;
  st.has_aligning_lag = st.has_aligning && Value(p.aligning_lag) > 0.0;
  k.aligning_stiffness = p.aligning_stiffness;
  k.aligning_damping = p.damping_time * p.aligning_stiffness;
  k.aligning_rate = st.has_aligning_lag ? 1.0 / p.aligning_lag : S(0.0);

  k.road_lateral_share = p.lateral_share;
  k.road_lever = p.force_y - p.force_x * p.lateral_share;
  k.road_offset = -(p.force_x + p.force_y * p.lateral_share);

  k.rack_damping = p.rack_damping;
  k.friction_coefficient = p.friction_coefficient;
  k.friction_base = p.friction_coefficient * p.friction_preload + p.friction_constant;
  k.friction_speed_squared = p.friction_speed * p.friction_speed;
  st.friction_law = p.friction_law;
  if (!(Value(p.friction_coefficient) > 0.0) && !(Value(k.friction_base) > 0.0)) {
    st.friction_law = FrictionLaw::kNone;
  }

  k.gear_ratio = p.gear_ratio;
  k.column_stiffness = p.column_stiffness;
  k.column_damping = p.damping_time * p.column_stiffness;
  k.stop_angle = p.stop_angle;
  k.stop_stiffness = p.stop_stiffness;
  st.has_stops = Value(p.stop_angle) > 0.0;
  k.hands_stiffness = p.hands_stiffness;
  k.hands_damping = p.hands_damping;
  k.rim_radius = p.rim_radius;

  st.is_bare = !st.has_aligning && Value(p.hands_stiffness) == 0.0 &&
               Value(p.hands_damping) == 0.0 && Value(p.longitudinal_damping) == 0.0 &&
               Value(p.rack_damping) == 0.0;

  const auto assist = MakeSpline(p.assist_force);
  k.assist_force = assist.segments();
  st.assist = assist.shape();
  st.assist_lag = st.assist.count > 0 ? p.assist_lag : AssistLag::kNone;
  if (st.assist_lag == AssistLag::kFirstOrder) k.assist_rate = 1.0 / p.assist_time;
  if (st.assist_lag == AssistLag::kSecondOrder) {
    k.assist_frequency_squared = p.assist_frequency * p.assist_frequency;
    k.assist_two_zeta_omega = 2.0 * p.assist_damping * p.assist_frequency;
  }
  return model;
}

}  // namespace kingpin::planar
