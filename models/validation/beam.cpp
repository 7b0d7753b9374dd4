#include "joints/beam.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/solve/linearise.h"
#include "joints/add_forces.h"
#include "models/validation/cases.h"
#include "models/validation/parts.h"

namespace kingpin::validation {

namespace {

using std::numbers::pi;
using Flexibility = joints::BeamDescription::Flexibility;

constexpr double kLength = 1, kDensity = 7850, kE = 2.1e11, kG = kE / 2.6;

// Natural frequencies of a round steel rod of n springs, rising [Hz].
std::vector<double> CalcFrequencies(double diameter, int n, Flexibility flexibility,
                                    JointType root) {
  bodies::BeamSegment segment;
  segment.length = kLength;
  segment.section = bodies::RoundSection{diameter};
  segment.material = {kE, kG, kDensity, 0, 0};
  joints::BeamDescription beam;
  beam.name = "rod";
  beam.at = {kWorld, {}};
  beam.elements = bodies::MakeBeamElements({segment}, n);
  beam.flexibility = flexibility;
  beam.root = root;
  MechanismDescription d;
  d.name = "rod";
  d.gravity = {};
  std::vector<joints::ForceDescription> forces;
  AppendBeam(beam, d, forces);
  Mechanism rod = MakeMechanism(d);
  AddForces(forces, rod);
  const solve::Linearisation linear = solve::Linearise(rod.system, 0, rod.start);
  // undamped and at rest, A = (0, I; -K, 0): squares of the frequencies keep more digits as
  // eigenvalues of K than those of A would
  const Eigen::VectorXd squares =
      -linear.A.block(linear.positions, 0, linear.velocities, linear.positions)
           .eigenvalues()
           .real();
  std::vector<double> frequencies;
  for (double square : squares) frequencies.push_back(std::sqrt(std::abs(square)) / (2 * pi));
  std::sort(frequencies.begin(), frequencies.end());
  return frequencies;
}

std::vector<Check> Calc() {
  std::vector<Check> checks;
  const double speed = std::sqrt(kG / kDensity);
  for (int n : {1, 2, 5, 10, 20, 50}) {
    double clamped = 0, free = 0;
    const auto ours = CalcFrequencies(0.02, n, Flexibility::kTorsion, JointType::kFixed);
    const auto loose = CalcFrequencies(0.02, n, Flexibility::kTorsion, JointType::kRevolute);
    for (int k = 1; k <= n; ++k) {
      const double x = (2 * k - 1) * pi / (4 * n), z = k * pi / (2 * n);
      clamped = std::max(
          clamped,
          std::abs(ours[k - 1] / ((2 * k - 1) / (4 * kLength) * speed * std::sin(x) / x) - 1));
      free = std::max(free, std::abs(loose[k] / (k / (2 * kLength) * speed * std::sin(z) / z) - 1));
    }
    checks.push_back(Bound(fmt::format("n = {}: torsion, clamped and free, all {} frequencies, "
                                       "largest relative error",
                                       n, n),
                           clamped, 1e-10));
    checks.push_back(Bound(fmt::format("n = {}: torsion, free at both ends, all {} frequencies, "
                                       "largest relative error",
                                       n, n),
                           free, 1e-10));
  }
  const auto torsion = [&](int n) {
    return CalcFrequencies(0.02, n, Flexibility::kTorsion, JointType::kFixed)[0] /
               (speed / (4 * kLength)) -
           1;
  };
  checks.push_back(Compare("order of convergence to the continuum, torsion, n = 16, 32", 2,
                           std::log2(torsion(16) / torsion(32)), 0.05));
  // so thin that neither rotary inertia nor shear is seen: cos b cosh b = -1
  const double thin = 0.002, bend = std::sqrt(kE * thin * thin / 16 / kDensity) / (2 * pi);
  const double roots[] = {1.8751040687119612, 4.6940911329741746};
  const auto coarse = CalcFrequencies(thin, 16, Flexibility::kTorsionAndBending, JointType::kFixed);
  const auto fine = CalcFrequencies(thin, 32, Flexibility::kTorsionAndBending, JointType::kFixed);
  for (size_t k = 0; k < 2; ++k) {
    const double exact = bend * roots[k] * roots[k];  // both planes bend alike: every other one
    checks.push_back(Compare(
        fmt::format("order of convergence to the continuum, bending mode {}, n = 16, 32", k + 1), 2,
        std::log2((coarse[2 * k] / exact - 1) / (fine[2 * k] / exact - 1)), 0.05));
  }
  return checks;
}

}  // namespace

Case MakeBeamCase() {
  return {"R01", "shaft and beam of rigid finite elements, eigenfrequencies",
          "Wittbrodt, Adamiec-Wojcik and Wojciech (2006): exact frequencies times sin x/x; "
          "Euler-Bernoulli beam",
          Calc};
}

}  // namespace kingpin::validation
