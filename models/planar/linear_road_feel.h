#pragma once

#include <array>
#include <cstddef>

#include "models/planar/curve_spline.h"
#include "models/planar/linear_entries.h"
#include "models/planar/parameters.h"

/// How much of a moment about the kingpin reaches the driver's hands: the wanted part of what
/// kickback is the unwanted part of.
namespace kingpin::planar {

namespace detail {

/// Complex numbers over any scalar; std::complex is defined for floating-point types only.
template <class S>
struct Complex {
  S re{}, im{};

  friend Complex operator+(const Complex& a, const Complex& b) {
    return {a.re + b.re, a.im + b.im};
  }
  friend Complex operator-(const Complex& a, const Complex& b) {
    return {a.re - b.re, a.im - b.im};
  }
  friend Complex operator*(const Complex& a, const Complex& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend Complex operator*(const S& a, const Complex& b) { return {a * b.re, a * b.im}; }
  Complex Inverse() const {
    const S scale = S(1.0) / (re * re + im * im);
    return {re * scale, -im * scale};
  }
};

/// Gauss-Legendre nodes and weights on [0, 1], 32 points: exact to polynomial degree 63.
inline constexpr std::array<double, 32> kGaussNodes = {
    0.0013680690752592183, 0.007194244227365833, 0.017618872206246784, 0.03254696203113015,
    0.05183942211697394,   0.07531619313371501,  0.1027581020160288,   0.13390894062985517,
    0.1684778665348924,    0.20614212137961885,  0.2465500455338853,   0.2893243619346823,
    0.33406569885893617,   0.38035631887393145,  0.42776401920860174,  0.4758461671561308,
    0.5241538328438692,    0.5722359807913983,   0.6196436811260685,   0.6659343011410638,
    0.7106756380653176,    0.7534499544661147,   0.7938578786203812,   0.8315221334651076,
    0.8660910593701449,    0.8972418979839712,   0.9246838068662849,   0.9481605778830261,
    0.9674530379688698,    0.9823811277937532,   0.9928057557726342,   0.9986319309247408};
inline constexpr std::array<double, 32> kGaussWeights = {
    0.003509305004735048, 0.008137197365452835, 0.01269603265463103,  0.017136931456510716,
    0.02141794901111334,  0.025499029631188087, 0.029342046739267772, 0.032911111388180925,
    0.03617289705442425,  0.039096947893535156, 0.041655962113473374, 0.043826046502201906,
    0.045586939347881945, 0.04692219954040228,  0.04781936003963743,  0.0482700442573639,
    0.0482700442573639,   0.04781936003963743,  0.04692219954040228,  0.045586939347881945,
    0.043826046502201906, 0.041655962113473374, 0.039096947893535156, 0.03617289705442425,
    0.032911111388180925, 0.029342046739267772, 0.025499029631188087, 0.02141794901111334,
    0.017136931456510716, 0.01269603265463103,  0.008137197365452835, 0.003509305004735048};

}  // namespace detail

inline constexpr double kRoadFeelHighest = 10.0;  ///< [Hz]

/// |M / M_z| at one frequency: amplitude of the torsion torque M = c_k (1 + iωη) (φ − i_U y) per
/// amplitude of a moment M_z on the carrier, small motions about rest, steering wheel held (φ = 0).
/// Dry friction is left out; the assistance and the aligning torque enter with their lags.
///
/// `longitudinal_slope` and `assist_slope` are the curves' slopes at zero [N/m, N/(N m)].
/// Elimination without pivoting: the imaginary part of the dynamic stiffness is that of damping,
/// positive semi-definite, which keeps the pivots away from zero.
template <class S>
S CalcHeldWheelGain(const Parameters<S>& p, const LinearEntries<S>& e, const S& longitudinal_slope,
                    const S& assist_slope, double frequency) {
  using math::Sqrt;
  using math::Value;
  using Z = detail::Complex<S>;
  const double w = 2.0 * 3.14159265358979323846 * frequency;

  // Dynamic stiffness of [x_s, y_s, ψ, y]: (1 + iωη) K − ω² M + N + options.
  std::array<std::array<Z, 4>, 4> k;
  const Z support{longitudinal_slope, w * p.longitudinal_damping};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      k[i][j] = Z{e.stiffness[i][j], w * e.damping[i][j]} +
                (e.longitudinal_row[i] * e.longitudinal_row[j]) * support;
    }
    k[i][i].re = k[i][i].re - (w * w) * e.mass[i];
  }
  if (!p.two_way) {  // the rod does not feel the rack: its column loses the rod, its row keeps it
    const RodAtRest<S> rod = CalcRodAtRest(p);
    for (std::size_t i = 0; i < 4; ++i) {
      const S c = rod.stiffness * e.rod_row[i] * e.rod_row[3];
      k[i][3] = k[i][3] - Z{c, (w * p.damping_time) * c};
    }
  }
  // Aligning torque: k_ψ (1 + iωη), or lagged, k_ψ/(1 + iω σ/V).
  const bool lagged = Value(p.aligning_lag) > 0.0;
  const Z yaw = lagged ? Z{S(1.0), w * p.aligning_lag}.Inverse() : Z{S(1.0), w * p.damping_time};
  k[2][2] = k[2][2] + p.aligning_stiffness * yaw;
  // Assistance F_A = f' G(iω) M_b on the rack, M_b = −c_k i_U y.
  Z lag{S(1.0), S(0.0)};
  if (p.assist_lag == AssistLag::kFirstOrder) {
    lag = Z{S(1.0), w * p.assist_time}.Inverse();
  } else if (p.assist_lag == AssistLag::kSecondOrder) {
    const S ratio = S(w) / p.assist_frequency;
    lag = Z{S(1.0) - ratio * ratio, 2.0 * p.assist_damping * ratio}.Inverse();
  }
  k[3][3] = k[3][3] + (assist_slope * p.column_stiffness * p.gear_ratio) * lag;
  k[3][3].im = k[3][3].im + w * p.rack_damping;

