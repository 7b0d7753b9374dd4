#include "core/signal/running_integral.h"

#include <cstddef>

namespace kingpin::signal {

std::string_view ToString(Quadrature rule) {
  return rule == Quadrature::kTrapezoid ? "trapezoidal rule" : "four-sample cubic rule (13/24)";
}

void UpdateRunningIntegral(Quadrature rule, double time_step, std::span<const double> function,
                           std::span<double> integral) {
  const std::size_t n = function.size();
  if (n == 0) return;
  const double* f = function.data();
  double* c = integral.data();
  c[0] = 0.0;
  double total = 0.0;  // in a register: reading c[i] back would double the latency of the sum
  if (rule == Quadrature::kTrapezoid) {
    for (std::size_t i = 0; i + 1 < n; ++i) c[i + 1] = total += 0.5 * time_step * (f[i] + f[i + 1]);
    return;
  }
  const double scale = time_step / 24.0;
  const auto cell = [=](std::size_t before, std::size_t i, std::size_t after) {
    return scale * (13.0 * (f[i] + f[i + 1]) - f[before] - f[after]);
  };
  if (n == 1) return;
  if (n == 2) {
    c[1] = cell(0, 0, 1);
    return;
  }
  c[1] = total = cell(0, 0, 2);
  for (std::size_t i = 1; i + 2 < n; ++i) c[i + 1] = total += cell(i - 1, i, i + 2);
  c[n - 1] = total + cell(n - 3, n - 2, n - 1);
}

void AddRunningIntegralAdjoint(Quadrature rule, double time_step, std::span<const double> integral,
                               std::span<double> function) {
  const std::size_t n = function.size();
  double tail = 0.0;  // Σ_{j > i} ∂G/∂C_j: every later value contains cell i
  for (std::size_t i = n - 1; i-- > 0;) {
    tail += integral[i + 1];
    if (rule == Quadrature::kTrapezoid) {
      function[i] += 0.5 * time_step * tail;
      function[i + 1] += 0.5 * time_step * tail;
    } else {
      const double scaled = time_step * tail / 24.0;
      function[i] += 13.0 * scaled;
      function[i + 1] += 13.0 * scaled;
      function[i > 0 ? i - 1 : 0] -= scaled;
      function[i + 2 < n ? i + 2 : n - 1] -= scaled;
    }
  }
}

}  // namespace kingpin::signal
