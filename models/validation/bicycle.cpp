#include <Eigen/Dense>
#include <complex>
#include <limits>
#include <numbers>
#include <tuple>

#include <fmt/format.h>

#include "core/solve/linearise.h"
#include "models/validation/cases.h"
#include "models/validation/parts.h"

namespace kingpin::validation {

namespace {

// The paper's axes (z down) turned to ours (z up): products of inertia change sign. Every body
// frame lies at the rear contact.
Mechanism MakeBicycle(double speed) {
  const double w = 1.02, c = 0.08, rR = 0.3, rF = 0.35, tilt = std::numbers::pi / 10;
  MechanismDescription d;
  d.name = "bicycle";
  d.gravity = {0, 0, -9.81};
  d.bodies = {MakeBody("frame", 85, {0.3, 0, 0.9}, {9.2, 11, 2.8, 0, -2.4, 0}),
              MakeBody("rear wheel", 2, {0, 0, rR}, {0.0603, 0.12, 0.0603, 0, 0, 0}),
              MakeBody("fork", 4, {0.9, 0, 0.7}, {0.05892, 0.06, 0.00708, 0, 0.00756, 0}),
              MakeBody("front wheel", 3, {w, 0, rF}, {0.1405, 0.28, 0.1405, 0, 0, 0})};
  const auto joint = [](const std::string& name, JointType type, const std::string& parent,
                        const Vector3<double>& at, const std::string& child,
                        const Vector3<double>& axis) {
    JointDescription j = MakeJoint(name, type, parent, at, child, axis);
    j.child.X_BF.p = at;
    return j;
  };
  d.joints = {
      joint("base", JointType::kFree, kWorld, {}, "frame", {0, 0, 1}),
      joint("rear axle", JointType::kRevolute, "frame", {0, 0, rR}, "rear wheel", {0, 1, 0}),
      joint("head", JointType::kRevolute, "frame", {w + c, 0, 0}, "fork",
            {-std::sin(tilt), 0, std::cos(tilt)}),
      joint("front axle", JointType::kRevolute, "fork", {w, 0, rF}, "front wheel", {0, 1, 0})};
  d.joints[0].velocity = {speed, 0, 0, 0, 0, 0};
  d.joints[1].velocity = {speed / rR};
  d.joints[3].velocity = {speed / rF};
  for (const auto& [name, wheel, x, r] :
       {std::tuple{"rear", "rear wheel", 0.0, rR}, std::tuple{"front", "front wheel", w, rF}}) {
    d.closures.push_back(MakeClosure(name, ClosureType::kRollingDisc,
                                     At(wheel, {x, 0, r}, {0, 1, 0}), At(kWorld, {})));
    d.closures.back().radius = r;
  }
  return MakeMechanism(d);
}

// M λ² + v C1 λ + g K0 + v² K2, the paper's matrices (27).
Eigen::VectorXcd CalcFromMatrices(double speed) {
  Eigen::Matrix2d M, C, K0, K2;
  M << 80.81722, 2.31941332208709, 2.31941332208709, 0.29784188199686;
  C << 0, 33.86641391492494, -0.85035641456978, 1.68540397397560;
  K0 << -80.95, -2.59951685249872, -2.59951685249872, -0.80329488458618;
  K2 << 0, 76.59734589573222, 0, 2.65431523794604;
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A.topRightCorner(2, 2).setIdentity();
  A.bottomLeftCorner(2, 2) = -M.inverse() * (9.81 * K0 + speed * speed * K2);
  A.bottomRightCorner(2, 2) = -M.inverse() * (speed * C);
  return A.eigenvalues();
}

double FindNearest(const Eigen::VectorXcd& found, const std::complex<double>& wanted) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& x : found) nearest = std::min(nearest, std::abs(x - wanted));
  return nearest;
}

std::vector<Check> Calc() {
  std::vector<Check> checks;
  const Mechanism bicycle = MakeBicycle(5);
  const solve::Linearisation linear = solve::Linearise(bicycle.system, 0, bicycle.start);
  checks.push_back(Compare("independent positions", 7, linear.positions, 0));
  checks.push_back(Compare("independent velocities", 3, linear.velocities, 0));
  const Eigen::VectorXcd eigenvalues = linear.A.eigenvalues();
  const std::pair<const char*, std::complex<double>> published[] = {
      {"castering", -14.07838969279822},
      {"capsize", -0.32286642900409},
      {"weave", {-0.77534188219585, 4.46486771378823}}};
  for (const auto& [name, wanted] : published) {
    checks.push_back({fmt::format("{} at 5 m/s, published [1/s], distance", name), std::abs(wanted),
                      std::abs(wanted), FindNearest(eigenvalues, wanted), 1e-9});
  }
  for (double speed : {1.0, 3.0, 7.0, 10.0}) {
    const Mechanism other = MakeBicycle(speed);
    const Eigen::VectorXcd found = solve::Linearise(other.system, 0, other.start).A.eigenvalues();
    double largest = 0;
    for (const auto& wanted : CalcFromMatrices(speed)) {
      largest = std::max(largest, FindNearest(found, wanted));
    }
    checks.push_back(Bound(
        fmt::format("four eigenvalues at {:g} m/s, published matrices [1/s], distance", speed),
        largest, 1e-9));
  }
  return checks;
}

}  // namespace

Case MakeBicycleCase() {
  return {
      "B01", "uncontrolled bicycle, eigenvalues of straight running",
      "Meijaard, Papadopoulos, Ruina and Schwab, Proc. R. Soc. A 463 (2007) 1955, tables 1 and 2",
      Calc};
}

}  // namespace kingpin::validation
