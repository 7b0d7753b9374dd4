#pragma once

#include <array>
#include <cstddef>

#include "core/math/scalar.h"
#include "models/planar/parameters.h"

/// The paper's linear model (2.4) by its closed entries, corrected as listed in
/// docs/theory/planar-model.md ("Printed in the paper, found, used here"):
///
///     M q̈ + P q̇ + K q = G u,   K = c_R d_R d_Rᵀ + c_L d_L d_Lᵀ + c_k d_C d_Cᵀ,   P = η K
///
/// q = [x_s, y_s, ψ, y, φ], ψ counter-clockwise. The tangent of the longitudinal support, which
/// the paper keeps on the right side, stands beside K as c_N d_N d_Nᵀ. K is symmetric, positive
/// semi-definite and, with the support N, of rank 4: one zero mode, the free turning of the whole
/// steering.
///
/// Assistance, friction, stops, free play, aligning torque and hands are not in here: the
/// linearisation of the full force model (linear_model.h) has them.
namespace kingpin::planar {

/// The tie rod at rest.
template <class S>
struct RodAtRest {
  S length{};     ///< l_0 [m]
  S cosine{};     ///< cos γ, γ the direction from the rack's end to the carrier's joint
  S sine{};       ///< sin γ
  S outer_x{};    ///< x_R, the joint on the carrier, from the centre of mass [m]
  S outer_y{};    ///< y_R [m]
  S stiffness{};  ///< c_R = 1/(l_0/(E A) + compliance) [N/m]
};

template <class S>
RodAtRest<S> CalcRodAtRest(const Parameters<S>& p) {
  using math::Sqrt;
  RodAtRest<S> rod;
  rod.outer_x = p.design_origin_x + p.outer_joint_x;
  rod.outer_y = p.design_origin_y + p.outer_joint_y;
  const S dx = p.outer_joint_x - p.rack_position;
  const S dy = rod.outer_y - (p.rack_half_length - p.half_track);
  rod.length = Sqrt(dx * dx + dy * dy);
  rod.cosine = dx / rod.length;
  rod.sine = dy / rod.length;
  rod.stiffness = S(1.0) / (rod.length / p.rod_rigidity + p.rod_compliance);
  return rod;
}

template <class S>
using Vector5 = std::array<S, 5>;
template <class S>
using Matrix5 = std::array<std::array<S, 5>, 5>;

/// ∂δ/∂q of a link at (x, y) on the carrier along the direction (c, s): [c, s, x s − y c, 0, 0].
template <class S>
Vector5<S> CalcLinkRow(const S& x, const S& y, const S& c, const S& s) {
  return {c, s, x * s - y * c, S(0.0), S(0.0)};
}

template <class S>
struct LinearEntries {
  Vector5<S> mass{};              ///< diagonal of M: m_s, m_s, I_s, m_R, I_sw
  Matrix5<S> stiffness{};         ///< the paper's K: rod, lateral support, column
  Matrix5<S> damping{};           ///< P = η K
  Vector5<S> rod_row{};           ///< d_R, with the rack's column −sin γ (two-way)
  Vector5<S> longitudinal_row{};  ///< d_N; its tangent stiffness adds c_N d_N d_Nᵀ
  Vector5<S> force_row{};         ///< G for F_T: [−1, −ρ, y_F − ρ x_F, 0, 0]
};

/// Entries c11 ... c55 written out one by one (vehicle data 3.2); two-way rod.
template <class S>
LinearEntries<S> CalcLinearEntries(const Parameters<S>& p) {
  using math::SinCos;
  const RodAtRest<S> rod = CalcRodAtRest(p);
  const S& cr = rod.stiffness;
  const S& cl = p.lateral_stiffness;
  const S& ck = p.column_stiffness;
  const S& iu = p.gear_ratio;
  const S cg = rod.cosine;
  const S sg = rod.sine;
  S cb, sb, ca, sa;
  SinCos(p.lateral_angle, sb, cb);
  SinCos(p.longitudinal_angle, sa, ca);
  const S lever_r = rod.outer_x * sg - rod.outer_y * cg;
  const S lever_l = p.lateral_x * sb - p.lateral_y * cb;

  LinearEntries<S> e;
  e.mass = {p.carrier_mass, p.carrier_mass, p.carrier_yaw_inertia, p.rack_mass, p.wheel_inertia};
  auto& k = e.stiffness;
  k[0][0] = cr * cg * cg + cl * cb * cb;
  k[0][1] = cr * sg * cg + cl * sb * cb;
  k[0][2] = cr * cg * lever_r + cl * cb * lever_l;
  k[1][1] = cr * sg * sg + cl * sb * sb;
  k[1][2] = cr * sg * lever_r + cl * sb * lever_l;
  k[2][2] = cr * lever_r * lever_r + cl * lever_l * lever_l;
  k[0][3] = -cr * sg * cg;
  k[1][3] = -cr * sg * sg;
  k[2][3] = -cr * sg * lever_r;
  k[3][3] = cr * sg * sg + iu * iu * ck;
  k[3][4] = -iu * ck;
  k[4][4] = ck;
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < i; ++j) k[i][j] = k[j][i];
  }
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 5; ++j) e.damping[i][j] = p.damping_time * k[i][j];
  }
  e.rod_row = CalcLinkRow(rod.outer_x, rod.outer_y, cg, sg);
  e.rod_row[3] = -sg;
  e.longitudinal_row = CalcLinkRow(p.longitudinal_x, p.longitudinal_y, ca, sa);
  e.force_row = {S(-1.0), -p.lateral_share, p.force_y - p.lateral_share * p.force_x, S(0.0),
                 S(0.0)};
  return e;
}

}  // namespace kingpin::planar
