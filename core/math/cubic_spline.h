#pragma once

#include "core/math/scalar.h"

/// Piecewise cubic interpolants S(x) through (x_k, f_k), continued linearly outside the nodes.
///
/// Both kinds are held as increments from one node, the anchor (the node nearest to x = 0):
///
///   S(x) = f_a + Σ_right p_k(clamp(x − x_k, 0, h_k)) + Σ_left p_k(clamp(x_{k+1} − x, 0, h_k)) +
///   tails, p_k(t) = t (b_k + t (c_k + t d_k)).
///
/// A segment that x has not reached adds exactly zero, one that it has passed adds its full
/// increment. This needs neither a search nor a gather, so lanes with different nodes and arguments
/// run the same instructions; and segments that no lane has reached can be skipped without changing
/// one bit.
///
/// Derivatives through Dual are exact in x (of the right-hand piece at a node) and in the node
/// values.
///
/// Sources: natural spline, e.g. de Boor, A Practical Guide to Splines, ch. IV; monotone slopes:
/// Hyman, SIAM J. Sci. Stat. Comput. 4 (1983), within the region of Fritsch and Carlson, SIAM J.
/// Numer. Anal. 17 (1980).
namespace kingpin::math {

struct SplineShape {
  int count = 0;   ///< number of nodes; 0 is the function that is zero everywhere
  int anchor = 0;  ///< number of the node nearest to zero
};

/// The numbers of a spline; nothing but S, so that lanes can be packed from scalar splines.
template <class S, int kMaxNodes>
struct SplineSegments {
  struct Segment {
    S start;  ///< where t = 0: the left node of a segment right of the anchor, else the right node
    S width;
    S b, c, d;
  };
  S anchor_value;
  S first, last;  ///< outermost nodes
  S slope_left, slope_right;
  Segment segment[kMaxNodes - 1];
};

/// S(x) and, if asked for, dS/dx. X may be S or, for S = double, a Dual.
template <bool kWithSlope, class S, int kMaxNodes, class X>
KINGPIN_INLINE X EvaluateSpline(const SplineShape& shape, const SplineSegments<S, kMaxNodes>& s,
                                const X& x, X& slope) {
  using math::Any;
  using math::Min;
  using math::Select;
  const X zero(0.0);
  if constexpr (kWithSlope) slope = zero;
  if (shape.count == 0) return zero;
  X sum = zero + s.anchor_value;
  for (int k = shape.anchor;; ++k) {
    if (k == shape.count - 1) {
      const X t = x - s.last;
      const auto beyond = t >= zero;
      if (Any(beyond)) {
        sum = sum + Select(beyond, t, zero) * s.slope_right;
        if constexpr (kWithSlope) slope = Select(beyond, X(s.slope_right), slope);
      }
      break;
    }
    const auto& p = s.segment[k];
    X t = x - p.start;
    const auto reached = t >= zero;
    if (!Any(reached)) break;
    t = Select(reached, t, zero);
    t = Min(t, X(p.width));
    sum = sum + t * (p.b + t * (p.c + t * p.d));
    if constexpr (kWithSlope) {
      // Overwritten by the next segment out when that one is reached.
      slope = Select(reached, p.b + t * (2.0 * p.c + t * (3.0 * p.d)), slope);
    }
  }
  for (int k = shape.anchor - 1;; --k) {
    if (k < 0) {
      const X t = s.first - x;
      const auto beyond = t > zero;
      if (Any(beyond)) {
        sum = sum - Select(beyond, t, zero) * s.slope_left;
        if constexpr (kWithSlope) slope = Select(beyond, X(s.slope_left), slope);
      }
      break;
    }
    const auto& p = s.segment[k];
    X t = p.start - x;
    const auto reached = t > zero;
    if (!Any(reached)) break;
    t = Select(reached, t, zero);
    t = Select(t <= X(p.width), t, X(p.width));
    sum = sum + t * (p.b + t * (p.c + t * p.d));
    if constexpr (kWithSlope) {
      slope = Select(reached, -(p.b + t * (2.0 * p.c + t * (3.0 * p.d))), slope);
    }
  }
  return sum;
}

template <class S, int kMaxNodes, class X>
KINGPIN_INLINE X EvaluateSpline(const SplineShape& shape, const SplineSegments<S, kMaxNodes>& s,
                                const X& x) {
  X unused;
  return EvaluateSpline<false>(shape, s, x, unused);
}

/// dS/dx, of the right-hand piece at a node.
template <class S, int kMaxNodes, class X>
X EvaluateSplineSlope(const SplineShape& shape, const SplineSegments<S, kMaxNodes>& s, const X& x) {
  X slope(0.0);
  EvaluateSpline<true>(shape, s, x, slope);
  return slope;
}

/// ∫ S from the anchor node to x.
template <class S, int kMaxNodes, class X>
X EvaluateSplineIntegral(const SplineShape& shape, const SplineSegments<S, kMaxNodes>& s,
                         const X& x) {
  const X zero(0.0);
  if (shape.count == 0) return zero;
  const S anchor = shape.anchor == shape.count - 1 ? s.last : s.segment[shape.anchor].start;
  X sum = (x - anchor) * s.anchor_value;
  for (int k = 0; k < shape.count - 1; ++k) {
    const auto& p = s.segment[k];
    const bool right = k >= shape.anchor;
    const X u = right ? x - p.start : p.start - x;
    const X t = Min(Max(u, zero), X(p.width));
    const X inside = t * t * (X(0.5) * p.b + t * (X(1.0 / 3.0) * p.c + t * (X(0.25) * p.d)));
    const X full = X(p.width) * (p.b + X(p.width) * (p.c + X(p.width) * p.d));
    const X area = inside + Max(u - p.width, zero) * full;
    sum = right ? sum + area : sum - area;
  }
  const X above = Max(x - s.last, zero);
  const X below = Max(s.first - x, zero);
  return sum + X(0.5) * above * above * s.slope_right + X(0.5) * below * below * s.slope_left;
}

/// The cubic (or the straight end) that S(x) was last found on, lane by lane:
///
///   S(x) = value + t (b + t (c + t d)),  t = x − low,  for low <= x < high.
///
/// An argument that moves little between evaluations rarely leaves it, so that an evaluation is one
/// cubic instead of a walk over the segments from the anchor to x. A new piece is looked up for the
/// lanes that have left theirs, one by one; S(x) depends on x alone. For packs, and duals of packs.
template <class S>
struct SplinePiece {
  using V = decltype(Value(S{}));
  V low{1.0}, high{-1.0};  // empty: no argument is within
  S value{}, b{}, c{}, d{};
};

/// Finds the pieces of the lanes of x that have left theirs.
template <int kLanes, class S, int kMaxNodes>
[[gnu::noinline]] void UpdatePiece(const SplineShape& shape, const SplineSegments<S, kMaxNodes>& s,
                                   const typename SplinePiece<S>::V& x, SplinePiece<S>& piece) {
  for (int lane = 0; lane < kLanes; ++lane) {
    const double at = GetLane(x, lane);
    if (GetLane(piece.low, lane) <= at && at < GetLane(piece.high, lane)) continue;
    const auto set = [&](double low, double high, const auto& value, const auto& b, const auto& c,
                         const auto& d) {
      SetLane(piece.low, lane, low);
      SetLane(piece.high, lane, high);
      SetLane(piece.value, lane, value);
      SetLane(piece.b, lane, b);
      SetLane(piece.c, lane, c);
      SetLane(piece.d, lane, d);
    };
    constexpr double kFar = 1e300;
    auto value = GetLane(s.anchor_value, lane);
    using L = decltype(value);
    const L zero(0.0);
    if (shape.count == 0) {
      set(-kFar, kFar, zero, zero, zero, zero);
      continue;
    }
    const auto node = [&](int k) {
      // Segments start at their node next to the anchor.
      return k == 0                 ? GetLane(Value(s.first), lane)
             : k == shape.count - 1 ? GetLane(Value(s.last), lane)
             : k >= shape.anchor    ? GetLane(Value(s.segment[k].start), lane)
                                    : GetLane(Value(s.segment[k - 1].start), lane);
    };
    // From the anchor outwards; `value` is that of the node passed last. NaN goes left and stays
    // NaN on any piece.
    int k = shape.anchor;
    if (at >= node(k)) {
      for (; k < shape.count - 1 && at >= node(k + 1); ++k) {
        const auto& p = s.segment[k];
        const double w = node(k + 1) - node(k);
        value =
            value + (GetLane(p.b, lane) + (GetLane(p.c, lane) + GetLane(p.d, lane) * w) * w) * w;
      }
      if (k == shape.count - 1) {
        set(node(k), kFar, value, GetLane(s.slope_right, lane), zero, zero);
      } else {
        const auto& p = s.segment[k];
        set(node(k), node(k + 1), value, GetLane(p.b, lane), GetLane(p.c, lane),
            GetLane(p.d, lane));
      }
      continue;
    }
    L b = zero, c = zero, d = zero;
    double w = 0;
    do {
      if (k == 0) {
        // The straight end, in lengths that keep its digits.
        w = node(shape.count - 1) - node(0);
        w = w * __builtin_ceil((node(0) - at) / w);
        b = -GetLane(s.slope_left, lane);
        c = d = zero;
        value = value + b * w;
        set(node(0) - w, node(0), value, -b, zero, zero);
        break;
      }
      --k;
      const auto& p = s.segment[k];
      b = GetLane(p.b, lane);
      c = GetLane(p.c, lane);
      d = GetLane(p.d, lane);
      w = node(k + 1) - node(k);
      value = value + (b + (c + d * w) * w) * w;
      // The segment's t grows to the left from its right end: u = w − t.
      if (at >= node(k)) {
        set(node(k), node(k + 1), value, -(b + (2.0 * c + 3.0 * d * w) * w), c + 3.0 * d * w, -d);
        break;
      }
    } while (true);
  }
}

/// S(x) and, if asked for, dS/dx.
template <int kLanes, bool kWithSlope, class S, int kMaxNodes>
KINGPIN_INLINE S EvaluatePiece(const SplineShape& shape, const SplineSegments<S, kMaxNodes>& s,
                               const S& x, SplinePiece<S>& piece, S& slope) {
  const auto at = Value(x);
  if (__builtin_expect(!All((piece.low <= at) & (at < piece.high)), 0)) {
    UpdatePiece<kLanes>(shape, s, at, piece);
  }
  const S t = x - piece.low;
  const S cd = piece.c + t * piece.d;
  const S bcd = piece.b + t * cd;
  // b + 2 c t + 3 d t² = (b + c t + d t²) + t ((c + d t) + d t)
  if constexpr (kWithSlope) slope = bcd + t * (cd + t * piece.d);
  return piece.value + t * bcd;
}

template <class S, int kMaxNodes = 16>
class CubicSpline {
 public:
  using Segments = SplineSegments<S, kMaxNodes>;

