#include <cmath>

#include <fmt/format.h>

#include "models/validation/cases.h"
#include "models/validation/extrapolation.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kGravity = 9.81;
constexpr double kDuration = 10;

// N windows of thin rods, 1 kg and 1 m each. Every loop is cut at the right end of its coupler by a
// full spatial hinge, whose rows z, turn_x and turn_y are redundant.
Mechanism MakeRow(int windows) {
  MechanismDescription d;
  d.name = fmt::format("{}-four-bar", windows);
  d.gravity = {0, -kGravity, 0};
  for (int i = 0; i <= windows; ++i) {
    const std::string link = fmt::format("link {}", i);
    d.bodies.push_back(MakeThinRod(link, 1, {0, 1, 0}));
    d.joints.push_back(MakeJoint(fmt::format("A{:02}", i), JointType::kRevolute, kWorld,
                                 {static_cast<double>(i), 0, 0}, link));
    if (i == 0) d.joints.back().velocity = {-1};  // turns towards +x
    if (i == windows) break;
    const std::string coupler = fmt::format("coupler {}", i);
    d.bodies.push_back(MakeThinRod(coupler, 1, {1, 0, 0}));
    d.joints.push_back(
        MakeJoint(fmt::format("B{:02}", i), JointType::kRevolute, link, {0, 1, 0}, coupler));
    d.closures.push_back(MakeClosure(fmt::format("C{:02}", i), ClosureType::kRevolute,
                                     At(coupler, {1, 0, 0}),
                                     At(fmt::format("link {}", i + 1), {0, 1, 0})));
  }
  return MakeMechanism(d);
}

struct Result {
  int freedoms = 0;
  double place = 0, branch = 0;
  solve::Ledger ledger;
};

// θ from above: θ'' = a sin θ on the branch of parallelograms.
Result CalcResult(int windows, double tolerance, double sample_interval) {
  const Real n = windows;
  const Real a = Real(kGravity) * ((n + 1) / 2 + n) / ((n + 1) / 3 + n);
  const Rates rates = [a](Real, const State& s, State& r) {
    r[0] = s[1];
    r[1] = a * std::sin(s[0]);
  };
  State reference = {0, 1};
  double reached = 0;
  const Mechanism row = MakeRow(windows);
  Result result;
  result.freedoms = CountFreedoms(row);
  const Motion motion = Run(
      row, MakeOptions(solve::Method::kExplicit8, tolerance, kDuration, sample_interval),
      [&](double time, std::span<const double> y, mechanism::Evaluator&) {
        if (time > reached) Integrate(rates, reached, time, reference);
        reached = time;
        const double theta = -y[row.GetJoint("A00").q];
        result.place = std::max(
            {result.place, std::abs(std::sin(theta) - static_cast<double>(std::sin(reference[0]))),
             std::abs(std::cos(theta) - static_cast<double>(std::cos(reference[0])))});
        for (int i = 0; i < windows; ++i) {
          // couplers stay level
          const double tilt = y[row.GetJoint(fmt::format("A{:02}", i)).q] +
                              y[row.GetJoint(fmt::format("B{:02}", i)).q];
          result.branch = std::max(result.branch, std::abs(tilt));
        }
      });
  result.ledger = motion.ledger;
  return result;
}

std::vector<Check> Calc() {
  std::vector<Check> checks;
  // Nearer to the noise of the singular positions there is nothing to gain: with 40 loops, steps
  // shrink into them below 1e-8.
  for (int windows : {2, 40}) {
    const double tolerance = windows == 2 ? 1e-8 : 1e-7;
    const Result fine = CalcResult(windows, tolerance, 0.05);
    const auto name = [&](const char* what) {
      return fmt::format("N = {}, {:g}: {}", windows, tolerance, what);
    };
    checks.push_back(Compare(name("degrees of freedom"), 1, fine.freedoms, 0));
    checks.push_back(Bound(name("end B0, largest error [m]"), fine.place, 1e-5));
    checks.push_back(Bound(name("tilt of couplers [rad]"), fine.branch, 1e-6));
    checks.push_back(Bound(name("energy, drift [J]"), fine.ledger.largest_energy_error, 1e-6));
    checks.push_back(
        Bound(name("loops, residual [m, rad]"), fine.ledger.largest_position_residual, 1e-9));
  }
  // samples far apart, so that the tolerance alone sets the steps
  checks.push_back(CheckConvergence("end B0, N = 2, 1e-9", CalcResult(2, 1e-7, 0.5).place,
                                    CalcResult(2, 1e-9, 0.5).place));
  return checks;
}

}  // namespace

Case MakeFourBarRowCase() {
  return {
      "A02", "row of N four-bars through singular positions, spatial hinges, 10 s, explicit 8",
      "Gonzalez et al. (2006); Bayo and Avello, Nonlinear Dynamics 5 (1994); exact: a pendulum's "
      "equation",
      Calc};
}

}  // namespace kingpin::validation
