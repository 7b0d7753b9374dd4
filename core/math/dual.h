#pragma once

#include <type_traits>

#include "core/math/scalar.h"

namespace kingpin::math {

/// A number with its N first derivatives: v + Σ d[i] ε_i, ε_i ε_j = 0. Arithmetic carries the
/// derivatives exactly (forward differentiation). T is `double`, or a `Pack` when every lane has
/// its own value and direction.
///
/// Comparisons look at the value alone. At a kink (Abs at 0, Min of equal arguments) the derivative
/// of one side is taken. Sqrt at 0 has no derivative: the result is infinite or NaN, as it should
/// be.
template <class T, int N>
struct Dual {
  T v{};
  T d[N]{};

  KINGPIN_INLINE Dual() = default;
  /// A constant.
  template <class U>
  requires std::is_convertible_v<U, T> KINGPIN_INLINE Dual(const U& value) : v(value), d{} {}

  /// The variable number `direction`.
  KINGPIN_INLINE static Dual MakeVariable(const T& value, int direction) {
    Dual x(value);
    x.d[direction] = T(1.0);
    return x;
  }

  KINGPIN_INLINE friend Dual operator-(const Dual& a) {
    Dual r;
    r.v = -a.v;
    for (int i = 0; i < N; ++i) r.d[i] = -a.d[i];
    return r;
  }
  KINGPIN_INLINE friend Dual operator+(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v + b.v;
    for (int i = 0; i < N; ++i) r.d[i] = a.d[i] + b.d[i];
    return r;
  }
  KINGPIN_INLINE friend Dual operator-(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v - b.v;
    for (int i = 0; i < N; ++i) r.d[i] = a.d[i] - b.d[i];
    return r;
  }
  KINGPIN_INLINE friend Dual operator*(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v * b.v;
    for (int i = 0; i < N; ++i) r.d[i] = a.d[i] * b.v + a.v * b.d[i];
    return r;
  }
  KINGPIN_INLINE friend Dual operator/(const Dual& a, const Dual& b) {
    const T inverse = T(1.0) / b.v;
    Dual r;
    r.v = a.v * inverse;
    for (int i = 0; i < N; ++i) r.d[i] = (a.d[i] - r.v * b.d[i]) * inverse;
    return r;
  }
  // With a constant: no derivatives of zeros are multiplied.
  template <class U>
  requires std::is_convertible_v<U, T> KINGPIN_INLINE friend Dual operator+(Dual a, const U& b) {
    a.v = a.v + T(b);
    return a;
  }
  template <class U>
  requires std::is_convertible_v<U, T> KINGPIN_INLINE friend Dual operator+(const U& b, Dual a) {
    a.v = a.v + T(b);
    return a;
  }
  template <class U>
  requires std::is_convertible_v<U, T> KINGPIN_INLINE friend Dual operator-(Dual a, const U& b) {
    a.v = a.v - T(b);
    return a;
  }
  template <class U>
  requires std::is_convertible_v<U, T> KINGPIN_INLINE friend Dual operator-(const U& b,
                                                                            const Dual& a) {
    Dual r = -a;
    r.v = T(b) - a.v;
    return r;
  }
  template <class U>
  requires std::is_convertible_v<U, T> KINGPIN_INLINE friend Dual operator*(Dual a, const U& b) {
    const T factor(b);
    a.v = a.v * factor;
    for (int i = 0; i < N; ++i) a.d[i] = a.d[i] * factor;
    return a;
  }
  template <class U>
  requires std::is_convertible_v<U, T> KINGPIN_INLINE friend Dual operator*(const U& b,
                                                                            const Dual& a) {
    return a * b;
  }
  template <class U>
  requires std::is_convertible_v<U, T> KINGPIN_INLINE friend Dual operator/(const Dual& a,
                                                                            const U& b) {
    return a * (T(1.0) / T(b));
  }
  KINGPIN_INLINE Dual& operator+=(const Dual& b) { return *this = *this + b; }
  KINGPIN_INLINE Dual& operator-=(const Dual& b) { return *this = *this - b; }
  KINGPIN_INLINE Dual& operator*=(const Dual& b) { return *this = *this * b; }

