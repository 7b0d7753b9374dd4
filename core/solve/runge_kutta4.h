#pragma once

#include <span>
#include <vector>

#include "core/mechanism/evaluator.h"

namespace kingpin::solve {

/// The classical Runge-Kutta method of order 4 at a fixed step, the paper's choice. Explicit:
/// stable to about 2.8/|λ| only.
class RungeKutta4 {
 public:
  explicit RungeKutta4(const mechanism::System& system);

  /// y from time to time + step; constraints are not projected here.
  void Step(mechanism::Evaluator& evaluator, double time, double step, std::span<double> y);

 private:
  std::vector<double> k1_, k2_, k3_, k4_, stage_;
};

}  // namespace kingpin::solve