  /// The function that is zero everywhere.
  CubicSpline() = default;

  /// C2, second derivative zero at both ends (and outside). `count` nodes, 0 or 2...kMaxNodes, x
  /// strictly increasing.
  static CubicSpline MakeNatural(int count, const double* x, const S* f) {
    S slope[kMaxNodes] = {};
    if (count > 0) CalcNaturalSlopes(count, x, f, slope);
    return CubicSpline(count, x, f, slope);
  }

  /// C1, monotone wherever the nodes are, no overshoot. It is the natural spline, C2, wherever that
  /// is monotone with some room: integrators of high order feel every jump of the curvature.
  static CubicSpline MakeMonotone(int count, const double* x, const S* f) {
    S slope[kMaxNodes] = {};
    if (count > 0) CalcMonotoneSlopes(count, x, f, slope);
    return CubicSpline(count, x, f, slope);
  }

  template <class X>
  X operator()(const X& x) const {
    return EvaluateSpline(shape_, segments_, x);
  }
  template <class X>
  X CalcSlope(const X& x) const {
    return EvaluateSplineSlope(shape_, segments_, x);
  }
  /// ∫ S from the node nearest to zero to x.
  template <class X>
  X CalcIntegral(const X& x) const {
    return EvaluateSplineIntegral(shape_, segments_, x);
  }

