#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "optimisation/algorithms/problem.h"

namespace kingpin::optimisation {

using Function = std::function<double(std::span<const double>)>;

/// A problem of one function of one point, all variables with the same bounds.
inline Problem MakeTestProblem(std::size_t n, double lower, double upper, double start,
                               Function function) {
  Problem problem;
  for (std::size_t i = 0; i < n; ++i) {
    problem.variables.push_back({fmt::format("x{}", i + 1), "m", lower, upper, start});
  }
  problem.objective = MakeBatch(n, std::move(function));
  return problem;
}

inline double Square(double x) { return x * x; }

inline double Rosenbrock(std::span<const double> x) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    sum += 100 * Square(x[i + 1] - x[i] * x[i]) + Square(1 - x[i]);
  }
  return sum;
}

/// Minimum 0 at (1, ..., 1), interior.
inline Problem MakeRosenbrock(std::size_t n, bool with_gradient) {
  Problem problem = MakeTestProblem(n, -2, 2, -1.2, Rosenbrock);
  if (with_gradient) {
    problem.gradient = MakeBatchGradient(n, [](std::span<const double> x, std::span<double> g) {
      for (double& value : g) value = 0;
      for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        const double t = x[i + 1] - x[i] * x[i];
        g[i] += -400 * x[i] * t - 2 * (1 - x[i]);
        g[i + 1] += 200 * t;
      }
      return Rosenbrock(x);
    });
  }
  return problem;
}

/// A coupled quadratic whose constrained minimum lies in the corner (0.2, 0, -0.0825), with the
/// numbers of the paper's case 2: in the corner the slope points outwards in all three variables.
inline double CornerValue(std::span<const double> x) {
  const double a = x[0] - 0.1;
  const double b = x[1] - 0.2;
  const double c = x[2] + 0.01;
  return 1 + 3 * a * a + 2 * b * b + 5 * c * c + 0.5 * a * b + 0.3 * Square(a * c) +
         0.01 * std::sin(40 * x[0]) * c;
}

inline Problem MakeCorner() {
  Problem problem;
  problem.variables = {{"r_L", "m", 0.2, 0.4, 0.32},
                       {"r_X", "m", -0.3, 0.0, -0.2},
                       {"x_tr", "m", -0.1825, -0.0825, -0.15}};
  problem.objective = MakeBatch(3, CornerValue);
  return problem;
}

/// Hock and Schittkowski (1981), problem 35 (Beale): one linear constraint, active. f = 1/9.
inline Problem MakeHock35(bool with_gradient) {
  const auto value = [](std::span<const double> x) {
    return 9 - 8 * x[0] - 6 * x[1] - 4 * x[2] + 2 * x[0] * x[0] + 2 * x[1] * x[1] + x[2] * x[2] +
           2 * x[0] * x[1] + 2 * x[0] * x[2];
  };
  Problem problem = MakeTestProblem(3, 0, 3, 0.5, value);
  problem.linear = {{"budget", {1, 1, 2}, 3, false}};
  if (with_gradient) {
    problem.gradient =
        MakeBatchGradient(3, [value](std::span<const double> x, std::span<double> g) {
          g[0] = -8 + 4 * x[0] + 2 * x[1] + 2 * x[2];
          g[1] = -6 + 4 * x[1] + 2 * x[0];
          g[2] = -4 + 2 * x[2] + 2 * x[0];
          return value(x);
        });
  }
  return problem;
}

/// Problem 43 (Rosen and Suzuki): three nonlinear inequalities, two active. f = -44 at (0, 1, 2,
/// -1).
inline Problem MakeHock43() {
  Problem problem = MakeTestProblem(4, -5, 5, 0, [](std::span<const double> x) {
    return x[0] * x[0] + x[1] * x[1] + 2 * x[2] * x[2] + x[3] * x[3] - 5 * x[0] - 5 * x[1] -
           21 * x[2] + 7 * x[3];
  });
  problem.inequalities.names = {"c1", "c2", "c3"};
  problem.inequalities.values = [](std::span<const double> points, std::span<double> values) {
    for (std::size_t p = 0; 4 * p < points.size(); ++p) {
      const auto x = points.subspan(4 * p, 4);
      values[3 * p] =
          -(8 - x[0] * x[0] - x[1] * x[1] - x[2] * x[2] - x[3] * x[3] - x[0] + x[1] - x[2] + x[3]);
      values[3 * p + 1] =
          -(10 - x[0] * x[0] - 2 * x[1] * x[1] - x[2] * x[2] - 2 * x[3] * x[3] + x[0] + x[3]);
      values[3 * p + 2] =
          -(5 - 2 * x[0] * x[0] - x[1] * x[1] - x[2] * x[2] - 2 * x[0] + x[1] + x[3]);
    }
  };
  return problem;
}

