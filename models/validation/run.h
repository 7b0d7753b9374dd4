#pragma once

#include <span>
#include <vector>

#include "core/solve/simulate.h"
#include "models/validation/parts.h"

namespace kingpin::validation {

/// A mechanism's motion from its start, with all books.
struct Motion {
  std::vector<double> y;  ///< at the end
  solve::Ledger ledger;
  double largest_energy_error() const { return ledger.largest_energy_error; }
};

/// Settings of an adaptive method: absolute tolerance a hundredth of the relative one, constraints
/// closed to the larger of that and 1e-13.
solve::SimulationOptions MakeOptions(solve::Method method, double tolerance, double duration,
                                     double sample_interval = 0);

Motion Run(
    const Mechanism& mechanism, const solve::SimulationOptions& options,
    const solve::Observer& observe = [](double, std::span<const double>, mechanism::Evaluator&) {});

}  // namespace kingpin::validation
