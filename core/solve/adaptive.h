#pragma once

#include "core/solve/stepper.h"

namespace kingpin::solve {

/// CVODE (backward differentiation, dense exact Jacobian) or ARKODE (explicit, order 8), with
/// projection onto the constraints after every step. One SUNDIALS context each, so that steppers of
/// different threads share nothing.
std::unique_ptr<Stepper> MakeAdaptive(mechanism::Evaluator& evaluator,
                                      const StepperOptions& options);

}  // namespace kingpin::solve
