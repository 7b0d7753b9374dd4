#include "core/solve/fixed_step.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace kingpin::solve {

namespace {

// The last piece before a limit is stretched by this much rather than followed by a sliver.
constexpr double kSliver = 1e-9;

void CheckFinite(double time, std::span<const double> y) {
  for (double value : y) {
    if (!std::isfinite(value)) {
      throw std::runtime_error(fmt::format(
          "the motion grows beyond all bounds at t = {:g} s; a shorter step may help", time));
    }
  }
}

class RungeKutta4Stepper : public Stepper {
 public:
  RungeKutta4Stepper(mechanism::Evaluator& evaluator, const StepperOptions& options)
      : evaluator_(evaluator), options_(options), method_(evaluator.system()) {}

  double Advance(double time, double limit, std::span<double> y) override {
    const double end = time + options_.step * (1 + kSliver) >= limit ? limit : time + options_.step;
    Redo(time, end, y);
    ++steps;
    return end;
  }
  void Redo(double time, double end, std::span<double> y) override {
    method_.Step(evaluator_, time, end - time, y);
    CheckFinite(end, y);
    evaluator_.Project(end, y, options_.projection_tolerance, 0);
  }

 private:
  mechanism::Evaluator& evaluator_;
  StepperOptions options_;
  RungeKutta4 method_;
};

class RosenbrockStepper : public Stepper {
 public:
  RosenbrockStepper(mechanism::Evaluator& evaluator, const StepperOptions& options)
      : evaluator_(evaluator), options_(options), method_(evaluator.system()) {}

  double Advance(double time, double limit, std::span<double> y) override {
    const double end = time + options_.step * (1 + kSliver) >= limit ? limit : time + options_.step;
    if (age_ >= options_.jacobian_every || age_ < 0) {
      method_.UpdateJacobian(evaluator_, time, y);
      ++jacobians;
      age_ = 0;
    }
    Redo(time, end, y);
    ++steps;
    ++age_;
    return end;
  }
  void Redo(double time, double end, std::span<double> y) override {
    method_.Step(evaluator_, time, end - time, y);
    CheckFinite(end, y);
    evaluator_.Project(end, y, options_.projection_tolerance, 0);
  }
  void Restart() override { age_ = -1; }

 private:
  mechanism::Evaluator& evaluator_;
  StepperOptions options_;
  Rosenbrock method_;
  int age_ = -1;
};

}  // namespace

std::unique_ptr<Stepper> MakeFixedStep(mechanism::Evaluator& evaluator,
                                       const StepperOptions& options) {
  if (options.method == Method::kRungeKutta4) {
    return std::make_unique<RungeKutta4Stepper>(evaluator, options);
  }
  return std::make_unique<RosenbrockStepper>(evaluator, options);
}

}  // namespace kingpin::solve
