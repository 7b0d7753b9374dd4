#include <cmath>
#include <numbers>

#include "joints/add_forces.h"
#include "models/validation/cases.h"
#include "models/validation/extrapolation.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kGravity = 9.81, kDuration = 10;
constexpr double kRod = 0.3, kSlider = 3, kBall = 5;
constexpr double kThin = 0.01, kCube = 0.1;
constexpr double kStiffness = 8e5, kDamping = 4e4, kFree = 0.5, kOffset = 0.05;
constexpr double kTilt = std::numbers::pi / 6;  // rods below the horizontal

Mechanism MakeGovernor() {
  MechanismDescription d;
  d.name = "governor";
  d.gravity = {0, 0, -kGravity};
  const double across = kRod * (1 + kThin * kThin) / 12, along = kRod * kThin * kThin / 6;
  const double cube = kSlider * kCube * kCube / 6;
  d.bodies = {MakeBody("shaft", kRod, {0, 0, 0.5}, {across, across, along}),
              MakeBody("slider", kSlider, {}, {cube, cube, cube})};
  d.joints = {MakeJoint("shaft", JointType::kRevolute, kWorld, {}, "shaft"),
              MakeJoint("slider", JointType::kPrismatic, "shaft", {}, "slider")};
  d.joints[0].velocity = {2 * std::numbers::pi};
  d.joints[1].position = {0.5};
  for (int side : {1, -1}) {
    const std::string number = side > 0 ? " 1" : " 2";
    d.bodies.push_back(MakeBody("rod" + number, kRod, {0.5 * side, 0, 0}, {along, across, across}));
    d.bodies.push_back(MakeBody("ball" + number, kBall, {}, {}));
    // positive angles lower the rod's end
    const Vector3<double> axis{0, static_cast<double>(side), 0};
    d.joints.push_back(MakeJoint("hinge" + number, JointType::kRevolute, "shaft",
                                 {kOffset * side, 0, 1}, "rod" + number, axis));
    d.joints.back().position = {kTilt};
    d.joints.push_back(MakeJoint("ball" + number, JointType::kFixed, "rod" + number,
                                 {1.0 * side, 0, 0}, "ball" + number));
  }
  Mechanism governor = MakeMechanism(d);
  std::vector<joints::ForceDescription> springs;
  for (int side : {1, -1}) {
    const std::string rod = side > 0 ? "rod 1" : "rod 2";
    joints::SpringDescription spring;
    spring.name = rod;
    spring.place =
        joints::BetweenPoints{At("slider", {kOffset * side, 0, 0}), At(rod, {0.5 * side, 0, 0})};
    spring.stiffness.coefficient = kStiffness;
    spring.damping.coefficient = kDamping;
    spring.free = kFree;
    springs.emplace_back(std::move(spring));
  }
  AddForces(springs, governor);
  return governor;
}

// Moment of inertia about the shaft of everything, and its derivative, for rods at b below the
// horizontal.
Real CalcInertia(Real b, Real* derivative) {
  const Real along = Real(kRod) * kThin * kThin / 6;
  const Real across = Real(kRod) * (1 + Real(kThin) * kThin) / 12;
  const Real c = std::cos(b), s = std::sin(b);
  const Real middle = kOffset + c / 2, end = kOffset + c;
  *derivative = 2 * (-kRod * middle * s - 2 * kBall * end * s + 2 * (along - across) * c * s);
  return along + Real(kSlider) * kCube * kCube / 6 +
         2 * (kRod * middle * middle + kBall * end * end + across * c * c + along * s * s);
}

