#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/solve/equilibrium.h"
#include "core/solve/linearise.h"
#include "joints/add_forces.h"
#include "models/validation/cases.h"
#include "models/validation/parts.h"

namespace kingpin::validation {

namespace {

constexpr double kMass = 150, kMoments[3] = {6, 12, 14};

struct Mount {
  Vector3<double> position;
  double translation[3], rotation[3];
};
const Mount kMounts[] = {{{0.5, 0.3, -0.2}, {8e4, 6e4, 2e5}, {20, 20, 20}},
                         {{0.5, -0.3, -0.2}, {8e4, 6e4, 2e5}, {20, 20, 20}},
                         {{-0.6, 0, -0.1}, {1.2e5, 5e4, 1.5e5}, {30, 30, 30}}};
// So small that the second-order part of the rotations, 1e-7 of them, does not count.
const Vector3<double> kForce{0.04, -0.02, 0.1}, kTorque{0.005, 0.01, -0.005};

Mechanism MakeEngine(bool loaded) {
  MechanismDescription d;
  d.name = "engine on mounts";
  d.gravity = {};
  d.bodies = {MakeBody("engine", kMass, {}, {kMoments[0], kMoments[1], kMoments[2], 0, 0, 0})};
  d.joints = {MakeJoint("float", JointType::kFree, kWorld, {}, "engine")};
  std::vector<joints::ForceDescription> forces;
  for (const Mount& mount : kMounts) {
    joints::BushingDescription bushing;
    bushing.name = fmt::format("mount {}", forces.size() + 1);
    bushing.a = {kWorld, {{}, mount.position}};
    bushing.b = {"engine", {{}, mount.position}};
    for (int i = 0; i < 3; ++i) {
      bushing.stiffness[i].coefficient = mount.translation[i];
      bushing.stiffness[3 + i].coefficient = mount.rotation[i];
    }
    forces.emplace_back(std::move(bushing));
  }
  if (loaded) {
    joints::BodyForceDescription load;
    load.name = "load";
    load.at = {"engine", {}};
    load.force = kForce;
    load.torque = kTorque;
    forces.emplace_back(std::move(load));
  }
  Mechanism engine = MakeMechanism(d);
  AddForces(forces, engine);
  return engine;
}

// Displacement of a mount by the body's translation u and rotation θ: u + θ x p.
Eigen::Matrix<double, 6, 6> AssembleStiffness() {
  Eigen::Matrix<double, 6, 6> K = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Mount& mount : kMounts) {
    const Vector3<double>& p = mount.position;
    Eigen::Matrix<double, 6, 6> T = Eigen::Matrix<double, 6, 6>::Identity();
    T.topRightCorner(3, 3) << 0, p.z, -p.y, -p.z, 0, p.x, p.y, -p.x, 0;
    Eigen::Matrix<double, 6, 1> k;
    for (int i = 0; i < 3; ++i) k[i] = mount.translation[i], k[3 + i] = mount.rotation[i];
    K += T.transpose() * k.asDiagonal() * T;
  }
  return K;
}

std::vector<Check> Calc() {
  const Eigen::Matrix<double, 6, 6> K = AssembleStiffness();
  Eigen::Matrix<double, 6, 1> masses;
  masses << kMass, kMass, kMass, kMoments[0], kMoments[1], kMoments[2];
  const Eigen::Matrix<double, 6, 6> M = masses.asDiagonal();
  const Eigen::VectorXd squares =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M).eigenvalues();
  std::vector<Check> checks;
  const Mechanism engine = MakeEngine(false);
  const auto modes = solve::CalcModes(solve::Linearise(engine.system, 0, engine.start));
  checks.push_back(Compare("modes", 6, static_cast<double>(modes.size()), 0));
  for (size_t k = 0; k < 6 && k < modes.size(); ++k) {
    checks.push_back(CompareRelative(fmt::format("frequency {} [Hz]", k + 1),
                                     std::sqrt(squares[k]) / (2 * std::numbers::pi),
                                     modes[k].frequency, 1e-8));
  }
  Mechanism loaded = MakeEngine(true);
  solve::EquilibriumOptions options;
  options.tolerance = 1e-12;
  solve::FindEquilibrium(loaded.system, options, loaded.start);
  Eigen::Matrix<double, 6, 1> load;
  load << kForce.x, kForce.y, kForce.z, kTorque.x, kTorque.y, kTorque.z;
  const Eigen::Matrix<double, 6, 1> wanted = K.ldlt().solve(load);
  const char* names[] = {"x [m]",         "y [m]",         "z [m]",
                         "about x [rad]", "about y [rad]", "about z [rad]"};
  const double size[] = {wanted.head(3).norm(), wanted.tail(3).norm()};
  for (int i = 0; i < 6; ++i) {
    // position, then quaternion w, x, y, z: half the angle
    const double ours = i < 3 ? loaded.start[i] : 2 * loaded.start[i + 1];
    checks.push_back({fmt::format("static displacement {}, relative to its size", names[i]),
                      wanted[i], ours, std::abs(ours - wanted[i]) / size[i / 3], 1e-6});
  }
  return checks;
}

}  // namespace

Case MakeMountsCase() {
  return {"S01", "rigid body on three bushings: frequencies and static displacement",
          "textbook (powertrain mounts): stiffness assembled from the mounts", Calc};
}

}  // namespace kingpin::validation
