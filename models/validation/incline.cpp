#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "joints/add_forces.h"
#include "models/validation/block.h"
#include "models/validation/cases.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kMass = 3, kGravity = 9.81, kTiltRate = 0.05, kStatic = 0.4, kKinetic = 0.3;
constexpr double kSlideTime = 1;

// Weight that turns in the frame of the plane: m g (sin α, 0, -cos α) at the centre, α = ω t.
std::vector<joints::ForceDescription> MakeTurningWeight() {
  joints::BodyForceDescription along, across;
  along.name = "along";
  along.at = across.at = {"block", {}};
  along.force = {kMass * kGravity, 0, 0};
  along.scale = [](double t) { return std::sin(kTiltRate * t); };
  across.name = "across";
  across.force = {0, 0, -kMass * kGravity};
  across.scale = [](double t) { return std::cos(kTiltRate * t); };
  return {std::move(along), std::move(across)};
}

struct Result {
  double release = 0, creep = 0, place = 0;
};

// s̈ = g (sin α - μ cos α), integrated twice from rest at α0.
double CalcPlace(double time, double release) {
  const double w = kTiltRate, a0 = w * release, a = w * time;
  const double first = -std::sin(a) + std::sin(a0) + kKinetic * (std::cos(a) - std::cos(a0));
  return kGravity / (w * w) * (first + (std::cos(a0) + kKinetic * std::sin(a0)) * (a - a0));
}

Result CalcResult(solve::Method method, double release) {
  joints::FrictionDescription friction;
  friction.static_coefficient = kStatic;
  friction.kinetic_coefficient = kKinetic;
  friction.from_joint = true;
  Mechanism block = MakeBlock(kMass, 0, 0, 0, friction);
  AddForces(MakeTurningWeight(), block);
  solve::SimulationOptions options = MakeOptions(method, 1e-11, release + kSlideTime);
  options.sample_interval = 0;
  Result result;
  bool slides = false;
  Run(block, options, [&](double time, std::span<const double> y, mechanism::Evaluator& evaluator) {
    if (!slides) {
      result.creep = std::max(result.creep, std::abs(y[0]));
      slides = evaluator.modes()[0] != 0;
      result.release = time;
      return;
    }
    result.place = std::max(result.place, std::abs(y[0] - CalcPlace(time, release)));
  });
  return result;
}

std::vector<Check> Calc() {
  const double release = std::atan(kStatic) / kTiltRate;
  std::vector<Check> checks;
  for (const auto& [name, method] : {std::pair{"explicit 8, 1e-11", solve::Method::kExplicit8},
                                     std::pair{"BDF, 1e-11", solve::Method::kBdf}}) {
    const Result result = CalcResult(method, release);
    checks.push_back(
        Compare(fmt::format("break-away [s], {}", name), release, result.release, 1e-8));
    checks.push_back(Bound(fmt::format("creep before [m], {}", name), result.creep, 1e-12));
    checks.push_back(
        Bound(fmt::format("place while sliding [m], {}, largest error", name), result.place, 1e-7));
  }
  return checks;
}

}  // namespace

Case MakeInclineCase() {
  return {"F03", "block on a plane that tilts: break-away and sliding",
          "elementary: tan a = mu; gravity turns in the frame of the plane", Calc};
}

}  // namespace kingpin::validation
