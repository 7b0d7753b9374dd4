#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "models/validation/cases.h"
#include "models/validation/elliptic.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kGravity = 9.81;
constexpr double kDuration = 10;

// A point mass of 1 kg, 1 m from a hinge at the origin along z, released from rest at x = 1 m.
Mechanism MakePendulum() {
  MechanismDescription d;
  d.name = "pendulum";
  d.gravity = {0, -kGravity, 0};
  d.bodies = {MakeBody("rod", 1, {1, 0, 0}, {})};
  d.joints = {MakeJoint("hinge", JointType::kRevolute, kWorld, {}, "rod")};
  return MakeMechanism(d);
}

struct Errors {
  double place = 0, force = 0, energy = 0;
};

// Angle from below: sin(φ/2) = k sn(ωt + K), k = sin(π/4), ω² = g; force of the hinge 3 m g cos φ
// along the rod.
Errors CalcErrors(solve::Method method, double tolerance) {
  const Real rate = std::sqrt(Real(kGravity)), complement = 0.5L;
  const Real quarter = CalcQuarterPeriod(complement);
  Errors errors;
  const Mechanism pendulum = MakePendulum();
  const Motion motion = Run(
      pendulum, MakeOptions(method, tolerance, kDuration, 0.5),
      [&](double time, std::span<const double> y, mechanism::Evaluator& evaluator) {
        const Real half = std::sqrt(0.5L) * CalcJacobi(rate * time + quarter, complement).sn;
        const Real x = 2 * half * std::sqrt(1 - half * half), height = 2 * half * half - 1;
        errors.place = std::max({errors.place, std::abs(std::cos(y[0]) - static_cast<double>(x)),
                                 std::abs(std::sin(y[0]) - static_cast<double>(height))});
        const double pull = static_cast<double>(-3 * kGravity * height);
        const Vector3<double> force = evaluator.CalcJointWrenches()[1].f;
        errors.force =
            std::max(errors.force,
                     CalcNorm(force - Vector3<double>{static_cast<double>(-x) * pull,
                                                      static_cast<double>(-height) * pull, 0}));
      });
  errors.energy = motion.ledger.largest_energy_error;
  return errors;
}

std::vector<Check> Calc() {
  const Errors coarse = CalcErrors(solve::Method::kExplicit8, 1e-8);
  const Errors fine = CalcErrors(solve::Method::kExplicit8, 1e-10);
  const Errors bdf = CalcErrors(solve::Method::kBdf, 1e-10);
  return {Bound("place, explicit 8, 1e-10, largest error [m]", fine.place, 1e-8),
          Bound("hinge force, explicit 8, 1e-10, largest error [N]", fine.force, 1e-6),
          Bound("energy, explicit 8, 1e-10, drift [J]", fine.energy, 1e-8),
          Bound("place, BDF, 1e-10, largest error [m]", bdf.place, 1e-5),
          Bound("energy, BDF, 1e-10, drift [J]", bdf.energy, 5e-5),
          CheckConvergence("place, explicit 8, 1e-10", coarse.place, fine.place)};
}

}  // namespace

Case MakePendulumCase() {
  return {"A01", "planar simple pendulum, 10 s",
          "Gonzalez et al., Multibody Syst Dyn 16 (2006) 179; closed form in Jacobi's functions",
          Calc};
}

}  // namespace kingpin::validation