  const SplineShape& shape() const { return shape_; }
  const Segments& segments() const { return segments_; }

 private:
  CubicSpline(int count, const double* x, const S* f, const S* slope) {
    shape_.count = count;
    if (count == 0) return;
    int a = 0;
    for (int k = 1; k < count; ++k) {
      if (Abs(x[k]) < Abs(x[a])) a = k;
    }
    shape_.anchor = a;
    segments_.anchor_value = f[a];
    segments_.first = S(x[0]);
    segments_.last = S(x[count - 1]);
    segments_.slope_left = slope[0];
    segments_.slope_right = slope[count - 1];
    for (int k = 0; k < count - 1; ++k) {
      const double h = x[k + 1] - x[k];
      const bool right = k >= a;
      // From its inner node outwards: t grows away from the anchor.
      const S rise = right ? (f[k + 1] - f[k]) * (1.0 / h) : (f[k] - f[k + 1]) * (1.0 / h);
      const S inner = right ? slope[k] : -slope[k + 1];
      const S outer = right ? slope[k + 1] : -slope[k];
      auto& p = segments_.segment[k];
      p.start = S(right ? x[k] : x[k + 1]);
      p.width = S(h);
      p.b = inner;
      p.c = (3.0 * rise - 2.0 * inner - outer) * (1.0 / h);
      p.d = (inner + outer - 2.0 * rise) * (1.0 / (h * h));
    }
  }

