#include <algorithm>
#include <cmath>

#include "models/validation/cases.h"
#include "models/validation/elliptic.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kMass = 15, kGravity = 9.81, kDuration = 2;
constexpr double kAcross = 15.234375, kAlong = 0.46875;  // moments of inertia about the fixed point
constexpr double kStart[3] = {0, 150, -4.61538};

Mechanism MakeTop() {
  MechanismDescription d;
  d.name = "heavy top";
  d.gravity = {0, 0, -kGravity};
  d.bodies = {MakeBody("top", kMass, {0, 1, 0}, {0.234375, 0.46875, 0.234375, 0, 0, 0})};
  d.joints = {MakeJoint("tip", JointType::kSpherical, kWorld, {}, "top")};
  d.joints[0].velocity = {kStart[0], kStart[1], kStart[2]};
  return MakeMechanism(d);
}

std::array<Real, 3> CalcCentre(const State& s) {  // R e_y
  return {2 * (s[1] * s[2] - s[0] * s[3]), 1 - 2 * (s[1] * s[1] + s[3] * s[3]),
          2 * (s[2] * s[3] + s[0] * s[1])};
}

// Euler's equations about the fixed point, torque (0, 1, 0) x Rᵀ(0, 0, -m g), and the quaternion.
void CalcRates(Real, const State& s, State& r) {
  const Real g = Real(kMass) * Real(kGravity);
  r[0] = -(s[1] * s[4] + s[2] * s[5] + s[3] * s[6]) / 2;
  r[1] = (s[0] * s[4] + s[2] * s[6] - s[3] * s[5]) / 2;
  r[2] = (s[0] * s[5] + s[3] * s[4] - s[1] * s[6]) / 2;
  r[3] = (s[0] * s[6] + s[1] * s[5] - s[2] * s[4]) / 2;
  const Real up_x = 2 * (s[1] * s[3] - s[0] * s[2]);  // the vertical in the body
  const Real up_z = 1 - 2 * (s[1] * s[1] + s[2] * s[2]);
  r[4] = ((kAlong - kAcross) * s[5] * s[6] - g * up_z) / kAcross;
  r[5] = 0;
  r[6] = ((kAcross - kAlong) * s[4] * s[5] + g * up_x) / kAcross;
}

// Height u of the centre: u̇² is a cubic in u; from its turning point u = 0,
//
//   u = u2 + (u1 - u2) sn²(n t) or u1 + ... from the other root     (Landau and Lifshitz, §35)
Real CalcHeight(Real time) {
  const Real g = Real(kMass) * Real(kGravity);
  const Real along = kAlong * Real(kStart[1]), vertical = kAcross * Real(kStart[2]);
  // kinetic energy of the motion of the axis; the start is at u = 0
  const Real energy = vertical * vertical / (2 * kAcross);
  // f(u) = (2 (E - g u)/J)(1 - u²) - ((Lz - L u)/J)², with f(0) = 0: f = u (a u² + b u + c)
  const Real a = 2 * g / kAcross;
  const Real b = -2 * energy / kAcross - (along / kAcross) * (along / kAcross);
  const Real c = -2 * g / kAcross + 2 * vertical * along / (kAcross * kAcross);
  const Real root = std::sqrt(b * b - 4 * a * c);
  // of opposite signs' cancellation: the small root by the product of both
  const Real large = (-b + root) / (2 * a), small = c / (a * large);
  const Real low = std::min(small, Real(0)), high = std::max(small, Real(0));
  const Real square = (high - low) / (large - low);
  const Real n = std::sqrt(g / (2 * kAcross) * (large - low));
  const Real shift = low == 0 ? Real(0) : CalcQuarterPeriod(1 - square);
  const Real sn = CalcJacobi(n * time + shift, 1 - square).sn;
  return low + (high - low) * sn * sn;
}

struct Errors {
  double place = 0, height = 0, energy = 0, spin = 0;
};

Errors CalcErrors(solve::Method method, double tolerance) {
  Errors errors;
  State reference = {1, 0, 0, 0, kStart[0], kStart[1], kStart[2]};
  double reached = 0;
  const Mechanism top = MakeTop();
  const Motion motion =
      Run(top, MakeOptions(method, tolerance, kDuration, 0.05),
          [&](double time, std::span<const double> y, mechanism::Evaluator& evaluator) {
            if (time > reached) Integrate(CalcRates, reached, time, reference);
            reached = time;
            const auto c = CalcCentre(reference);
            const Vector3<double> ours = evaluator.workspace().R[1].y;
            errors.place = std::max({errors.place, std::abs(ours.x - static_cast<double>(c[0])),
                                     std::abs(ours.y - static_cast<double>(c[1])),
                                     std::abs(ours.z - static_cast<double>(c[2]))});
            errors.height =
                std::max(errors.height, std::abs(ours.z - static_cast<double>(CalcHeight(time))));
            errors.spin = std::max(errors.spin, std::abs(y[5] - kStart[1]));
          });
  errors.energy = motion.ledger.largest_energy_error / motion.ledger.energy_start;
  return errors;
}

std::vector<Check> Calc() {
  const Errors coarse = CalcErrors(solve::Method::kExplicit8, 1e-8);
  const Errors middle = CalcErrors(solve::Method::kExplicit8, 1e-10);
  const Errors tight = CalcErrors(solve::Method::kExplicit8, 1e-13);
  const Errors bdf = CalcErrors(solve::Method::kBdf, 1e-10);
  return {Bound("centre's height against sn², explicit 8, 1e-13, largest error [m]", tight.height,
                1e-10),
          Bound("centre, explicit 8, 1e-13, largest error [m]", tight.place, 1e-10),
          Bound("centre, explicit 8, 1e-10, largest error [m]", middle.place, 1e-5),
          Bound("spin about the axis, explicit 8, 1e-10, drift [rad/s]", middle.spin, 1e-7),
          Bound("energy, explicit 8, 1e-10, relative drift", middle.energy, 1e-7),
          Bound("centre, BDF, 1e-10, largest error [m]", bdf.place, 1e-5),
          CheckConvergence("centre, explicit 8, 1e-10", coarse.place, middle.place)};
}

}  // namespace

Case MakeHeavyTopCase() {
  return {"C02", "heavy top spinning at 150 rad/s, 2 s",
          "Bruels and Cardona, J. Comput. Nonlinear Dyn. 5 (2010) 031002; height in Jacobi's "
          "functions, place by extrapolation",
          Calc};
}

}  // namespace kingpin::validation