  KINGPIN_INLINE friend auto operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  KINGPIN_INLINE friend auto operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  KINGPIN_INLINE friend auto operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  KINGPIN_INLINE friend auto operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }
  KINGPIN_INLINE friend auto operator==(const Dual& a, const Dual& b) { return a.v == b.v; }

  template <class Mask>
  KINGPIN_INLINE friend Dual Select(const Mask& mask, const Dual& a, const Dual& b) {
    Dual r;
    r.v = Select(mask, a.v, b.v);
    for (int i = 0; i < N; ++i) r.d[i] = Select(mask, a.d[i], b.d[i]);
    return r;
  }
  KINGPIN_INLINE friend Dual Min(const Dual& a, const Dual& b) { return Select(a.v < b.v, a, b); }
  KINGPIN_INLINE friend Dual Max(const Dual& a, const Dual& b) { return Select(a.v > b.v, a, b); }
  KINGPIN_INLINE friend Dual Abs(const Dual& a) { return Select(a.v < T(0.0), -a, a); }
  KINGPIN_INLINE friend Dual Sqrt(const Dual& a) {
    using math::Sqrt;
    const T root = Sqrt(a.v);
    const T slope = T(0.5) / root;
    Dual r;
    r.v = root;
    for (int i = 0; i < N; ++i) r.d[i] = slope * a.d[i];
    return r;
  }
  KINGPIN_INLINE friend Dual InverseSqrtNearOne(const Dual& a) {
    using math::InverseSqrtNearOne;
    const T y = InverseSqrtNearOne(a.v);
    const T slope = T(-0.5) * (y * y) * y;
    Dual r;
    r.v = y;
    for (int i = 0; i < N; ++i) r.d[i] = slope * a.d[i];
    return r;
  }
  KINGPIN_INLINE friend Dual Exp(const Dual& a) {
    using math::Exp;
    const T e = Exp(a.v);
    Dual r;
    r.v = e;
    for (int i = 0; i < N; ++i) r.d[i] = e * a.d[i];
    return r;
  }
  KINGPIN_INLINE friend void SinCos(const Dual& a, Dual& s, Dual& c) {
    T sine, cosine;
    using math::SinCos;
    SinCos(a.v, sine, cosine);
    Dual ds, dc;
    ds.v = sine;
    dc.v = cosine;
    for (int i = 0; i < N; ++i) {
      ds.d[i] = cosine * a.d[i];
      dc.d[i] = -sine * a.d[i];
    }
    s = ds;
    c = dc;
  }
  KINGPIN_INLINE friend void SinCosMinusOne(const Dual& a, Dual& s, Dual& c1) {
    T sine, cosine_minus_one;
    using math::SinCosMinusOne;
    SinCosMinusOne(a.v, sine, cosine_minus_one);
    const T cosine = cosine_minus_one + T(1.0);
    Dual ds, dc;
    ds.v = sine;
    dc.v = cosine_minus_one;
    for (int i = 0; i < N; ++i) {
      ds.d[i] = cosine * a.d[i];
      dc.d[i] = -(sine * a.d[i]);
    }
    s = ds;
    c1 = dc;
  }
  /// One lane, of Pack only.
  KINGPIN_INLINE friend auto GetLane(const Dual& a, int lane) {
    const auto v = GetLane(a.v, lane);
    Dual<std::remove_const_t<decltype(v)>, N> r;
    r.v = v;
    for (int i = 0; i < N; ++i) r.d[i] = GetLane(a.d[i], lane);
    return r;
  }
  template <class U>
  KINGPIN_INLINE friend void SetLane(Dual& a, int lane, const Dual<U, N>& value) {
    SetLane(a.v, lane, value.v);
    for (int i = 0; i < N; ++i) SetLane(a.d[i], lane, value.d[i]);
  }
  KINGPIN_INLINE friend T Value(const Dual& a) { return a.v; }
};

}  // namespace kingpin::math
