#include "joints/beam.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/mechanism/evaluator.h"
#include "core/mechanism/jacobian.h"
#include "joints/mechanism_builder.h"
#include "tests/joints/force_check.h"

namespace kingpin::joints {
namespace {

using std::numbers::pi;

// Benchmark R01: steel rod of 1 m; the diameter varies with the question.
constexpr double kLength = 1, kDensity = 7850, kE = 2.1e11, kG = kE / 2.6;

bodies::BeamElements MakeRodElements(double diameter, int n) {
  bodies::BeamSegment segment;
  segment.length = kLength;
  segment.section = bodies::RoundSection{diameter};
  segment.material = {kE, kG, kDensity, 0, 0};
  return bodies::MakeBeamElements({segment}, n);
}

BeamDescription MakeShaft(double diameter, int n, BeamDescription::Flexibility flexibility,
                          JointType root = JointType::kFixed) {
  BeamDescription beam;
  beam.name = "shaft";
  beam.at = At("world");
  beam.elements = MakeRodElements(diameter, n);
  beam.flexibility = flexibility;
  beam.root = root;
  return beam;
}

struct Beam {
  Mechanism mechanism;
  BeamParts parts;
};

Beam Make(const BeamDescription& description, const Vector3<double>& force = {},
          const Vector3<double>& torque = {}) {
  MechanismBuilder m("beam");
  m.Gravity({0, 0, 0});
  BeamParts parts = m.AddBeam(description);
  if (description.elements.springs.size() > 0) {
    m.AddForce("load", parts.end).Force(force).Torque(torque);
  }
  return {m.Make(), std::move(parts)};
}

// -∂q̈/∂q = M⁻¹ K at rest.
Eigen::MatrixXd CalcStiffness(const Mechanism& mechanism) {
  const int nv = mechanism.system.model.velocities;
  mechanism::Evaluator evaluator(mechanism.system);
  mechanism::JacobianEvaluator derivatives(mechanism.system);
  Eigen::MatrixXd jacobian(nv, 2 * nv);
  derivatives.Calc(0, mechanism.start, evaluator.workspace().active, jacobian);
  return -jacobian.leftCols(nv);
}

// Natural frequencies [Hz], rising.
std::vector<double> CalcFrequencies(const Mechanism& mechanism) {
  const Eigen::VectorXd squares = CalcStiffness(mechanism).eigenvalues().real();
  std::vector<double> frequencies;
  for (double square : squares) frequencies.push_back(std::sqrt(std::abs(square)) / (2 * pi));
  std::sort(frequencies.begin(), frequencies.end());
  return frequencies;
}

// Linear displacement of the end under a load there: translation v and rotation w.
math::Motion<double> CalcEndDisplacement(const BeamDescription& description,
                                         const Vector3<double>& force,
                                         const Vector3<double>& torque) {
  const Beam unloaded = Make(description), loaded = Make(description, force, torque);
  const mechanism::Model& model = loaded.mechanism.system.model;
  mechanism::Evaluator evaluator(loaded.mechanism.system);
  std::vector<double> rate(loaded.mechanism.system.size());
  evaluator.CalcRates(0, loaded.mechanism.start, rate);
  const Eigen::VectorXd acceleration =
      Eigen::Map<Eigen::VectorXd>(rate.data() + model.positions, model.velocities);
  const Eigen::VectorXd dq = CalcStiffness(unloaded.mechanism).partialPivLu().solve(acceleration);
  const auto& w = evaluator.workspace();
  const mechanism::Frame end = loaded.mechanism.MakeFrame(loaded.parts.end);
  const Vector3<double> p = w.R[end.link] * end.X_LF.p + w.p[end.link];
  math::Motion<double> sum;
  for (int l = end.link; l > 0; l = model.links[l].parent) {
    for (int i = model.links[l].v; i < model.links[l].v + CountVelocities(model.links[l].kind);
         ++i) {
      sum = sum + dq[i] * math::Motion<double>{w.axes[i].w, w.axes[i].At(p)};
    }
  }
  return sum;
}

TEST(TorsionChain, ClampedFrequenciesAreThoseOfTheFormula) {
  for (int n : {1, 2, 5, 10, 50}) {
    const Beam beam = Make(MakeShaft(0.02, n, BeamDescription::Flexibility::kTorsion));
    const std::vector<double> frequencies = CalcFrequencies(beam.mechanism);
    ASSERT_EQ(frequencies.size(), static_cast<size_t>(n));
    for (int k = 1; k <= n; ++k) {
      const double x = (2 * k - 1) * pi / (4 * n);
      const double continuum = (2 * k - 1) / (4 * kLength) * std::sqrt(kG / kDensity);
      EXPECT_NEAR(frequencies[k - 1] / (continuum * std::sin(x) / x), 1, 1e-10)
          << "n = " << n << ", k = " << k;
    }
  }
}

TEST(TorsionChain, FreeFrequenciesAreThoseOfTheFormula) {
  for (int n : {1, 4, 20}) {
    const Beam beam =
        Make(MakeShaft(0.02, n, BeamDescription::Flexibility::kTorsion, JointType::kRevolute));
    const std::vector<double> frequencies = CalcFrequencies(beam.mechanism);
    ASSERT_EQ(frequencies.size(), static_cast<size_t>(n + 1));
    EXPECT_NEAR(frequencies[0] / frequencies[1], 0, 1e-6);
    for (int k = 1; k <= n; ++k) {
      const double x = k * pi / (2 * n);
      const double continuum = k / (2 * kLength) * std::sqrt(kG / kDensity);
      EXPECT_NEAR(frequencies[k] / (continuum * std::sin(x) / x), 1, 1e-10)
          << "n = " << n << ", k = " << k;
    }
  }
}

TEST(TorsionChain, ConvergesToTheContinuumWithOrderTwo) {
  const double continuum = std::sqrt(kG / kDensity) / 4;
  const auto error = [&](int n) {
    return CalcFrequencies(
               Make(MakeShaft(0.02, n, BeamDescription::Flexibility::kTorsion)).mechanism)[0] /
               continuum -
           1;
  };
  EXPECT_NEAR(std::log2(error(8) / error(16)), 2, 0.02);
  EXPECT_NEAR(std::log2(error(16) / error(32)), 2, 0.01);
}

TEST(SpatialBeam, ClampedBendingConvergesToTheContinuumWithOrderTwo) {
  // thin, so that neither rotary inertia nor shear is seen: Euler-Bernoulli, cos β cosh β = -1
  const double d = 0.002;
  const double speed = std::sqrt(kE * d * d / 16 / kDensity) / (2 * pi);
  const double beta[] = {1.8751040687119612, 4.6940911329741746};
  double error[2][3];
  for (int i = 0; i < 3; ++i) {
    const auto frequencies = CalcFrequencies(
        Make(MakeShaft(d, 8 << i, BeamDescription::Flexibility::kTorsionAndBending)).mechanism);
    for (int k = 0; k < 2; ++k) {
      // both planes bend alike
      EXPECT_NEAR(frequencies[2 * k] / frequencies[2 * k + 1], 1, 1e-8);
      error[k][i] = frequencies[2 * k] / (speed * beta[k] * beta[k]) - 1;
    }
  }
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(std::log2(error[k][1] / error[k][2]), 2, 0.05) << "mode " << k + 1;
  }
}

TEST(SpatialBeam, StaticDeflectionIsTheFormulas) {
  const double d = 0.02, I = pi / 64 * d * d * d * d, A = pi / 4 * d * d, L = kLength;
  const double F = 3, M = 2, kappa = 10.0 / 9;
  for (const auto flexibility :
       {BeamDescription::Flexibility::kTorsionAndBending, BeamDescription::Flexibility::kAll}) {
    for (int n : {1, 3, 8}) {
      SCOPED_TRACE(n);
      const bool all = flexibility == BeamDescription::Flexibility::kAll;
      const BeamDescription beam = MakeShaft(d, n, flexibility);
      const double deflection = F * L * L * L / (3 * kE * I) * (1 - 1.0 / (4.0 * n * n)) +
                                (all ? kappa * F * L / (kG * A) : 0);
      EXPECT_NEAR(CalcEndDisplacement(beam, {0, F, 0}, {}).v.y / deflection, 1, 1e-10);
      EXPECT_NEAR(CalcEndDisplacement(beam, {0, 0, F}, {}).v.z / deflection, 1, 1e-10);
      EXPECT_NEAR(CalcEndDisplacement(beam, {}, {0, 0, M}).w.z / (M * L / (kE * I)), 1, 1e-10);
      EXPECT_NEAR(CalcEndDisplacement(beam, {}, {0, M, 0}).w.y / (M * L / (kE * I)), 1, 1e-10);
      EXPECT_NEAR(CalcEndDisplacement(beam, {}, {M, 0, 0}).w.x / (M * L / (kG * 2 * I)), 1, 1e-10);
      if (all) {
        EXPECT_NEAR(CalcEndDisplacement(beam, {F, 0, 0}, {}).v.x / (F * L / (kE * A)), 1, 1e-10);
      }
    }
  }
}

TEST(SpatialBeam, ShearAndTensionCanBeChosenEachForItself) {
  BeamDescription beam = MakeShaft(0.02, 4, BeamDescription::Flexibility::kAll);
  const math::Motion<double> all = CalcEndDisplacement(beam, {5, 3, 0}, {});
  beam.tension = false;
  const math::Motion<double> shear = CalcEndDisplacement(beam, {5, 3, 0}, {});
  EXPECT_NEAR(shear.v.y / all.v.y, 1, 1e-10);
  EXPECT_EQ(shear.v.x, 0);
  beam.tension = true;
  beam.shear = false;
  const math::Motion<double> tension = CalcEndDisplacement(beam, {5, 3, 0}, {});
  EXPECT_NEAR(tension.v.x / all.v.x, 1, 1e-10);
  EXPECT_LT(tension.v.y, all.v.y);
}

TEST(SpatialBeam, WithoutSpringsIsARigidLink) {
  const Beam beam = Make(MakeShaft(0.02, 0, BeamDescription::Flexibility::kAll, JointType::kFree));
  ASSERT_EQ(beam.parts.bodies.size(), 1u);
  EXPECT_EQ(beam.mechanism.system.model.velocities, 6);
  EXPECT_NEAR(beam.mechanism.system.model.links[1].mass, pi / 4 * 4e-4 * kDensity, 1e-12);
  EXPECT_NEAR(beam.parts.end.X_BF.p.x, kLength, 1e-15);
}

TEST(SpatialBeam, LargeBendingUnderAnEndMomentIsACircle) {
  // M = 2 (E I/L): every joint turns by 2/n; damped to rest in the mind of the equations: the exact
  // static position has no acceleration
  const int n = 6;
  const BeamDescription description =
      MakeShaft(0.02, n, BeamDescription::Flexibility::kTorsionAndBending);
  const double EI = kE * pi / 64 * 1.6e-7;
  const Beam beam = Make(description, {}, {0, 0, 2 * EI / kLength});
  std::vector<double> y = beam.mechanism.start, rate(beam.mechanism.system.size());
  for (const Mechanism::JointPlace& joint : beam.mechanism.joints) {
    y[joint.q] = std::cos(1.0 / n), y[joint.q + 3] = std::sin(1.0 / n);
  }
  mechanism::Evaluator evaluator(beam.mechanism.system);
  evaluator.CalcRates(0, beam.mechanism.start, rate);
  const double before = CalcLargest(rate);
  evaluator.CalcRates(0, y, rate);
  EXPECT_LT(CalcLargest(rate), 1e-10 * before);
}

TEST(Beams, DampingHasTheMaterialsTimeConstant) {
  bodies::BeamSegment segment;
  segment.length = 0.5;
  segment.section = bodies::TubeSection{0.03, 0.02};
  segment.end = bodies::TubeSection{0.05, 0.02};
  segment.material = {kE, kG, kDensity, 1e-5 * kE, 2e-5 * kG};
  const bodies::BeamElements elements = bodies::MakeBeamElements({segment}, 3);
  for (const auto& spring : elements.springs) {
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(spring.damping[i] / spring.stiffness[i], i == 0 || i > 3 ? 1e-5 : 2e-5, 1e-18);
    }
  }
}

TEST(Beams, AnswerIsAsGoodWithAllForcesInMotion) {
  // energies and derivatives of a whole beam in a random state
  BeamDescription description = MakeShaft(0.02, 2, BeamDescription::Flexibility::kAll);
  for (auto& spring : description.elements.springs) {
    for (int i = 0; i < 6; ++i) spring.damping[i] = 1e-4 * spring.stiffness[i];
  }
  const Beam beam = Make(description);
  CheckPower(beam.mechanism, MakeRandomState(beam.mechanism, 3, 0.3));
  CheckJacobian(beam.mechanism, MakeRandomState(beam.mechanism, 3, 0.3));
}

}  // namespace
}  // namespace kingpin::joints
