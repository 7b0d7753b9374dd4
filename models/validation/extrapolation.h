#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

namespace kingpin::validation {

/// References are computed with some digits in reserve.
using Real = long double;
using State = std::vector<Real>;
/// Writes dy/dt.
using Rates = std::function<void(Real time, const State& y, State& rate)>;

/// y from one time to another by extrapolation of the modified midpoint rule (Gragg, Bulirsch,
/// Stoer; Hairer, Nørsett and Wanner, Solving ODEs I, II.9): order 16 from eight subdivisions 2, 4,
/// ..., 16, each step controlled to `tolerance` relative to the largest |y| + |h ẏ|. Shares no
/// line with the engine that it judges.
/// @throws std::runtime_error if the step vanishes
inline void Integrate(const Rates& rates, Real from, Real to, State& y, Real tolerance = 1e-18L) {
  constexpr int kColumns = 8;
  const size_t n = y.size();
  std::array<State, kColumns> table;
  State start(n), before(n), now(n), next(n), rate(n), last(n);
  Real time = from, h = (to - from) / 64;
  while (time < to) {
    h = std::min(h, to - time);
    rates(time, y, start);
    Real error = 0;
    for (int k = 0; k < kColumns; ++k) {
      const int substeps = 2 * (k + 1);
      const Real part = h / substeps;
      before = y;
      for (size_t i = 0; i < n; ++i) now[i] = y[i] + part * start[i];
      for (int s = 1; s < substeps; ++s) {
        rates(time + s * part, now, rate);
        for (size_t i = 0; i < n; ++i) next[i] = before[i] + 2 * part * rate[i];
        before.swap(now);
        now.swap(next);
      }
      rates(time + h, now, rate);
      for (size_t i = 0; i < n; ++i) now[i] = 0.5L * (now[i] + before[i] + part * rate[i]);
      // Aitken and Neville, backwards through the last row of the table: table[j] is T(k, k - j)
      State column = now;
      for (int j = 0; j < k; ++j) {
        const Real ratio = Real(substeps) / (2 * (k - j));
        for (size_t i = 0; i < n; ++i) {
          next[i] = column[i] + (column[i] - table[j][i]) / (ratio * ratio - 1);
        }
        table[j].swap(column);
        column = next;
      }
      table[k] = column;
    }
    Real scale = 0;  // of the whole: a component near zero carries the rounding of the others
    for (size_t i = 0; i < n; ++i) {
      scale = std::max(scale, std::abs(y[i]) + std::abs(h * start[i]));
      error = std::max(error, std::abs(table[kColumns - 1][i] - table[kColumns - 2][i]));
    }
    error /= scale + 1e-30L;
    if (error <= tolerance) {
      time = h < to - time ? time + h : to;
      y = table[kColumns - 1];
    }
    const Real factor = std::pow(tolerance / (error + 1e-30L), 1.0L / (2 * kColumns - 1));
    h *= std::clamp(Real(0.9L) * factor, Real(0.1L), Real(2));
    if (!(h > 1e-15L * (to - from))) throw std::runtime_error("the reference's step vanishes");
  }
}

}  // namespace kingpin::validation