/// Problem 71: a nonlinear inequality, a nonlinear equality and a bound, all active; exact
/// gradients. f = 17.0140173 at (1, 4.7429994, 3.8211503, 1.3794082).
inline Problem MakeHock71() {
  const auto value = [](std::span<const double> x) {
    return x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
  };
  const auto product = [](std::span<const double> x) { return 25 - x[0] * x[1] * x[2] * x[3]; };
  const auto sphere = [](std::span<const double> x) {
    return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3] - 40;
  };
  Problem problem = MakeTestProblem(4, 1, 5, 1, value);
  problem.variables[1].start = problem.variables[2].start = 5;
  problem.gradient = MakeBatchGradient(4, [=](std::span<const double> x, std::span<double> g) {
    g[0] = x[3] * (2 * x[0] + x[1] + x[2]);
    g[1] = x[0] * x[3];
    g[2] = x[0] * x[3] + 1;
    g[3] = x[0] * (x[0] + x[1] + x[2]);
    return value(x);
  });
  problem.inequalities = {{"product"},
                          MakeBatch(4, product),
                          MakeBatchGradient(4, [=](std::span<const double> x, std::span<double> g) {
                            g[0] = -x[1] * x[2] * x[3];
                            g[1] = -x[0] * x[2] * x[3];
                            g[2] = -x[0] * x[1] * x[3];
                            g[3] = -x[0] * x[1] * x[2];
                            return product(x);
                          })};
  problem.equalities = {{"sphere"},
                        MakeBatch(4, sphere),
                        MakeBatchGradient(4, [=](std::span<const double> x, std::span<double> g) {
                          for (std::size_t i = 0; i < 4; ++i) g[i] = 2 * x[i];
                          return sphere(x);
                        })};
  return problem;
}

inline double Rastrigin(std::span<const double> x) {
  double sum = 0;
  for (const double value : x) {
    const double t = value - 0.3;  // minimum off the middle, where a search could sit by luck
    sum += 10 + t * t - 10 * std::cos(2 * std::numbers::pi * t);
  }
  return sum;
}

/// Minimum -418.9829 n at 420.9687, next to the bound and far from the next best.
inline double Schwefel(std::span<const double> x) {
  double sum = 0;
  for (const double value : x) sum -= value * std::sin(std::sqrt(std::abs(value)));
  return sum;
}

/// Hartmann (six variables): six local minima, the lowest -3.322368.
inline double Hartmann6(std::span<const double> x) {
  static const double a[4][6] = {{10, 3, 17, 3.5, 1.7, 8},
                                 {0.05, 10, 17, 0.1, 8, 14},
                                 {3, 3.5, 1.7, 10, 17, 8},
                                 {17, 8, 0.05, 10, 0.1, 14}};
  static const double p[4][6] = {{0.1312, 0.1696, 0.5569, 0.0124, 0.8283, 0.5886},
                                 {0.2329, 0.4135, 0.8307, 0.3736, 0.1004, 0.9991},
                                 {0.2348, 0.1451, 0.3522, 0.2883, 0.3047, 0.6650},
                                 {0.4047, 0.8828, 0.8732, 0.5743, 0.1091, 0.0381}};
  static const double c[4] = {1, 1.2, 3, 3.2};
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    double exponent = 0;
    for (int k = 0; k < 6; ++k) exponent += a[i][k] * Square(x[k] - p[i][k]);
    sum -= c[i] * std::exp(-exponent);
  }
  return sum;
}

}  // namespace kingpin::optimisation
