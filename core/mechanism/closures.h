#pragma once

#include "core/mechanism/workspace.h"

namespace kingpin::mechanism {

namespace internal {

/// What a row n·(velocity of a's point at p against b) needs: u that relative velocity, and g with
/// n·g its rate at zero joint accelerations when n is fixed in b and the point moves with velocity
/// p_dot: g = ΔA(p) + Δω × ṗ + u × ω_b.
template <class S>
struct RelativePoint {
  Vector3<S> u, g;
};

template <class S>
KINGPIN_INLINE RelativePoint<S> CalcRelativePoint(const Workspace<S>& w, int a, int b,
                                                  const Vector3<S>& p, const Vector3<S>& p_dot) {
  const Motion<S> dV = w.V[a] - w.V[b];
  const Motion<S> dA = w.A[a] - w.A[b];
  const Vector3<S> u = dV.At(p);
  return {u, dA.At(p) + Cross(dV.w, p_dot) + Cross(u, w.V[b].w)};
}

}  // namespace internal

/// W, Φ and J̇v of every closure between links. Needs UpdatePositions and UpdateVelocities.
template <class S>
KINGPIN_INLINE void UpdateClosures(const Model& model, Workspace<S>& w) {
  using math::Convert;
  using math::MakeWrench;
  using math::Sqrt;
  for (const PointClosure& c : model.points) {
    const Vector3<S> p = w.R[c.a] * Convert<S>(c.p_A) + w.p[c.a];
    const Rotation<S> F = w.R[c.b] * Convert<S>(c.X_BF.R);
    const Vector3<S> d = p - (w.R[c.b] * Convert<S>(c.X_BF.p) + w.p[c.b]);
    const auto [u, g] = internal::CalcRelativePoint(w, c.a, c.b, p, w.V[c.a].At(p));
    int row = c.row;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(c.axes >> axis & 1)) continue;
      const Vector3<S> n = axis == 0 ? F.x : axis == 1 ? F.y : F.z;
      w.W[row] = MakeWrench(p, n);
      w.residual[row] = Dot(n, d);
      w.bias[row] = Dot(n, g);
      ++row;
    }
  }
  for (const PerpendicularClosure& c : model.perpendiculars) {
    const Vector3<S> u = w.R[c.a] * Convert<S>(c.u_A), e = w.R[c.b] * Convert<S>(c.w_B);
    const Vector3<S> m = Cross(u, e), wa = w.V[c.a].w, wb = w.V[c.b].w;
    w.W[c.row] = {m, {}};
    w.residual[c.row] = Dot(u, e);
    // d/dt (ω_a - ω_b)·(u × e)
    w.bias[c.row] = Dot(w.A[c.a].w - w.A[c.b].w, m) +
                    Dot(wa - wb, Cross(Cross(wa, u), e) + Cross(u, Cross(wb, e)));
  }
  for (const DistanceClosure& c : model.distances) {
    const Vector3<S> pa = w.R[c.a] * Convert<S>(c.p_A) + w.p[c.a];
    const Vector3<S> pb = w.R[c.b] * Convert<S>(c.p_B) + w.p[c.b];
    const S inverse(1.0 / c.length);
    const Vector3<S> d = pa - pb, n = inverse * d;
    const Vector3<S> va = w.V[c.a].At(pa), vb = w.V[c.b].At(pb);
    const Vector3<S> aa = w.A[c.a].At(pa) + Cross(w.V[c.a].w, va);
    const Vector3<S> ab = w.A[c.b].At(pb) + Cross(w.V[c.b].w, vb);
    w.W[c.row] = MakeWrench(pa, n);
    w.residual[c.row] = S(0.5) * (Dot(d, n) - S(c.length));
    w.bias[c.row] = inverse * Dot(va - vb, va - vb) + Dot(n, aa - ab);
  }
  for (const RollingDisc& c : model.discs) {
    // The lowest point of the disc lies along e = (n - (n·a) a)/|..| below the centre; a is the
    // disc's axis.
    const Rotation<S> F = w.R[c.b] * Convert<S>(c.X_BF.R);
    const Vector3<S> centre = w.R[c.a] * Convert<S>(c.centre_A) + w.p[c.a];
    const Vector3<S> axis = w.R[c.a] * Convert<S>(c.axis_A), n = F.z;
    const Vector3<S> wa = w.V[c.a].w, wb = w.V[c.b].w;
    const S lean = Dot(n, axis);
    const Vector3<S> e0 = n - lean * axis;
    const S inverse = S(1.0) / Sqrt(S(1.0) - lean * lean);
    const Vector3<S> e = inverse * e0;
    const Vector3<S> axis_dot = Cross(wa, axis), n_dot = Cross(wb, n);
    const S lean_dot = Dot(n_dot, axis) + Dot(n, axis_dot);
    const Vector3<S> e_dot = inverse * (n_dot - lean_dot * axis - lean * axis_dot) +
                             (inverse * inverse * lean * lean_dot) * e;
    const S r(c.radius);
    const Vector3<S> p = centre - r * e;
    const Vector3<S> p_dot = w.V[c.a].At(centre) - r * e_dot;
    const Vector3<S> d = p - (w.R[c.b] * Convert<S>(c.X_BF.p) + w.p[c.b]);
    const auto [u, g] = internal::CalcRelativePoint(w, c.a, c.b, p, p_dot);
    const Vector3<S> directions[3] = {F.z, F.x, F.y};
    for (int k = 0; k < 3; ++k) {
      w.W[c.row + k] = MakeWrench(p, directions[k]);
      w.residual[c.row + k] = k == 0 ? Dot(n, d) : S(0.0);
      w.bias[c.row + k] = Dot(directions[k], g);
    }
  }
}

}  // namespace kingpin::mechanism