  std::array<Z, 4> load{};
  load[2].re = S(1.0);
  for (std::size_t n = 0; n < 3; ++n) {
    const Z inverse = k[n][n].Inverse();
    for (std::size_t i = n + 1; i < 4; ++i) {
      const Z factor = k[i][n] * inverse;
      for (std::size_t j = n + 1; j < 4; ++j) k[i][j] = k[i][j] - factor * k[n][j];
      load[i] = load[i] - factor * load[n];
    }
  }
  const Z travel = load[3] * k[3][3].Inverse();
  const Z torque = (p.column_stiffness * p.gear_ratio) * (Z{S(1.0), w * p.damping_time} * travel);
  return Sqrt(torque.re * torque.re + torque.im * torque.im);
}

/// Road-feel gain [N m/N m]: the mean over 0 to 10 Hz of CalcHeldWheelGain, by 32-point
/// Gauss-Legendre quadrature (its nodes are part of the definition: the gain is a smooth function
/// of every parameter). S = double, or math::Dual for exact gradients.
///
/// The rack, with all that is geared to it, swings on the held column at about √(c_k/m_R) i_U. An
/// electric motor (hundreds of kilograms at the rack) brings that within the band, and the mean
/// then measures the resonance as much as what the driver feels of slow forces; CalcStaticRoadFeel
/// does not.
template <class S>
S CalcRoadFeelGain(const Parameters<S>& p) {
  const LinearEntries<S> entries = CalcLinearEntries(p);
  const S longitudinal_slope = MakeSpline(p.longitudinal_force).CalcSlope(S(0.0));
  const S assist_slope = MakeSpline(p.assist_force).CalcSlope(S(0.0));
  S sum(0.0);
  for (std::size_t i = 0; i < detail::kGaussNodes.size(); ++i) {
    sum = sum +
          detail::kGaussWeights[i] * CalcHeldWheelGain(p, entries, longitudinal_slope, assist_slope,
                                                       kRoadFeelHighest * detail::kGaussNodes[i]);
  }
  return sum;
}

/// The limit of CalcHeldWheelGain at 0 Hz [N m/N m]: no mass and no damping enters. Without
/// aligning stiffness |sin γ| / (h (i_U + dF_A/dM)), h the lever of the tie rod about the point
/// where the lines of the supports L and N cross; an aligning torque lowers it, counted at its full
/// quasi-static stiffness.
template <class S>
S CalcStaticRoadFeel(const Parameters<S>& p) {
  return CalcHeldWheelGain(p, CalcLinearEntries(p),
                           MakeSpline(p.longitudinal_force).CalcSlope(S(0.0)),
                           MakeSpline(p.assist_force).CalcSlope(S(0.0)), 0.0);
}

}  // namespace kingpin::planar
