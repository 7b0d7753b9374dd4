#pragma once

#include "core/solve/rosenbrock.h"
#include "core/solve/runge_kutta4.h"
#include "core/solve/stepper.h"

namespace kingpin::solve {

/// RungeKutta4 or Rosenbrock at a fixed step, with projection after every step.
std::unique_ptr<Stepper> MakeFixedStep(mechanism::Evaluator& evaluator,
                                       const StepperOptions& options);

}  // namespace kingpin::solve
