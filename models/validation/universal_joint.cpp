#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "models/validation/cases.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kBend = std::numbers::pi / 6, kSpeed = 20, kInertia = 0.4, kDuration = 1;

mechanism::Drive MakeDrive() {
  return [](double t) { return std::array<double, 3>{kSpeed * t, kSpeed, 0}; };
}

// A shaft on bearings in the xy plane, bent from x by `bend`, its hinge at `at`; body frame: z
// along the shaft, y out of the plane at zero angle.
void AddShaft(MechanismDescription& d, const std::string& name, const Vector3<double>& at,
              double bend, double inertia) {
  const double c = std::cos(bend), s = std::sin(bend);
  d.bodies.push_back(MakeBody(name, 1, {}, {inertia, inertia, inertia}));
  d.joints.push_back(MakeJoint(name, JointType::kRevolute, kWorld, at, name));
  d.joints.back().parent.X_BF.R = {{-s, c, 0}, {0, 0, 1}, {c, s, 0}};
}

// Cut joint between two shafts: the arm of the first along x (in the plane of the shafts at zero
// angle), that of the second along y.
ClosureDescription MakeJointCut(const std::string& name, const std::string& first,
                                const Vector3<double>& at_first, bool first_in_plane,
                                const std::string& second, const Vector3<double>& at_second) {
  const Vector3<double> x{1, 0, 0}, y{0, 1, 0};
  ClosureDescription cut;
  cut.name = name;
  cut.type = ClosureType::kUniversal;
  cut.a = At(first, at_first, first_in_plane ? x : y);
  // its x axis is the second arm
  const Vector3<double> arm = first_in_plane ? y : x;
  cut.b = {second, {{arm, Cross(Vector3<double>{0, 0, 1}, arm), {0, 0, 1}}, at_second}};
  return cut;
}

struct Exact {
  double angle, speed, acceleration;
};

// tan θ2 = tan θ1/cos β
Exact CalcExact(double angle) {
  const double c = std::cos(kBend), s2 = 1 - c * c;
  const double turns = std::round(angle / std::numbers::pi);
  const double rest = angle - turns * std::numbers::pi;
  const double share = 1 - s2 * std::cos(angle) * std::cos(angle);
  return {turns * std::numbers::pi + std::atan2(std::sin(rest), std::cos(rest) * c),
          kSpeed * c / share, -kSpeed * kSpeed * c * s2 * std::sin(2 * angle) / (share * share)};
}

