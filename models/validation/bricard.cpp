#include <cmath>

#include <fmt/format.h>

#include "models/validation/cases.h"
#include "models/validation/one_freedom.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kDuration = 10;

const Vector3<double> kPoints[] = {{0, 0, 0},  {1, 0, 0},  {1, -1, 0},
                                   {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
const Vector3<double> kAxes[] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};

// Five thin bars and the ground, six hinges; cut at P6.
Mechanism MakeBricard() {
  MechanismDescription d;
  d.name = "Bricard";
  d.gravity = {0, -9.81, 0};
  for (int i = 0; i < 5; ++i) {
    const std::string bar = fmt::format("bar {}", i + 1);
    const std::string before = i == 0 ? kWorld : fmt::format("bar {}", i);
    d.bodies.push_back(MakeThinRod(bar, 1, kPoints[i + 1] - kPoints[i]));
    d.joints.push_back(MakeJoint(fmt::format("P{}", i + 1), JointType::kRevolute, before,
                                 i == 0 ? kPoints[0] : kPoints[i] - kPoints[i - 1], bar, kAxes[i]));
  }
  d.closures = {MakeClosure("P6", ClosureType::kRevolute,
                            At("bar 5", kPoints[5] - kPoints[4], kAxes[5]),
                            At(kWorld, kPoints[5], kAxes[5]))};
  return MakeMechanism(d);
}

struct Hinges {
  std::array<Vector3<Real>, 6> place{}, rate{};  // rate per unit of the odd hinges' rate
};

// For the angle a of the odd hinges; b of the even ones on the branch cos b > 0 of
// sin a + sin b + sin a sin b = 0.
Hinges CalcHinges(Real a) {
  const Real sine = -std::sin(a) / (1 + std::sin(a));
  const Real b = std::asin(sine);
  const Real b_rate = -std::cos(a) * (1 + sine) / (std::cos(b) * (1 + std::sin(a)));
  Hinges hinges;
  Rotation<Real> R;
  Vector3<Real> spin;
  for (int i = 0; i < 5; ++i) {
    const Vector3<Real> n = math::Convert<Real>(kAxes[i]);
    spin += (i % 2 == 0 ? Real(1) : b_rate) * (R * n);
    const Real c = std::cos(i % 2 == 0 ? a : b), s = std::sin(i % 2 == 0 ? a : b);
    const auto turn = [&](const Vector3<Real>& e) {  // Rodrigues' formula
      return c * e + s * Cross(n, e) + ((1 - c) * Dot(n, e)) * n;
    };
    R = R * Rotation<Real>{turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})};
    const Vector3<Real> bar = R * math::Convert<Real>(kPoints[i + 1] - kPoints[i]);
    hinges.place[i + 1] = hinges.place[i] + bar;
    hinges.rate[i + 1] = hinges.rate[i] + Cross(spin, bar);
  }
  return hinges;
}

// A(a) of the kinetic energy 1/2 A ȧ²: m/3 (u² + u·w + w²) of each thin bar, u and w the rates of
// its ends.
Real CalcInertia(Real a) {
  const auto rate = CalcHinges(a).rate;
  Real sum = 0;
  for (int i = 0; i < 5; ++i) {
    sum += Dot(rate[i], rate[i]) + Dot(rate[i], rate[i + 1]) + Dot(rate[i + 1], rate[i + 1]);
  }
  return sum / 3;
}

Real CalcPotential(Real a) {
  const auto points = CalcHinges(a).place;
  Real sum = 0;
  for (int i = 0; i < 5; ++i) sum += Real(9.81) * (points[i].y + points[i + 1].y) / 2;
  return sum;
}

struct Result {
  int freedoms = 0;
  double relation = 0, angle = 0;
  solve::Ledger ledger;
};

Result CalcResult(solve::Method method, double tolerance) {
  const Mechanism bricard = MakeBricard();
  const Rates rates = MakeOneFreedom(CalcInertia, CalcPotential);
  State reference = {0, 0};
  double reached = 0;
  Result result;
  result.freedoms = CountFreedoms(bricard);
  const Motion motion = Run(
      bricard, MakeOptions(method, tolerance, kDuration, 0.1),
      [&](double time, std::span<const double> y, mechanism::Evaluator&) {
        if (time > reached) Integrate(rates, reached, time, reference, 1e-13L);
        reached = time;
        result.angle = std::max(result.angle, std::abs(y[0] - static_cast<double>(reference[0])));
        const double a = std::sin(y[0]), b = std::sin(y[1]);
        // all odd angles are equal, all even ones too
        result.relation = std::max({result.relation, std::abs(a + b + a * b), std::abs(y[2] - y[0]),
                                    std::abs(y[4] - y[0]), std::abs(y[3] - y[1])});
      });
  result.ledger = motion.ledger;
  return result;
}

std::vector<Check> Calc() {
  const Result result = CalcResult(solve::Method::kExplicit8, 1e-11);
  return {
      Compare("degrees of freedom (5 hinges in the tree, 5 rows)", 1, result.freedoms, 0),
      Bound("sin a + sin b + sin a sin b, and equal angles, largest error", result.relation, 1e-9),
      Bound("loop, residual [m, rad]", result.ledger.largest_position_residual, 1e-9),
      Bound("energy, drift [J]", result.ledger.largest_energy_error, 1e-8),
      Bound("first hinge, largest error [rad]", result.angle, 1e-8)};
}

}  // namespace

Case MakeBricardCase() {
  return {
      "A04", "Bricard's overconstrained six-bar, thin rods, 10 s, explicit 8, 1e-11",
      "Gonzalez et al. (2006); closed relation of the angles of the threefold-symmetric linkage",
      Calc};
}

}  // namespace kingpin::validation
