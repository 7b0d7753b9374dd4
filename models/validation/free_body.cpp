#include <cmath>

#include "models/validation/cases.h"
#include "models/validation/elliptic.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kInertia[3] = {1, 2, 3};
constexpr double kStart[3] = {0.01, 5, 0.02};
constexpr double kDuration = 20;

// Euler's free top near its intermediate axis (Landau and Lifshitz, Mechanics, §37), L² > 2 E I2:
//
//   ω1 = a1 cn τ, ω2 = a2 sn τ, ω3 = a3 dn τ,   τ = τ0 + n t
class ExactSpin {
 public:
  ExactSpin() {
    const Real i1 = kInertia[0], i2 = kInertia[1], i3 = kInertia[2];
    Real energy2 = 0, momentum2 = 0;
    for (int i = 0; i < 3; ++i) {
      const Real l = Real(kInertia[i]) * Real(kStart[i]);
      energy2 += l * kStart[i];
      momentum2 += l * l;
    }
    const Real a = energy2 * i3 - momentum2, b = momentum2 - energy2 * i1;
    amplitude_[0] = std::sqrt(a / (i1 * (i3 - i1)));
    amplitude_[1] = std::sqrt(a / (i2 * (i3 - i2)));
    amplitude_[2] = std::sqrt(b / (i3 * (i3 - i1)));
    rate_ = std::sqrt((i3 - i2) * b / (i1 * i2 * i3));
    const Real square = (i2 - i1) * a / ((i3 - i2) * b);
    complement_ = (i3 - i1) * (momentum2 - energy2 * i2) / ((i3 - i2) * b);
    const Real angle = std::atan2(kStart[1] / amplitude_[1], kStart[0] / amplitude_[0]);
    start_ = std::ellint_1(std::sqrt(square), angle);
  }
  std::array<double, 3> At(double time) const {
    const Jacobi j = CalcJacobi(start_ + rate_ * time, complement_);
    return {static_cast<double>(amplitude_[0] * j.cn), static_cast<double>(amplitude_[1] * j.sn),
            static_cast<double>(amplitude_[2] * j.dn)};
  }

 private:
  Real amplitude_[3], rate_, complement_, start_;
};

struct Errors {
  double spin = 0, energy = 0, momentum = 0, attitude = 0;
};

// Quaternion and angular velocity: the attitude has no closed form in elementary terms.
State CalcReference(double duration) {
  State y = {1, 0, 0, 0, kStart[0], kStart[1], kStart[2]};
  Integrate(
      [](Real, const State& s, State& r) {
        r[0] = -(s[1] * s[4] + s[2] * s[5] + s[3] * s[6]) / 2;
        r[1] = (s[0] * s[4] + s[2] * s[6] - s[3] * s[5]) / 2;
        r[2] = (s[0] * s[5] + s[3] * s[4] - s[1] * s[6]) / 2;
        r[3] = (s[0] * s[6] + s[1] * s[5] - s[2] * s[4]) / 2;
        for (int i = 0; i < 3; ++i) {
          const int j = (i + 1) % 3, k = (i + 2) % 3;
          r[4 + i] = Real(kInertia[j] - kInertia[k]) / kInertia[i] * s[4 + j] * s[4 + k];
        }
      },
      0, duration, y);
  return y;
}

Errors CalcErrors(solve::Method method, double tolerance) {
  MechanismDescription d;
  d.name = "free body";
  d.gravity = {};
  d.bodies = {MakeBody("body", 2, {}, {kInertia[0], kInertia[1], kInertia[2], 0, 0, 0})};
  d.joints = {MakeJoint("flight", JointType::kFree, kWorld, {}, "body")};
  d.joints[0].velocity = {0, 0, 0, kStart[0], kStart[1], kStart[2]};
  const Mechanism body = MakeMechanism(d);
  const ExactSpin exact;
  const Vector3<double> momentum{kInertia[0] * kStart[0], kInertia[1] * kStart[1],
                                 kInertia[2] * kStart[2]};
  Errors errors;
  const Motion motion = Run(
      body, MakeOptions(method, tolerance, kDuration, 0.1),
      [&](double time, std::span<const double> y, mechanism::Evaluator& evaluator) {
        const auto wanted = exact.At(time);
        for (int i = 0; i < 3; ++i) {
          errors.spin = std::max(errors.spin, std::abs(y[7 + 3 + i] - wanted[i]));
        }
        const Vector3<double> now =
            evaluator.workspace().R[1] *
            Vector3<double>{kInertia[0] * y[10], kInertia[1] * y[11], kInertia[2] * y[12]};
        errors.momentum = std::max(errors.momentum, CalcNorm(now - momentum) / CalcNorm(momentum));
      });
  errors.energy = motion.ledger.largest_energy_error / motion.ledger.energy_start;
  const State reference = CalcReference(kDuration);
  for (int i = 0; i < 4; ++i) {
    errors.attitude =
        std::max(errors.attitude, std::abs(motion.y[3 + i] - static_cast<double>(reference[i])));
  }
  return errors;
}

std::vector<Check> Calc() {
  const State reference = CalcReference(kDuration);
  const auto exact = ExactSpin().At(kDuration);
  const Errors coarse = CalcErrors(solve::Method::kExplicit8, 1e-8);
  const Errors middle = CalcErrors(solve::Method::kExplicit8, 1e-10);
  const Errors tight = CalcErrors(solve::Method::kExplicit8, 1e-13);
  const Errors bdf = CalcErrors(solve::Method::kBdf, 1e-10);
  // two references: extrapolation magnifies rounding a hundredfold, and the flips magnify it again
  return {Compare("closed form against extrapolation: spin about axis 2 at 20 s [rad/s]", exact[1],
                  static_cast<double>(reference[5]), 1e-10),
          // The motion passes its unstable axis again and again, where rounding of the energy in
          // the 16th digit shifts the time of the flip by 1e-11 s: relative, not absolute.
          Bound("angular velocity, explicit 8, 1e-13, largest error relative to 5 rad/s",
                tight.spin / kStart[1], 1e-10),
          Bound("attitude at 20 s, explicit 8, 1e-13, error [quaternion]", tight.attitude, 1e-10),
          Bound("angular velocity, explicit 8, 1e-10, largest error [rad/s]", middle.spin, 1e-6),
          Bound("energy, explicit 8, 1e-10, relative drift", middle.energy, 1e-7),
          Bound("angular momentum, explicit 8, 1e-10, relative drift", middle.momentum, 1e-7),
          Bound("angular velocity, BDF, 1e-10, largest error [rad/s]", bdf.spin, 1e-5),
          Bound("energy, BDF, 1e-10, relative drift", bdf.energy, 1e-7),
          Bound("angular momentum, BDF, 1e-10, relative drift", bdf.momentum, 1e-7),
          CheckConvergence("angular velocity, explicit 8, 1e-10", coarse.spin, middle.spin)};
}

}  // namespace

Case MakeFreeBodyCase() {
  return {"C01", "free rigid body about its intermediate axis, 20 s",
          "Landau and Lifshitz, Mechanics, par. 37: Jacobi's functions; attitude by extrapolation",
          Calc};
}

}  // namespace kingpin::validation
