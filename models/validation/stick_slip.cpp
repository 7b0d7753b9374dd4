#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "models/validation/block.h"
#include "models/validation/cases.h"
#include "models/validation/extrapolation.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

// unit mass and stiffness
constexpr double kStatic = 1, kKinetic = 0.5, kBelt = 0.2, kFading = 3;

struct Cycle {
  double slip = 0, period = 0;
};

// A: x = F_d + (F_s - F_d) cos t + v sin t until the velocity is the belt's again; there x = 2 F_d
// - F_s.
Cycle CalcConstant() {
  const double slip = 2 * std::numbers::pi - 2 * std::atan((kStatic - kKinetic) / kBelt);
  return {slip, slip + 2 * (kStatic - kKinetic) / kBelt};
}

// B: ẍ = F_s/(1 + δ (v - ẋ)) - x from x = F_s, ẋ = v until ẋ = v again, then sticking back to F_s.
Cycle CalcFading() {
  const Rates rates = [](Real, const State& s, State& r) {
    r[0] = s[1];
    r[1] = kStatic / (1 + kFading * (kBelt - s[1])) - s[0];
  };
  State s = {kStatic, kBelt}, before = s, rate(2);
  Real time = 0;
  constexpr Real kStep = 0.05L;
  do {
    before = s;
    Integrate(rates, time, time + kStep, s);
    time += kStep;
  } while (s[1] <= kBelt);
  s = before;
  time -= kStep;
  Real part = kStep / 2;
  for (int k = 0; k < 20; ++k) {  // Newton on the instant
    s = before;
    Integrate(rates, time, time + part, s);
    rates(0, s, rate);
    const Real step = (s[1] - kBelt) / rate[1];
    part -= step;
    if (std::abs(step) < 1e-17L) break;
  }
  const Real slip = time + part;
  return {static_cast<double>(slip), static_cast<double>(slip + (kStatic - s[0]) / kBelt)};
}

struct Result {
  std::vector<double> breaks, sticks;
  double error = 0;  // of the velocity while sticking
};

Result CalcResult(bool fading, solve::Method method, double step) {
  joints::FrictionDescription friction;
  friction.static_force = kStatic;
  friction.kinetic_force = fading ? 0 : kKinetic;
  if (fading) {
    friction.stribeck = mechanism::Friction::Stribeck::kHyperbolic;
    friction.stribeck_speed = 1 / kFading;
  }
  friction.counterpart = [](double t) { return std::array<double, 3>{kBelt * t, kBelt, 0}; };
  Mechanism block = MakeBlock(1, 0, kBelt, 0, friction);
  AddSpring(1, block);
  solve::SimulationOptions options = MakeOptions(method, 1e-11, 60);
  options.stepper.step = step;
  options.sample_interval = 0;
  Result result;
  int mode = 0;
  Run(block, options, [&](double time, std::span<const double> y, mechanism::Evaluator& evaluator) {
    const int now = evaluator.modes()[0];
    if (time > 0 && mode == 0 && now != 0) result.breaks.push_back(time);
    if (time > 0 && mode != 0 && now == 0) result.sticks.push_back(time);
    mode = now;
    if (mode == 0) result.error = std::max(result.error, std::abs(y[1] - kBelt));
  });
  return result;
}

std::vector<Check> Calc() {
  std::vector<Check> checks;
  struct Setting {
    const char* name;
    solve::Method method;
    double step, allowed;
  };
  const Setting settings[] = {{"explicit 8, 1e-11", solve::Method::kExplicit8, 0, 1e-8},
                              {"BDF, 1e-11", solve::Method::kBdf, 0, 1e-8},
                              // of a fixed step of 1e-3 s
                              {"Rosenbrock, 1e-3 s", solve::Method::kRosenbrock, 1e-3, 1e-5}};
  for (bool fading : {false, true}) {
    const Cycle exact = fading ? CalcFading() : CalcConstant();
    for (const Setting& setting : settings) {
      const double allowed = setting.allowed;
      const Result result = CalcResult(fading, setting.method, setting.step);
      const auto name = [&](const char* what) {
        return fmt::format("{}: {}, {}", fading ? 'B' : 'A', what, setting.name);
      };
      if (result.breaks.size() < 4 || result.sticks.size() < 3) {
        checks.push_back(Compare(name("cycles in 60 s, at least"), 4,
                                 static_cast<double>(result.breaks.size()), 0));
        continue;
      }
      checks.push_back(
          Compare(name("first break-away [s]"), kStatic / kBelt, result.breaks[0], allowed));
      checks.push_back(Compare(name("time of slip [s]"), exact.slip,
                               result.sticks[1] - result.breaks[1], allowed));
      checks.push_back(CompareRelative(name("period [s]"), exact.period,
                                       result.breaks[3] - result.breaks[2], allowed));
      checks.push_back(
          Bound(name("velocity while sticking against the belt's [m/s]"), result.error, 1e-10));
    }
  }
  return checks;
}

}  // namespace

Case MakeStickSlipCase() {
  return {"F02", "block on a belt: stick-slip, A constant and B fading kinetic friction, 60 s",
          "A: closed form (Rabinowicz 1958); B: law of Leine et al., Nonlinear Dynamics 16 (1998) "
          "41, by extrapolation",
          Calc};
}

}  // namespace kingpin::validation
