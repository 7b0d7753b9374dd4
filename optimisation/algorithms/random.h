#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace kingpin::optimisation {

/// Random numbers that are the same on every machine and standard library (the distributions of
/// <random> are not): std::mt19937_64, 53-bit uniforms, Box-Muller normals.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1).
  double Uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

  /// A whole number in [0, count).
  std::size_t Index(std::size_t count) {
    return static_cast<std::size_t>(Uniform() * static_cast<double>(count));
  }

  double Normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2 * std::log(1 - Uniform()));
    const double angle = 2 * std::numbers::pi * Uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

/// Latin hypercube sample of the unit box (McKay, Beckman, Conover 1979): n points, row-major n x
/// dim; in each coordinate exactly one point per n-th of the range.
inline std::vector<double> MakeLatinHypercube(std::size_t n, std::size_t dim, Random& random) {
  std::vector<double> points(n * dim);
  std::vector<std::size_t> order(n);
  for (std::size_t k = 0; k < dim; ++k) {
    for (std::size_t i = 0; i < n; ++i) order[i] = i;
    for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random.Index(i)]);
    for (std::size_t i = 0; i < n; ++i) {
      points[i * dim + k] =
          (static_cast<double>(order[i]) + random.Uniform()) / static_cast<double>(n);
    }
  }
  return points;
}

}  // namespace kingpin::optimisation
