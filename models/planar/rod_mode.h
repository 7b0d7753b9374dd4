#pragma once

#include "models/planar/planar_forces.h"

/// The one stiff part of the planar model, solved exactly: the damped tie rod.
///
/// In velocity space the linear rod acts along one direction, b = M⁻¹ d with d = ∂δ_R/∂q at rest:
///
///   q̈ = g(q, q̇, t) − b (c dᵀq + c_η dᵀq̇),   c_η = η c,
///
/// which defines the remainder g. With s = dᵀq, μ = dᵀb this splits into s̈ + μ c_η ṡ + μ c s = dᵀg,
/// whose rates (μ c_η = 2e3...6e4 1/s) forbid large explicit steps, and into the rest, which moves
/// under g alone. The flow of the first is a 2 × 2 exponential; so exponential integrators need no
/// matrix functions beyond these scalars, and every lane has its own.
///
/// Responses: z_m(θ) is the pair (s, h ṡ) at t = θ h that a forcing h² dᵀg = (t/h)^m/m! makes from
/// rest, E(θ) the propagator of (s, h ṡ). They are computed by Taylor series over h/4096 and twelve
/// doublings,
///   z_m(2θ) = E(θ) z_m(θ) + Σ_{j<=m} θ^{m−j}/(m−j)! z_j(θ),
/// which needs neither exp nor a case distinction between over- and underdamped, and is
/// differentiable.
///
/// Source: exponential integrators, Hochbruck and Ostermann, Acta Numerica 19 (2010); the rank-one
/// use here is ours.
namespace kingpin::planar {

template <class S>
struct RodMode {
  S d[kCoordinates];  ///< ∂δ_R/∂q at rest, as the rod feels it
  S b[kCoordinates];  ///< M⁻¹ times the direction in which it pulls
  S b_over_mu[kCoordinates];
  S stiffness, damping, mu;
};

/// `rack_held`: friction holds the rack, so that the rod does not accelerate it.
template <class S>
RodMode<S> MakeRodMode(const Structure& st, const Constants<S>& k, bool rack_held) {
  RodMode<S> rod;
  const S ex = k.rod_x * k.inverse_rod_length;
  const S ey = k.rod_y * k.inverse_rod_length;
  rod.d[0] = ex;
  rod.d[1] = ey;
  rod.d[2] = k.outer_x * ey - k.outer_y * ex;
  rod.d[3] = -ey;
  rod.d[4] = S(0.0);
  for (int i = 0; i < kCoordinates; ++i) rod.b[i] = rod.d[i] * k.inverse_mass[i];
  if (rack_held) rod.b[3] = S(0.0);
  if (!st.two_way) rod.d[3] = S(0.0);
  rod.mu = S(0.0);
  for (int i = 0; i < kCoordinates; ++i) rod.mu = rod.mu + rod.d[i] * rod.b[i];
  const S inverse = 1.0 / rod.mu;
  for (int i = 0; i < kCoordinates; ++i) rod.b_over_mu[i] = rod.b[i] * inverse;
  rod.stiffness = k.rod_stiffness;
  rod.damping = k.rod_damping;
  return rod;
}

/// z_m(θ), m = 0 ... n − 1, and E(θ).
template <class S, int n>
struct Response {
  S e[2][2];
  S z[n][2];
};

/// Of a free mass: s̈ = forcing.
template <int n>
KINGPIN_INLINE void MakeFreeResponse(double theta, Response<double, n>& r) {
  r.e[0][0] = r.e[1][1] = 1.0;
  r.e[0][1] = theta;
  r.e[1][0] = 0.0;
  double power = 1.0;
  for (int m = 0; m < n; ++m) {
    power *= theta / (m + 1);
    r.z[m][1] = power;
    r.z[m][0] = power * theta / (m + 2);
  }
}

/// Of the rod mode with h² μ c = `stiffness` and h μ c_η = `damping`, at θ = 1/2 and θ = 1.
template <class S, int n>
void MakeRodResponse(const S& stiffness, const S& damping, Response<S, n>& half,
                     Response<S, n>& full) {
  constexpr int kDoublings = 12;
  constexpr int kTerms = 11;
  double theta = 1.0 / (1 << kDoublings);
  double power[n + kTerms + 1];  // θ^i/i!
  power[0] = 1.0;
  for (int i = 1; i <= n + kTerms; ++i) power[i] = power[i - 1] * theta / i;
  Response<S, n> r;
  S column[2][2] = {{S(1.0), S(0.0)},
                    {S(0.0), S(1.0)}};  // Aⁱ e_1 and Aⁱ e_2, A = [0 1; −stiffness −damping]
  for (int c = 0; c < 2; ++c) {
    r.e[0][c] = S(0.0);
    r.e[1][c] = S(0.0);
  }
  for (int m = 0; m < n; ++m) r.z[m][0] = r.z[m][1] = S(0.0);
  for (int i = 0; i < kTerms; ++i) {
    for (int c = 0; c < 2; ++c) {
      for (int row = 0; row < 2; ++row) r.e[row][c] = r.e[row][c] + column[c][row] * power[i];
    }
    for (int m = 0; m < n; ++m) {
      for (int row = 0; row < 2; ++row) {
        r.z[m][row] = r.z[m][row] + column[1][row] * power[m + 1 + i];
      }
    }
    for (auto& v : column) {
      const S next = -(stiffness * v[0]) - damping * v[1];
      v[0] = v[1];
      v[1] = next;
    }
  }
  for (int doubling = 0; doubling < kDoublings; ++doubling) {
    Response<S, n> o;
    for (int row = 0; row < 2; ++row) {
      for (int c = 0; c < 2; ++c) {
        o.e[row][c] = r.e[row][0] * r.e[0][c] + r.e[row][1] * r.e[1][c];
      }
      for (int m = 0; m < n; ++m) {
        S sum = r.e[row][0] * r.z[m][0] + r.e[row][1] * r.z[m][1];
        double factor = 1.0;
        for (int j = m; j >= 0; --j) {
          sum = sum + r.z[j][row] * factor;
          factor *= theta / (m - j + 1);
        }
        o.z[m][row] = sum;
      }
    }
    theta *= 2.0;
    r = o;
    if (doubling == kDoublings - 2) half = r;
  }
  full = r;
}

/// Weights of one update x(θ h) from x(0) and remainders g_j: those of the free coordinates, and
/// what the rod mode changes.
template <class S, int n>
struct Weights {
  double theta;
  double q[n], v[n];     ///< of h² g_j in q, of h g_j in v
  S rod_q[n], rod_v[n];  ///< of h² dᵀg_j, to be added along b/μ in q and h v
  S e[2][2];             ///< of (dᵀq, h dᵀv), likewise
};

/// g is interpolated by Σ_j g_j Σ_m coefficient[j][m] (t/h)^m/m!.
template <class S, int n, int m_count>
KINGPIN_INLINE void SetWeights(const double (&coefficient)[n][m_count], double theta,
                               const Response<double, m_count>& free,
                               const Response<S, m_count>& rod, Weights<S, n>& w) {
  w.theta = theta;
  for (int j = 0; j < n; ++j) {
    w.q[j] = w.v[j] = 0.0;
    S q(0.0), v(0.0);
    for (int m = 0; m < m_count; ++m) {
      w.q[j] += coefficient[j][m] * free.z[m][0];
      w.v[j] += coefficient[j][m] * free.z[m][1];
      q = q + rod.z[m][0] * coefficient[j][m];
      v = v + rod.z[m][1] * coefficient[j][m];
    }
    w.rod_q[j] = q - w.q[j];
    w.rod_v[j] = v - w.v[j];
  }
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 2; ++c) w.e[r][c] = rod.e[r][c] - free.e[r][c];
  }
}

