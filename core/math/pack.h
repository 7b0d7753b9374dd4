#pragma once

#include <experimental/simd>
#include <type_traits>

#include "core/math/isa.h"
#include "core/math/scalar.h"

namespace kingpin::math {

/// N numbers side by side: one register of the instruction set that the source is compiled for, or,
/// with N = 1, a plain number (the fast scalar path of the same kernel).
///
/// `Isa` is one of the tags in isa.h. It takes part in the type, and so in the name of every
/// function that handles the pack: objects compiled for different instruction sets never share a
/// symbol.
///
/// Every lane is computed as if it stood alone: no operation mixes lanes, so a lane's result does
/// not depend, to the last bit, on its neighbours.
template <class T, int N, class Isa>
struct Pack {
  using Abi = std::experimental::simd_abi::deduce_t<T, N>;
  using Register =
      typename std::conditional_t<N == 1, std::type_identity<T>,
                                  std::type_identity<std::experimental::simd<T, Abi>>>::type;
  using RegisterMask =
      typename std::conditional_t<N == 1, std::type_identity<bool>,
                                  std::type_identity<std::experimental::simd_mask<T, Abi>>>::type;

  struct Mask {
    RegisterMask m;
    KINGPIN_INLINE friend Mask operator&(const Mask& a, const Mask& b) { return {a.m && b.m}; }
    KINGPIN_INLINE friend Mask operator|(const Mask& a, const Mask& b) { return {a.m || b.m}; }
    KINGPIN_INLINE friend Mask operator!(const Mask& a) { return {!a.m}; }
    KINGPIN_INLINE friend bool Any(const Mask& a) {
      if constexpr (N == 1) {
        return a.m;
      } else {
        return std::experimental::any_of(a.m);
      }
    }
    KINGPIN_INLINE friend bool All(const Mask& a) {
      if constexpr (N == 1) {
        return a.m;
      } else {
        return std::experimental::all_of(a.m);
      }
    }
    KINGPIN_INLINE bool get(int lane) const {
      if constexpr (N == 1) {
        return m;
      } else {
        return m[lane];
      }
    }
  };

  Register r{};

  KINGPIN_INLINE Pack() = default;
  KINGPIN_INLINE Pack(T value) : r(value) {}  ///< the same number in every lane
  template <class U = Register>
  requires(!std::is_same_v<U, T>) KINGPIN_INLINE explicit Pack(const U& value) : r(value) {}

  KINGPIN_INLINE static Pack Load(const T* from) {
    if constexpr (N == 1) {
      return Pack(*from);
    } else {
      return Pack(Register(from, std::experimental::element_aligned));
    }
  }
  KINGPIN_INLINE void Store(T* to) const {
    if constexpr (N == 1) {
      *to = r;
    } else {
      r.copy_to(to, std::experimental::element_aligned);
    }
  }
  KINGPIN_INLINE T get(int lane) const {
    if constexpr (N == 1) {
      return r;
    } else {
      return r[lane];
    }
  }
  KINGPIN_INLINE void set(int lane, T value) {
    if constexpr (N == 1) {
      r = value;
    } else {
      r[lane] = value;
    }
  }

  KINGPIN_INLINE friend Pack operator-(const Pack& a) { return Pack(Register(-a.r)); }
  KINGPIN_INLINE friend Pack operator+(const Pack& a, const Pack& b) {
    return Pack(Register(a.r + b.r));
  }
  KINGPIN_INLINE friend Pack operator-(const Pack& a, const Pack& b) {
    return Pack(Register(a.r - b.r));
  }
  KINGPIN_INLINE friend Pack operator*(const Pack& a, const Pack& b) {
    return Pack(Register(a.r * b.r));
  }
  KINGPIN_INLINE friend Pack operator/(const Pack& a, const Pack& b) {
    return Pack(Register(a.r / b.r));
  }
  KINGPIN_INLINE Pack& operator+=(const Pack& b) { return *this = *this + b; }
  KINGPIN_INLINE Pack& operator-=(const Pack& b) { return *this = *this - b; }
  KINGPIN_INLINE Pack& operator*=(const Pack& b) { return *this = *this * b; }

  KINGPIN_INLINE friend Mask operator<(const Pack& a, const Pack& b) { return {a.r < b.r}; }
  KINGPIN_INLINE friend Mask operator>(const Pack& a, const Pack& b) { return {a.r > b.r}; }
  KINGPIN_INLINE friend Mask operator<=(const Pack& a, const Pack& b) { return {a.r <= b.r}; }
  KINGPIN_INLINE friend Mask operator>=(const Pack& a, const Pack& b) { return {a.r >= b.r}; }
  KINGPIN_INLINE friend Mask operator==(const Pack& a, const Pack& b) { return {a.r == b.r}; }