void CheckSingle(bool in_tree, std::vector<Check>& checks) {
  MechanismDescription d;
  d.name = "universal joint";
  d.gravity = {};
  AddShaft(d, "input", {}, 0, 0.1);
  if (in_tree) {
    // the output hangs on the joint; its bearing closes the loop
    const double c = std::cos(kBend), s = std::sin(kBend);
    d.bodies.push_back(MakeBody("output", 1, {}, {kInertia, kInertia, kInertia}));
    d.joints.push_back(MakeJoint("cross", JointType::kUniversal, "input", {}, "output", {1, 0, 0}));
    d.joints.back().second_axis = {0, 1, 0};
    // at zero angles both shafts are in line; the second axis carries the bend
    d.joints.back().position = {0, kBend};
    d.closures.push_back(MakeClosure("bearing", ClosureType::kParallelAxes, At("output", {}),
                                     At(kWorld, {}, {c, s, 0})));
  } else {
    AddShaft(d, "output", {}, kBend, kInertia);
    d.closures.push_back(MakeJointCut("cross", "input", {}, true, "output", {}));
  }
  d.motions.push_back({"drive", "input", 0, MakeDrive(), {}});
  const Mechanism mechanism = MakeMechanism(d);
  const int output = mechanism.GetBody("output").link;
  double angle = 0, speed = 0, acceleration = 0, torque = 0;
  int drive = 0;
  for (const auto& place : mechanism.rows) {
    if (place.name == "drive") drive = place.first;
  }
  const Vector3<double> axis{std::cos(kBend), std::sin(kBend), 0};
  const Motion motion =
      Run(mechanism, MakeOptions(solve::Method::kExplicit8, 1e-10, kDuration, 0.01),
          [&](double time, std::span<const double> y, mechanism::Evaluator& evaluator) {
            std::vector<double> rate(y.size());
            evaluator.CalcRates(time, y, rate);
            const Exact exact = CalcExact(kSpeed * time);
            speed = std::max(
                speed, std::abs(Dot(axis, evaluator.workspace().V[output].w) / exact.speed - 1));
            const double wanted = kInertia * exact.acceleration * exact.speed / kSpeed;
            torque = std::max(torque, std::abs(evaluator.reactions()[drive] - wanted));
            if (in_tree) return;
            angle = std::max(angle, std::abs(y[mechanism.GetJoint("output").q] - exact.angle));
            acceleration = std::max(
                acceleration, std::abs(evaluator.accelerations()[mechanism.GetJoint("output").v] -
                                       exact.acceleration));
          });
  const char* how = in_tree ? "joint of the tree" : "cut joint";
  const auto name = [&](const char* what) { return fmt::format("{}: {}", how, what); };
  checks.push_back(Compare(name("degrees of freedom"), 0, CountFreedoms(mechanism), 0));
  checks.push_back(Bound(name("output speed, largest relative error"), speed, 1e-9));
  checks.push_back(
      Bound(name("input torque (amplitude about 60 N m), largest error [N m]"), torque, 1e-7));
  if (in_tree) return;
  checks.push_back(Bound(name("output angle, largest error [rad]"), angle, 1e-9));
  checks.push_back(
      Bound(name("output acceleration (amplitude about 130 rad/s^2), largest error [rad/s^2]"),
            acceleration, 1e-7));
}

void CheckDouble(bool w_arrangement, std::vector<Check>& checks) {
  MechanismDescription d;
  d.name = "double Cardan";
  d.gravity = {};
  const double length = 0.5;
  const double last = w_arrangement ? 2 * kBend : 0;
  const Vector3<double> end{length * std::cos(kBend), length * std::sin(kBend), 0};
  AddShaft(d, "input", {}, 0, 0.1);
  AddShaft(d, "middle", {}, kBend, 0.2);
  AddShaft(d, "output", end, last, kInertia);
  d.closures = {MakeJointCut("first", "input", {}, true, "middle", {}),
                MakeJointCut("second", "output", {}, true, "middle", {0, 0, length})};
  d.motions.push_back({"drive", "input", 0, MakeDrive(), {}});
  const Mechanism mechanism = MakeMechanism(d);
  double ripple = 0, difference = 0;
  Run(mechanism, MakeOptions(solve::Method::kExplicit8, 1e-10, kDuration, 0.01),
      [&](double, std::span<const double> y, mechanism::Evaluator&) {
        const auto& output = mechanism.GetJoint("output");
        const double speed = y[mechanism.system.model.positions + output.v];
        ripple = std::max(ripple, std::abs(speed / kSpeed - 1));
        difference = std::max(difference, std::abs(y[output.q] - y[mechanism.GetJoint("input").q]));
      });
  const char* how = w_arrangement ? "double Cardan, W" : "double Cardan, Z";
  checks.push_back(Bound(fmt::format("{}: output speed, relative ripple", how), ripple, 1e-10));
  checks.push_back(
      Bound(fmt::format("{}: output against input angle [rad]", how), difference, 1e-9));
}

std::vector<Check> Calc() {
  std::vector<Check> checks;
  CheckSingle(false, checks);
  CheckSingle(true, checks);
  CheckDouble(false, checks);
  CheckDouble(true, checks);
  return checks;
}

}  // namespace

Case MakeUniversalJointCase() {
  return {"U01", "universal joint at 30 degrees and double Cardan, driven at 20 rad/s, 1 s",
          "textbook: tan t2 = tan t1/cos b; equal angles and aligned forks cancel", Calc};
}

}  // namespace kingpin::validation
