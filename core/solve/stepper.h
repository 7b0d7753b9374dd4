#pragma once

#include <memory>
#include <span>

#include "core/mechanism/evaluator.h"

namespace kingpin::solve {

/// How time is integrated.
enum class Method {
  kRosenbrock,   ///< fixed step, linearly implicit, L-stable, order 3: the default
  kRungeKutta4,  ///< fixed step, explicit, order 4
  kExplicit8,  ///< adaptive, explicit, order 8 (ARKODE, Fehlberg 13-7-8): the reference for what is
               ///< not stiff
  kBdf,  ///< adaptive, implicit (CVODE, backward differentiation): the reference for what is stiff
};

struct StepperOptions {
  Method method = Method::kRosenbrock;
  double step = 5e-4;                ///< of fixed-step methods [s]
  int jacobian_every = 1;            ///< steps that share one Jacobian (Rosenbrock)
  double relative_tolerance = 1e-9;  ///< of adaptive methods
  double absolute_tolerance = 1e-11;
  double projection_tolerance =
      1e-10;  ///< constraints are met to this after every step [m, rad, and per s]
};

/// Advances one trajectory. Between two steps the caller may change y or the evaluator's modes and
/// then calls Restart.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// One step of the method's own choice from (time, y), at most to `limit`. Constraints are met at
  /// its end.
  /// @returns the time reached
  /// @throws std::runtime_error if the method fails there
  virtual double Advance(double time, double limit, std::span<double> y) = 0;
  /// y from time to `end`, which lies within the last step taken from there, for locating events.
  virtual void Redo(double time, double end, std::span<double> y) = 0;
  virtual void Restart() {}

  long steps = 0, jacobians = 0;
};

std::unique_ptr<Stepper> MakeStepper(mechanism::Evaluator& evaluator,
                                     const StepperOptions& options);

}  // namespace kingpin::solve
