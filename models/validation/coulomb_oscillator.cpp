#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "models/validation/block.h"
#include "models/validation/cases.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kMass = 2, kStiffness = 50, kGravity = 9.81, kStart = 1;
constexpr double kStatic = 0.3, kKinetic = 0.2;

struct Result {
  std::vector<double> turns, places;  // where the velocity comes to zero
  double creep = 0;
  bool held = false;
  solve::Ledger ledger;
};

Result CalcResult(solve::Method method, double tolerance, double step) {
  joints::FrictionDescription friction;
  friction.static_coefficient = kStatic;
  friction.kinetic_coefficient = kKinetic;
  friction.from_joint = true;
  Mechanism block = MakeBlock(kMass, kStart, 0, kGravity, friction);
  AddSpring(kStiffness, block);
  solve::SimulationOptions options = MakeOptions(method, tolerance, 110);
  options.stepper.step = step;
  options.sample_interval = 0;  // modes are seen to change at every step
  Result result;
  int mode = 0;
  Run(block, options, [&](double time, std::span<const double> y, mechanism::Evaluator& evaluator) {
    const int now = evaluator.modes()[0];
    if (time > 0 && now != mode) {
      result.turns.push_back(time);
      result.places.push_back(y[0]);
      result.held = now == 0;
    }
    mode = now;
    if (result.held) {
      result.creep = std::max(result.creep, std::abs(y[0] - result.places.back()));
    }
  });
  return result;
}

std::vector<Check> Calc() {
  const double half = std::numbers::pi * std::sqrt(kMass / kStiffness);
  const double fall = 2 * kKinetic * kMass * kGravity / kStiffness;
  const double hold = kStatic * kMass * kGravity / kStiffness;
  std::vector<double> places;
  double size = kStart;
  do {
    size -= fall;
    places.push_back(places.size() % 2 == 0 ? -size : size);
  } while (size > hold);
  const int turns = static_cast<int>(places.size());
  std::vector<Check> checks;
  double step_errors[2] = {};
  struct Setting {
    const char* name;
    solve::Method method;
    double tolerance, step, allowed;
  };
  // adaptive: 1e-8 s; fixed step: a step of 1e-3 s leaves its own error
  const Setting settings[] = {{"explicit 8, 1e-11", solve::Method::kExplicit8, 1e-11, 0, 1e-8},
                              {"BDF, 1e-11", solve::Method::kBdf, 1e-11, 0, 1e-8},
                              {"Rosenbrock, 2e-3 s", solve::Method::kRosenbrock, 1e-9, 2e-3, 1e-4},
                              {"Rosenbrock, 1e-3 s", solve::Method::kRosenbrock, 1e-9, 1e-3, 1e-5}};
  for (const Setting& setting : settings) {
    const Result result = CalcResult(setting.method, setting.tolerance, setting.step);
    const auto name = [&](const char* what) { return fmt::format("{}, {}", what, setting.name); };
    checks.push_back(
        Compare(name("turns until it sticks"), turns, static_cast<double>(result.turns.size()), 0));
    double place = 0, time = 0;
    for (int k = 0; k < std::min(turns, static_cast<int>(result.turns.size())); ++k) {
      place = std::max(place, std::abs(result.places[k] - places[k]));
      time = std::max(time, std::abs(result.turns[k] - (k + 1) * half));
    }
    checks.push_back(Bound(name("turning points [m]"), place, setting.allowed));
    checks.push_back(Bound(name("times of turns and stop [s]"), time, setting.allowed));
    checks.push_back(Bound(name("creep after the stop, 100 s [m]"), result.creep, 1e-12));
    if (setting.step == 2e-3) step_errors[0] = time;
    if (setting.step == 1e-3) step_errors[1] = time;
  }
  checks.push_back({"share of the time error left by half the step, Rosenbrock (order 1: 0.5)", 0.5,
                    step_errors[1] / step_errors[0], step_errors[1] / step_errors[0], 0.5});
  return checks;
}

}  // namespace

Case MakeCoulombOscillatorCase() {
  return {"F01", "oscillator with Coulomb friction until it sticks, 110 s",
          "Den Hartog, Mechanical Vibrations: half cycles about +-F/k", Calc};
}

}  // namespace kingpin::validation
