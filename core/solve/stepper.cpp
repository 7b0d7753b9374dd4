#include "core/solve/stepper.h"

#include "core/solve/adaptive.h"
#include "core/solve/fixed_step.h"

namespace kingpin::solve {

std::unique_ptr<Stepper> MakeStepper(mechanism::Evaluator& evaluator,
                                     const StepperOptions& options) {
  // The adaptive libraries want something to control.
  if (evaluator.system().size() == 0) return MakeFixedStep(evaluator, options);
  switch (options.method) {
    case Method::kRosenbrock:
    case Method::kRungeKutta4:
      return MakeFixedStep(evaluator, options);
    case Method::kExplicit8:
    case Method::kBdf:
      return MakeAdaptive(evaluator, options);
  }
  return nullptr;
}

}  // namespace kingpin::solve