  static void CalcNaturalSlopes(int n, const double* x, const S* f, S* slope) {
    // Second derivatives m_k from the tridiagonal system
    //   h_{k-1} m_{k-1} + 2 (h_{k-1} + h_k) m_k + h_k m_{k+1} = 6 (Δ_k − Δ_{k-1}),  m_0 = m_{n-1} =
    //   0.
    S m[kMaxNodes];
    double upper[kMaxNodes] = {};
    m[0] = S(0.0);
    for (int k = 1; k < n - 1; ++k) {
      const double h0 = x[k] - x[k - 1];
      const double h1 = x[k + 1] - x[k];
      const S right = 6.0 * ((f[k + 1] - f[k]) * (1.0 / h1) - (f[k] - f[k - 1]) * (1.0 / h0));
      const double pivot = 2.0 * (h0 + h1) - h0 * upper[k - 1];
      upper[k] = h1 / pivot;
      m[k] = (right - h0 * m[k - 1]) * (1.0 / pivot);
    }
    m[n - 1] = S(0.0);
    for (int k = n - 2; k > 0; --k) m[k] = m[k] - upper[k] * m[k + 1];
    for (int k = 0; k < n - 1; ++k) {
      const double h = x[k + 1] - x[k];
      slope[k] = (f[k + 1] - f[k]) * (1.0 / h) - (h / 6.0) * (2.0 * m[k] + m[k + 1]);
    }
    const double h = x[n - 1] - x[n - 2];
    slope[n - 1] = (f[n - 1] - f[n - 2]) * (1.0 / h) + (h / 6.0) * (m[n - 2] + 2.0 * m[n - 1]);
  }

  /// Hyman's filter: the slopes of the natural spline, moved between zero and three times the
  /// flatter of the neighbouring chords where they are not, zero where the chords turn.
  static void CalcMonotoneSlopes(int n, const double* x, const S* f, S* slope) {
    CalcNaturalSlopes(n, x, f, slope);
    const S zero(0.0);
    const auto chord = [&](int k) { return (f[k + 1] - f[k]) * (1.0 / (x[k + 1] - x[k])); };
    for (int k = 0; k < n; ++k) {
      S flatter = chord(k < n - 1 ? k : k - 1);
      if (k > 0 && k < n - 1) {
        const S before = chord(k - 1);
        const S after = flatter;
        flatter = Select(Abs(before) < Abs(after), before, after);
        flatter = Select(before * after > zero, flatter, zero);
      }
      const S limit = 3.0 * flatter;
      slope[k] = Select(slope[k] * limit > zero, slope[k], zero);
      slope[k] = Select(Abs(slope[k]) > Abs(limit), limit, slope[k]);
    }
  }

  SplineShape shape_;
  Segments segments_{};
};

}  // namespace kingpin::math
