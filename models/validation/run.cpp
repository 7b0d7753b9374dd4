#include "models/validation/run.h"

#include <algorithm>

namespace kingpin::validation {

solve::SimulationOptions MakeOptions(solve::Method method, double tolerance, double duration,
                                     double sample_interval) {
  solve::SimulationOptions options;
  options.stepper.method = method;
  options.stepper.relative_tolerance = tolerance;
  options.stepper.absolute_tolerance = 0.01 * tolerance;
  options.stepper.projection_tolerance = std::max(0.01 * tolerance, 1e-13);
  options.duration = duration;
  options.sample_interval = sample_interval > 0 ? sample_interval : duration;
  return options;
}

Motion Run(const Mechanism& mechanism, const solve::SimulationOptions& options,
           const solve::Observer& observe) {
  Motion motion;
  motion.y = mechanism.start;
  motion.ledger = solve::Simulate(mechanism.system, options, motion.y, observe);
  return motion;
}

}  // namespace kingpin::validation
