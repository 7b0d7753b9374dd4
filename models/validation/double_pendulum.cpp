#include <cmath>
#include <numbers>

#include "models/validation/cases.h"
#include "models/validation/extrapolation.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kGravity = 9.81;

Mechanism MakeDoublePendulum() {
  MechanismDescription d;
  d.name = "double pendulum";
  d.gravity = {0, -kGravity, 0};
  d.bodies = {MakeThinRod("first", 1, {1, 0, 0}), MakeThinRod("second", 1, {1, 0, 0})};
  d.joints = {MakeJoint("A", JointType::kRevolute, kWorld, {}, "first"),
              MakeJoint("B", JointType::kRevolute, "first", {1, 0, 0}, "second")};
  return MakeMechanism(d);
}

// Absolute angles a, b from below, counter-clockwise; two equal thin rods (m = L = 1):
//   4/3 a'' + 1/2 cos(a-b) b'' = -1/2 sin(a-b) b'² - 3/2 g sin a
//   1/2 cos(a-b) a'' + 1/3 b'' = +1/2 sin(a-b) a'² - 1/2 g sin b
void CalcRates(Real, const State& s, State& r) {
  const Real g = kGravity, c = std::cos(s[0] - s[1]) / 2, d = std::sin(s[0] - s[1]) / 2;
  const Real f = -d * s[3] * s[3] - 1.5L * g * std::sin(s[0]);
  const Real h = d * s[2] * s[2] - 0.5L * g * std::sin(s[1]);
  const Real determinant = 4.0L / 9 - c * c;
  r[0] = s[2];
  r[1] = s[3];
  r[2] = (f / 3 - c * h) / determinant;
  r[3] = (4 * h / 3 - c * f) / determinant;
}

struct Errors {
  double to5 = 0, to10 = 0, energy = 0;
};

Errors CalcErrors(solve::Method method, double tolerance) {
  const Real quarter = std::numbers::pi_v<Real> / 2;
  State reference = {quarter, quarter, 0, 0};
  double reached = 0;
  Errors errors;
  const Mechanism pendulum = MakeDoublePendulum();
  const Motion motion =
      Run(pendulum, MakeOptions(method, tolerance, 10, 0.25),
          [&](double time, std::span<const double> y, mechanism::Evaluator&) {
            if (time > reached) Integrate(CalcRates, reached, time, reference);
            reached = time;
            const double error =
                std::max(std::abs(y[0] - static_cast<double>(reference[0] - quarter)),
                         std::abs(y[0] + y[1] - static_cast<double>(reference[1] - quarter)));
            errors.to10 = std::max(errors.to10, error);
            if (time <= 5) errors.to5 = std::max(errors.to5, error);
          });
  errors.energy = motion.ledger.largest_energy_error;
  return errors;
}

std::vector<Check> Calc() {
  const Errors coarse = CalcErrors(solve::Method::kExplicit8, 1e-8);
  const Errors fine = CalcErrors(solve::Method::kExplicit8, 1e-10);
  const Errors bdf = CalcErrors(solve::Method::kBdf, 1e-10);
  return {Bound("angles to 5 s, explicit 8, 1e-10, largest error [rad]", fine.to5, 1e-8),
          Bound("angles to 10 s, explicit 8, 1e-10, largest error [rad]", fine.to10, 1e-3),
          Bound("energy, explicit 8, 1e-10, drift [J]", fine.energy, 1e-7),
          Bound("angles to 5 s, BDF, 1e-10, largest error [rad]", bdf.to5, 5e-6),
          Bound("angles to 10 s, BDF, 1e-10, largest error [rad]", bdf.to10, 1e-3),
          CheckConvergence("angles to 5 s, explicit 8, 1e-10", coarse.to5, fine.to5)};
}

}  // namespace

Case MakeDoublePendulumCase() {
  return {"C03", "double pendulum of two thin rods, released level, 10 s",
          "classical; reference by extrapolation of the equations in absolute angles", Calc};
}

}  // namespace kingpin::validation