// Lagrange's equations of the symmetric motion: state shaft angle, place of the slider, tilt of the
// rods, then their rates.
void CalcRates(Real, const State& y, State& r) {
  const Real s = std::sin(y[2]), c = std::cos(y[2]);
  const Real rod = Real(kRod) * (1 + Real(kThin) * kThin) / 12 + Real(kRod) / 4 + kBall;
  Real slope;
  const Real inertia = CalcInertia(y[2], &slope);
  // line from the slider's point to the middle of a rod
  const Real across = c / 2, up = 1 - s / 2 - y[1];
  const Real length = std::sqrt(across * across + up * up);
  const Real by_slider = -up / length, by_tilt = -(across * s + up * c) / (2 * length);
  const Real pull = kStiffness * (length - kFree) + kDamping * (by_slider * y[4] + by_tilt * y[5]);
  r[0] = y[3];
  r[1] = y[4];
  r[2] = y[5];
  r[3] = -slope * y[5] * y[3] / inertia;
  r[4] = -Real(kGravity) - 2 * pull * by_slider / kSlider;
  r[5] =
      (slope * y[3] * y[3] / 4 + Real(kGravity) * (Real(kRod) / 2 + kBall) * c - pull * by_tilt) /
      rod;
}

struct Errors {
  double slider = 0, tilt = 0, spin = 0, momentum = 0, energy = 0;
};

Errors CalcErrors(double tolerance, const std::vector<State>& reference) {
  Errors errors;
  const Mechanism governor = MakeGovernor();
  const auto place = [&](const char* joint) { return governor.GetJoint(joint); };
  const mechanism::Model& model = governor.system.model;
  double start = 0;
  size_t sample = 0;
  const Motion motion =
      Run(governor, MakeOptions(solve::Method::kBdf, tolerance, kDuration, 0.1),
          [&](double, std::span<const double> y, mechanism::Evaluator&) {
            const State& wanted = reference[sample++];
            const double spin = y[model.positions + place("shaft").v];
            errors.slider = std::max(
                errors.slider, std::abs(y[place("slider").q] - static_cast<double>(wanted[1])));
            errors.spin = std::max(errors.spin, std::abs(spin - static_cast<double>(wanted[3])));
            for (const char* hinge : {"hinge 1", "hinge 2"}) {
              errors.tilt = std::max(errors.tilt,
                                     std::abs(y[place(hinge).q] - static_cast<double>(wanted[2])));
            }
            Real slope;
            const double momentum =
                static_cast<double>(CalcInertia(y[place("hinge 1").q], &slope)) * spin;
            if (sample == 1) start = momentum;
            errors.momentum = std::max(errors.momentum, std::abs(momentum / start - 1));
          });
  errors.energy = motion.ledger.largest_energy_error;
  return errors;
}

std::vector<Check> Calc() {
  State y = {0, 0.5L, kTilt, 2 * std::numbers::pi, 0, 0};
  std::vector<State> reference = {y};
  for (int sample = 0; sample < 100; ++sample) {
    Integrate(CalcRates, 0.1L * sample, 0.1L * (sample + 1), y, 1e-13L);
    reference.push_back(y);
  }
  const Errors loose = CalcErrors(1e-8, reference);
  const Errors tight = CalcErrors(1e-10, reference);
  return {Bound("slider, BDF, 1e-8, largest error [m]", loose.slider, 1e-6),
          Bound("rods, BDF, 1e-8, largest error [rad]", loose.tilt, 1e-6),
          Bound("slider, BDF, 1e-10, largest error [m]", tight.slider, 1e-7),
          Bound("shaft's speed, BDF, 1e-10, largest error [rad/s]", tight.spin, 1e-6),
          Bound("angular momentum, BDF, 1e-10, relative drift", tight.momentum, 1e-7),
          Bound("energy with dissipation, BDF, 1e-10, error [J]", tight.energy, 1e-4),
          CheckConvergence("slider, BDF, 1e-10", loose.slider, tight.slider)};
}

}  // namespace

Case MakeGovernorCase() {
  return {"A05", "stiff flyball governor, 10 s",
          "Gonzalez et al. (2006); reference by extrapolation of Lagrange's equations of the "
          "symmetric motion",
          Calc};
}

}  // namespace kingpin::validation