/// The remainder g, its projection dᵀg, and the rates of the extra states.
template <class S>
struct Remainder {
  S g[kCoordinates];
  S projection;
  S extra[kExtraStates];
};

template <class S>
KINGPIN_INLINE void SplitRemainder(const RodMode<S>& rod, const State<S>& x, const Dynamics<S>& d,
                                   bool has_extra, Remainder<S>& r) {
  S pull =
      rod.stiffness *
          (rod.d[0] * x.q[0] + rod.d[1] * x.q[1] + rod.d[2] * x.q[2] + rod.d[3] * x.q[3]) +
      rod.damping * (rod.d[0] * x.v[0] + rod.d[1] * x.v[1] + rod.d[2] * x.v[2] + rod.d[3] * x.v[3]);
  for (int i = 0; i < 4; ++i) r.g[i] = d.a[i] + rod.b[i] * pull;
  r.g[4] = d.a[4];
  r.projection = rod.d[0] * r.g[0] + rod.d[1] * r.g[1] + rod.d[2] * r.g[2] + rod.d[3] * r.g[3];
  if (has_extra) {
    for (int i = 0; i < kExtraStates; ++i) r.extra[i] = d.extra_rate[i];
  }
}

/// x(θ h) from x(0) and n remainders. H: S, or double when all lanes take the same step.
template <class S, int n, class H>
KINGPIN_INLINE void UpdateState(const RodMode<S>& rod, const Weights<S, n>& w, const H& h,
                                bool has_extra, const State<S>& x, const Remainder<S>* const* r,
                                State<S>& out) {
  const H h2 = h * h;
  const S s = rod.d[0] * x.q[0] + rod.d[1] * x.q[1] + rod.d[2] * x.q[2] + rod.d[3] * x.q[3];
  const S hs = (rod.d[0] * x.v[0] + rod.d[1] * x.v[1] + rod.d[2] * x.v[2] + rod.d[3] * x.v[3]) * h;
  S rod_q(0.0), rod_v(0.0);
  for (int j = 0; j < n; ++j) {
    rod_q = rod_q + w.rod_q[j] * r[j]->projection;
    rod_v = rod_v + w.rod_v[j] * r[j]->projection;
  }
  rod_q = rod_q * h2 + (w.e[0][0] * s + w.e[0][1] * hs);
  rod_v = rod_v * h + (w.e[1][0] * s + w.e[1][1] * hs) * (1.0 / h);
  State<S> next;
  for (int i = 0; i < kCoordinates; ++i) {
    S q(0.0), v(0.0);
    for (int j = 0; j < n; ++j) {
      q = q + r[j]->g[i] * w.q[j];
      v = v + r[j]->g[i] * w.v[j];
    }
    next.q[i] = x.q[i] + x.v[i] * (w.theta * h) + q * h2;
    next.v[i] = x.v[i] + v * h;
    if (i < 4) {
      next.q[i] = next.q[i] + rod.b_over_mu[i] * rod_q;
      next.v[i] = next.v[i] + rod.b_over_mu[i] * rod_v;
    }
  }
  if (has_extra) {
    for (int i = 0; i < kExtraStates; ++i) {
      S e(0.0);
      for (int j = 0; j < n; ++j) e = e + r[j]->extra[i] * w.v[j];
      next.extra[i] = x.extra[i] + e * h;
    }
  } else {
    for (int i = 0; i < kExtraStates; ++i) next.extra[i] = x.extra[i];
  }
  out = next;
}

}  // namespace kingpin::planar
