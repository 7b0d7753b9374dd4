#include <cmath>

#include "models/validation/cases.h"
#include "models/validation/one_freedom.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kCrank = 0.08, kRod = 0.3, kGravity = 9.81, kDuration = 5, kSpeed = 6;
constexpr double kA[] = {0.1, 0.12};  // y, z of the crank's axis
constexpr double kCrankInertia = 1e-4, kRodMass = 0.5, kAlong = 4e-4, kAcross = 4e-3, kSlider = 2;

// Crank and slider carry the loop; the rod hangs on the slider's universal joint and is cut from
// the crank at B. At zero angles it points along y, its second axis along z.
Mechanism MakeSliderCrank() {
  MechanismDescription d;
  d.name = "slider-crank";
  d.gravity = {0, 0, -kGravity};
  d.bodies = {MakeBody("crank", 0.12, {}, {kCrankInertia, kCrankInertia, kCrankInertia}),
              MakeBody("rod", kRodMass, {0, kRod / 2, 0}, {kAcross, kAlong, kAcross}),
              MakeBody("slider", kSlider, {}, {1e-4, 1e-4, 1e-4})};
  d.joints = {MakeJoint("A", JointType::kRevolute, kWorld, {0, kA[0], kA[1]}, "crank", {1, 0, 0}),
              MakeJoint("C", JointType::kUniversal, "slider", {}, "rod", {1, 0, 0}),
              MakeJoint("D", JointType::kPrismatic, kWorld, {}, "slider", {1, 0, 0})};
  d.joints[0].velocity = {kSpeed};
  d.joints[1].second_axis = {0, 0, 1};
  d.joints[0].position = {0};
  d.joints[1].position = {std::atan2(0.2, 0.1), std::asin(2.0 / 3)};
  d.joints[2].position = {0.2};
  d.closures = {MakeClosure("B", ClosureType::kSpherical, At("rod", {0, kRod, 0}),
                            At("crank", {0, 0, kCrank}))};
  return MakeMechanism(d);
}

struct Position {
  Real x, y, z, eta, beta;  // of the slider, of B, of the universal joint
};

Position CalcPosition(Real angle) {
  Position p;
  p.y = kA[0] - kCrank * std::sin(angle);
  p.z = kA[1] + kCrank * std::cos(angle);
  p.x = std::sqrt(Real(kRod) * kRod - p.y * p.y - p.z * p.z);
  p.eta = std::atan2(p.z, p.y);
  p.beta = std::asin(p.x / kRod);
  return p;
}

Position CalcRates(Real angle) {  // per radian of the crank
  const Position p = CalcPosition(angle);
  Position r;
  r.y = -kCrank * std::cos(angle);
  r.z = -kCrank * std::sin(angle);
  r.x = -(p.y * r.y + p.z * r.z) / p.x;
  r.eta = (p.y * r.z - p.z * r.y) / (p.y * p.y + p.z * p.z);
  r.beta = r.x / (kRod * std::cos(p.beta));
  return r;
}

// The rod turns with η̇ about X, of which -sin β is along it, and with β̇ about the second axis.
Real CalcInertia(Real angle) {
  const Position p = CalcPosition(angle), r = CalcRates(angle);
  const Real along = r.eta * std::sin(p.beta), across = r.eta * std::cos(p.beta);
  return kCrankInertia + kSlider * r.x * r.x + kRodMass * (r.x * r.x + r.y * r.y + r.z * r.z) / 4 +
         kAlong * along * along + kAcross * (across * across + r.beta * r.beta);
}

Real CalcPotential(Real angle) { return Real(kRodMass) * kGravity * CalcPosition(angle).z / 2; }

struct Errors {
  double crank = 0, slider = 0;
  solve::Ledger ledger;
};

Errors CalcErrors(const Mechanism& mechanism, solve::Method method, double tolerance) {
  const Rates rates = MakeOneFreedom(CalcInertia, CalcPotential);
  State reference = {0, kSpeed};
  double reached = 0;
  Errors errors;
  const Motion motion =
      Run(mechanism, MakeOptions(method, tolerance, kDuration, 0.1),
          [&](double time, std::span<const double> y, mechanism::Evaluator&) {
            if (time > reached) Integrate(rates, reached, time, reference, 1e-14L);
            reached = time;
            errors.crank = std::max(errors.crank, std::abs(y[mechanism.GetJoint("A").q] -
                                                           static_cast<double>(reference[0])));
            errors.slider = std::max(errors.slider,
                                     std::abs(y[mechanism.GetJoint("D").q] -
                                              static_cast<double>(CalcPosition(reference[0]).x)));
          });
  errors.ledger = motion.ledger;
  return errors;
}

std::vector<Check> Calc() {
  const Mechanism mechanism = MakeSliderCrank();
  mechanism::Evaluator evaluator(mechanism.system);
  evaluator.CalcEnergy(0, mechanism.start);
  const int positions = mechanism.system.model.positions;
  const Vector3<double> spin = evaluator.workspace().V[mechanism.GetJoint("C").link].w;
  // η̇ X + β̇ e2 at the start, by hand: B = (0, 0.1, 0.2), C = (0.2, 0, 0), B's velocity (0, -0.48,
  // 0)
  const double eta = 0.48 * 0.2 / 0.05, beta = 0.24 / (kRod * std::sqrt(5.0) / 3);
  const double s = 2 / std::sqrt(5.0), c = 1 / std::sqrt(5.0);
  const Errors coarse = CalcErrors(mechanism, solve::Method::kExplicit8, 1e-8);
  const Errors fine = CalcErrors(mechanism, solve::Method::kExplicit8, 1e-10);
  const Errors tight = CalcErrors(mechanism, solve::Method::kExplicit8, 1e-12);
  const Errors bdf = CalcErrors(mechanism, solve::Method::kBdf, 1e-10);
  return {Compare("degrees of freedom", 1, CountFreedoms(mechanism), 0),
          Compare("slider's speed at the start [m/s]", 0.24,
                  mechanism.start[positions + mechanism.GetJoint("D").v], 1e-9),
          Compare("rod's angular velocity x at the start [rad/s]", eta, spin.x, 1e-9),
          Compare("rod's angular velocity y at the start [rad/s]", -s * beta, spin.y, 1e-9),
          Compare("rod's angular velocity z at the start [rad/s]", c * beta, spin.z, 1e-9),
          Bound("crank angle, explicit 8, 1e-12, largest error [rad]", tight.crank, 1e-7),
          Bound("slider, explicit 8, 1e-10, largest error [m]", fine.slider, 1e-8),
          Bound("energy, explicit 8, 1e-10, drift [J]", fine.ledger.largest_energy_error, 1e-8),
          Bound("loop, residual [m]", fine.ledger.largest_position_residual, 1e-12),
          Bound("slider, BDF, 1e-10, largest error [m]", bdf.slider, 1e-6),
          CheckConvergence("crank angle, explicit 8, 1e-10", coarse.crank, fine.crank)};
}

}  // namespace

Case MakeSliderCrankCase() {
  return {"C04", "spatial slider-crank with universal joint, 5 s",
          "Haug, Computer Aided Kinematics and Dynamics (1989) 396; reference by extrapolation in "
          "the crank angle",
          Calc};
}

}  // namespace kingpin::validation