  KINGPIN_INLINE friend Pack Select(const Mask& mask, const Pack& a, const Pack& b) {
    if constexpr (N == 1) {
      return mask.m ? a : b;
    } else {
      Register result = b.r;
      std::experimental::where(mask.m, result) = a.r;
      return Pack(result);
    }
  }
  KINGPIN_INLINE friend Pack Min(const Pack& a, const Pack& b) {
    if constexpr (N == 1) {
      return Pack(a.r < b.r ? a.r : b.r);
    } else {
      return Pack(Register(std::experimental::min(a.r, b.r)));
    }
  }
  KINGPIN_INLINE friend Pack Max(const Pack& a, const Pack& b) {
    if constexpr (N == 1) {
      return Pack(a.r > b.r ? a.r : b.r);
    } else {
      return Pack(Register(std::experimental::max(a.r, b.r)));
    }
  }
  KINGPIN_INLINE friend Pack Abs(const Pack& a) {
    if constexpr (N == 1) {
      return Pack(__builtin_fabs(a.r));
    } else {
      return Pack(Register(std::experimental::abs(a.r)));
    }
  }
  KINGPIN_INLINE friend Pack Sqrt(const Pack& a) {
    if constexpr (N == 1) {
      return Pack(__builtin_sqrt(a.r));
    } else {
      return Pack(Register(std::experimental::sqrt(a.r)));
    }
  }
  /// The binomial series up to |u| = 0.005, where it is exact to rounding: the first neglected term
  /// is 429/2048 · 0.005⁷ = 2e-17. A lane beyond that gets the square root and the division.
  KINGPIN_INLINE friend Pack InverseSqrtNearOne(const Pack& u) {
    Pack p(231.0 / 1024.0);
    p = p * u + Pack(-63.0 / 256.0);
    p = p * u + Pack(35.0 / 128.0);
    p = p * u + Pack(-5.0 / 16.0);
    p = p * u + Pack(3.0 / 8.0);
    p = p * u + Pack(-0.5);
    Pack result = p * u + Pack(1.0);
    const Mask outside = !(Abs(u) <= Pack(0.005));
    if (__builtin_expect(Any(outside), 0)) {
      result = Select(outside, Pack(1.0) / Sqrt(Pack(1.0) + u), result);
    }
    return result;
  }
  KINGPIN_INLINE friend Pack Exp(const Pack& a) {
    Pack result;
    for (int i = 0; i < N; ++i) result.set(i, ::exp(a.get(i)));
    return result;
  }
  KINGPIN_INLINE friend Pack Value(const Pack& a) { return a; }

  /// Polynomials up to |x| = 0.25 (a large yaw of a wheel carrier), where they are exact to
  /// rounding: the first neglected terms are 0.25^12/13! = 1e-17 of sin x and 0.25^14/14! = 4e-20.
  /// A lane beyond that range gets the library's functions, and only that lane.
  KINGPIN_INLINE friend void SinCos(const Pack& x, Pack& s, Pack& c) {
    const Pack x2 = x * x;
    Pack p(-1.0 / 39916800.0);
    p = p * x2 + Pack(1.0 / 362880.0);
    p = p * x2 + Pack(-1.0 / 5040.0);
    p = p * x2 + Pack(1.0 / 120.0);
    p = p * x2 + Pack(-1.0 / 6.0);
    Pack sine = x + (x * x2) * p;
    Pack w(1.0 / 479001600.0);
    w = w * x2 + Pack(-1.0 / 3628800.0);
    w = w * x2 + Pack(1.0 / 40320.0);
    w = w * x2 + Pack(-1.0 / 720.0);
    w = w * x2 + Pack(1.0 / 24.0);
    w = w * x2 + Pack(-0.5);
    Pack cosine = Pack(1.0) + x2 * w;
    const Mask outside = !(x2 <= Pack(0.0625));  // also true for NaN
    if (__builtin_expect(Any(outside), 0)) {
      for (int i = 0; i < N; ++i) {
        if (!outside.get(i)) continue;
        sine.set(i, ::sin(x.get(i)));
        cosine.set(i, ::cos(x.get(i)));
      }
    }
    s = sine;
    c = cosine;
  }

  /// Shorter polynomials up to |x| = 0.1, where they are exact to rounding: the first neglected
  /// terms are 0.1^10/11! = 3e-18 of sin x and 0.1^10/10! = 3e-17. A lane beyond that range gets
  /// what SinCos gives.
  KINGPIN_INLINE friend void SinCosMinusOne(const Pack& x, Pack& s, Pack& c1) {
    const Pack x2 = x * x;
    Pack p(1.0 / 362880.0);
    p = p * x2 + Pack(-1.0 / 5040.0);
    p = p * x2 + Pack(1.0 / 120.0);
    p = p * x2 + Pack(-1.0 / 6.0);
    s = x + (x * x2) * p;
    Pack w(1.0 / 40320.0);
    w = w * x2 + Pack(-1.0 / 720.0);
    w = w * x2 + Pack(1.0 / 24.0);
    w = w * x2 + Pack(-0.5);
    c1 = x2 * w;
    const Mask outside = !(x2 <= Pack(0.01));  // also true for NaN
    if (__builtin_expect(Any(outside), 0)) {
      Pack sine, cosine;
      SinCos(x, sine, cosine);
      s = Select(outside, sine, s);
      c1 = Select(outside, cosine - Pack(1.0), c1);
    }
  }

  KINGPIN_INLINE friend T GetLane(const Pack& a, int lane) { return a.get(lane); }
  KINGPIN_INLINE friend void SetLane(Pack& a, int lane, T value) { a.set(lane, value); }
};

}  // namespace kingpin::math
