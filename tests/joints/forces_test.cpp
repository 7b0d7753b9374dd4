#include <limits>

#include <gtest/gtest.h>

#include "core/solve/runge_kutta4.h"
#include "joints/add_forces.h"
#include "joints/callback.h"
#include "joints/element_group.h"
#include "joints/rotation_vector.h"
#include "tests/floating_point_traps.h"
#include "tests/joints/force_check.h"

namespace kingpin::joints {
namespace {

const FrameDescription kOnA =
    At("a", {0.2, -0.1, 0.3},
       math::MakeRotation(math::MakeQuaternion(Vector3<double>{0.2, 0.5, -0.3})));
const FrameDescription kOnB =
    At("b", {-0.1, 0.2, 0.1},
       math::MakeRotation(math::MakeQuaternion(Vector3<double>{-0.4, 0.1, 0.6})));

const PlaceDescription kPlaces[] = {BetweenPoints{kOnA, kOnB}, AboutAxis{kOnA, kOnB},
                                    OnCoordinate{"slide", 0}, OnCoordinate{"slide", 1}};

// Nodes where no random state of the tests comes near enough to matter.
LawDescription MakeCurve(LawDescription::Interpolation interpolation) {
  return {.coefficient = 0,
          .points = {{-2, -3000}, {-0.5, -400}, {0.03, 0}, {0.7, 900}, {2.1, 5000}},
          .interpolation = interpolation};
}
LawDescription MakeDampingCurve() {
  return {.coefficient = 0, .points = {{-1.5, -700}, {-0.3, -250}, {0, 0}, {0.35, 120}, {2, 300}}};
}

TEST(Springs, ForceIsTheGradientOfThePotentialAndPowerIsAccountedFor) {
  for (const PlaceDescription& place : kPlaces) {
    for (const auto interpolation :
         {LawDescription::Interpolation::kMonotone, LawDescription::Interpolation::kNatural}) {
      for (unsigned seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(testing::Message() << "place " << place.index() << " seed " << seed);
        MechanismBuilder elastic = MakeFlyingBodies();
        elastic.AddSpring("linear", place).Stiffness(700).Free(0.3).Preload(40);
        elastic.AddSpring("curved", place).Stiffness(MakeCurve(interpolation)).Free(0.2);
        const Mechanism conservative = elastic.Make();
        CheckGradient(conservative, MakeRandomState(conservative, seed, 0.5));
        elastic.AddSpring("damper", place).Damping(50);
        elastic.AddSpring("curved damper", place).Damping(MakeDampingCurve());
        const Mechanism damped = elastic.Make();
        const std::vector<double> y = MakeRandomState(damped, seed, 0.5);
        CheckPower(damped, y);
        CheckReaction(damped, y);
        CheckJacobian(damped, y);
      }
    }
  }
}

TEST(Springs, StartDistanceIsTheFreeLengthUnlessGiven) {
  MechanismBuilder m = MakeFlyingBodies();
  m.AddSpring("s", BetweenPoints{kOnA, kOnB}).Stiffness(1e5);
  const Mechanism mechanism = m.Make();
  ForceProbe probe(mechanism);
  EXPECT_LT(CalcLargest(probe.CalcGeneralised(0, mechanism.start)), 1e-9);
}

TEST(Springs, PreloadPulls) {
  MechanismBuilder m("");
  m.AddBody("b", MakeUnevenBody(1))
      .AddPrismatic("rail", At("world"), At("b"), {1, 0, 0})
      .Position(2);
  m.AddSpring("s", BetweenPoints{At("world"), At("b")}).Stiffness(10).Preload(7).Free(1.5);
  const Mechanism mechanism = m.Make();
  ForceProbe probe(mechanism);
  EXPECT_NEAR(probe.CalcGeneralised(0, mechanism.start)[0], -(10 * 0.5 + 7), 1e-12);
}

TEST(Springs, TwistBetweenAlignedAxesIsTheJointsAngle) {
  // the same spring on the coordinate and between the frames, beyond a right angle too
  for (double angle : {-2.5, -0.4, 0.0, 1e-9, 1.0, 3.0}) {
    MechanismBuilder on_joint("");
    on_joint.AddBody("b", MakeUnevenBody(1));
    on_joint.AddRevolute("pin", At("world"), At("b"), {0, 0, 1}).Position(angle).Velocity(0.7);
    MechanismBuilder between = on_joint;
    on_joint.AddSpring("s", OnCoordinate{"pin"}).Stiffness(20).Damping(3);
    between.AddSpring("s", AboutAxis{At("world"), At("b")}).Stiffness(20).Damping(3);
    const Mechanism one = on_joint.Make(), two = between.Make();
    EXPECT_NEAR(ForceProbe(one).CalcGeneralised(0, one.start)[0],
                ForceProbe(two).CalcGeneralised(0, two.start)[0], 1e-12);
  }
}

TEST(Bushing, TorqueIsTheGradientOfThePotentialAtAnyAngle) {
  mechanism::RandomMechanism random(5);
  BushingDescription::Matrix6 K{}, C{};
  Eigen::Matrix<double, 6, 6> root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = 10 * random.Normal();
  const Eigen::Matrix<double, 6, 6> square = root * root.transpose();
  for (int i = 0; i < 36; ++i) K[i / 6][i % 6] = square(i / 6, i % 6);
  for (int i = 0; i < 36; ++i) C[i / 6][i % 6] = 0.1 * square(5 - i / 6, 5 - i % 6);
  // 0: all aligned, where series replace quotients; 1e-3: next to that; 2: far turned
  for (double turn : {0.0, 1e-3, 0.3, 2.0}) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
      SCOPED_TRACE(testing::Message() << "turn " << turn << " seed " << seed);
      MechanismBuilder m = MakeFlyingBodies();
      const FrameDescription a = At("a", kOnA.X_BF.p), b = At("b", kOnB.X_BF.p);
      m.AddBushing("linear", a, b)
          .Stiffness({1000, 2000, 1500, 300, 200, 250})
          .Preload({10, -20, 5, 3, -2, 1});
      m.AddBushing("coupled", b, a).CoupledStiffness(K);
      m.AddBushing("curved", a, b)
          .Stiffness(1, MakeCurve(LawDescription::Interpolation::kNatural))
          .Stiffness(5, MakeCurve(LawDescription::Interpolation::kMonotone));
      const Mechanism elastic = m.Make();
      CheckGradient(elastic, MakeRandomState(elastic, seed, turn));
      m.AddBushing("damped", a, b).Damping({20, 30, 40, 5, 6, 7}).CoupledDamping(C);
      m.AddBushing("curved damping", a, b).Damping(3, MakeDampingCurve());
      const Mechanism damped = m.Make();
      const std::vector<double> y = MakeRandomState(damped, seed, turn);
      CheckPower(damped, y);
      CheckReaction(damped, y);
      CheckJacobian(damped, y);
    }
  }
}

TEST(Bushing, RotationVectorIsTheLogarithmInEveryBranch) {
  mechanism::RandomMechanism random(3);
  for (double angle : {0.0, 1e-12, 1e-5, 0.19, 0.21, 1.0, 2.2, 3.0, 3.14159}) {
    for (int k = 0; k < 20; ++k) {
      const Vector3<double> r = angle * random.UnitVector();
      const RotationVector<double> found(math::MakeRotation(math::MakeQuaternion(r)));
      EXPECT_LT(CalcNorm(found.r - r), 1e-14 * (1 + 1 / (3.1416 - angle)));
      // the two ways of working with one torque agree: m·ṙ = torque·ω
      const Vector3<double> m = random.NormalVector(), w = random.NormalVector();
      EXPECT_NEAR(Dot(m, found.CalcRate(w)), Dot(found.CalcTorque(m), w), 1e-12);
    }
  }
}

TEST(Stops, PushOnlyAndTakeEnergyOnly) {
  for (const PlaceDescription& place : kPlaces) {
    for (bool upper : {true, false}) {
      for (unsigned seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(testing::Message() << "place " << place.index() << " seed " << seed);
        MechanismBuilder m = MakeFlyingBodies();
        const auto limit = [&](MechanismBuilder::Stop stop, double at) {
          return upper ? stop.Above(-at) : stop.Below(at);
        };
        // far beyond the limit, near it, and not reached
        limit(m.AddStop("power", place), 2.5).Stiffness(4000, 1.7).Damping(90, 0.5);
        limit(m.AddStop("linear", place), 2.2).Stiffness(3000).Damping(1e5);
        limit(m.AddStop("curve", place), 2.9)
            .Stiffness({.coefficient = 0, .points = {{0, 0}, {1.1, 900}, {9.7, 5000}}});
        m.AddStop("far", place).Above(50).Stiffness(1e5);
        const Mechanism mechanism = m.Make();
        const std::vector<double> y = MakeRandomState(mechanism, seed, 0.4);
        CheckGradient(mechanism, y);
        CheckPower(mechanism, y);
        CheckReaction(mechanism, y);
        CheckJacobian(mechanism, y);
      }
    }
  }
}

TEST(Stops, DampingNeverPulls) {
  MechanismBuilder m("");
  m.AddBody("b", MakeUnevenBody(1)).AddPrismatic("rail", At("world"), At("b"), {1, 0, 0});
  m.AddStop("stop", OnCoordinate{"rail"}).Above(0.1).Stiffness(1000).Damping(500);
  const Mechanism mechanism = m.Make();
  ForceProbe probe(mechanism);
  for (double x : {0.0, 0.0999, 0.1, 0.1001, 0.12, 0.3}) {
    for (double speed : {-100.0, -1.0, 0.0, 1.0, 100.0}) {
      const double push = -probe.CalcGeneralised(0, {x, speed})[0];
      EXPECT_GE(push, 0);
      if (x <= 0.1) {
        EXPECT_EQ(push, 0);
      }
    }
  }
  EXPECT_NEAR(-probe.CalcGeneralised(0, {0.3, 1})[0], 1000 * 0.2 + 500, 1e-9);
  // the force rises from zero at contact, however fast
  EXPECT_NEAR(-probe.CalcGeneralised(0, {0.1 + 1e-8, 10})[0], 0, 1e-4);
}

TEST(Motors, SuppliedPowerAndDerivatives) {
  for (const PlaceDescription& place : kPlaces) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      MechanismBuilder m = MakeFlyingBodies();
      m.AddMotor("torque", place).Force([](double t) { return 30 * std::sin(5 * t); });
      m.AddMotor("servo", place)
          .Follow(
              [](double t) {
                return std::array<double, 3>{t * t, 2 * t, 2};
              },
              800, 40);
      m.AddMotor("saturated", place).Follow({}, 1e6, 0).Limit(25);
      const Mechanism mechanism = m.Make();
      const std::vector<double> y = MakeRandomState(mechanism, seed, 0.5);
      CheckPower(mechanism, y);
      CheckReaction(mechanism, y);
      CheckJacobian(mechanism, y);
    }
  }
}

TEST(Callbacks, SuppliedPowerAndDerivatives) {
  const auto wrench = [](double t, const RelativeMotion<double>& motion) {
    return math::Wrench<double>{
        {3 * motion.R.x.y, -motion.w.y, motion.p.x * motion.v.z},
        {std::cos(t) * motion.p.y, 5 - 4 * motion.v.x * motion.v.x, 7 * motion.R.z.z}};
  };
  for (const PlaceDescription& place : kPlaces) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      MechanismBuilder m = MakeFlyingBodies();
      m.AddCallback("law", place, [](double t, double x, double rate) {
        return 20 * t - 40 * x * x * x - 3 * rate * std::abs(rate);
      });
      m.AddWrenchCallback("wrench", kOnA, kOnB, wrench);
      const Mechanism mechanism = m.Make();
      const std::vector<double> y = MakeRandomState(mechanism, seed, 0.5);
      CheckPower(mechanism, y);
      CheckReaction(mechanism, y);
      CheckJacobian(mechanism, y);
    }
  }
}

struct CubicPull {
  template <class S>
  math::Wrench<S> operator()(const S& /*time*/, const RelativeMotion<S>& motion) const {
    return {S(-2.0) * motion.w, (S(-3.0) * Dot(motion.p, motion.p)) * motion.p};
  }
};

TEST(Callbacks, ATemplatedFunctionHasItsDerivatives) {
  Mechanism mechanism = MakeFlyingBodies().Make();
  auto group = std::make_unique<ElementGroup<WrenchFunction<CubicPull>>>();
  group->Add("pull", {mechanism.MakeFrame(kOnA), mechanism.MakeFrame(kOnB), {}});
  mechanism.system.Add(std::move(group));
  const std::vector<double> y = MakeRandomState(mechanism, 1, 0.5);
  CheckPower(mechanism, y);
  CheckReaction(mechanism, y);
  CheckJacobian(mechanism, y);
}

TEST(BodyForces, SuppliedPowerAndDerivatives) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    MechanismBuilder m = MakeFlyingBodies();
    m.AddForce("world", kOnA).Force({10, -20, 30}).Torque({1, 2, -3});
    m.AddForce("frame", kOnB).Force({-5, 7, 9}).Torque({4, 0, 2}).InFrame().Scale([](double t) {
      return 1 + t;
    });
    const Mechanism mechanism = m.Make();
    const std::vector<double> y = MakeRandomState(mechanism, seed, 0.8);
    CheckPower(mechanism, y);
    CheckJacobian(mechanism, y);
  }
}

// E + ∫(dissipated - supplied) dt over a run, by Simpson's rule over pairs of steps, minus its
// start.
double CalcImbalance(const Mechanism& mechanism, double duration, int steps) {
  mechanism::Evaluator evaluator(mechanism.system);
  solve::RungeKutta4 method(mechanism.system);
  std::vector<double> y = mechanism.start, rate(mechanism.system.size());
  const double h = duration / steps;
  double work = 0, first = 0, last = 0;
  for (int n = 0; n <= steps; ++n) {
    evaluator.CalcRates(n * h, y, rate);
    const mechanism::Energy energy = evaluator.CalcEnergy(n * h, y);
    const double weight = n == 0 || n == steps ? 1 : n % 2 ? 4 : 2;
    work += weight * h / 3 * (energy.supplied - energy.dissipated);
    last = energy.kinetic + energy.potential;
    if (n == 0) first = last;
    if (n < steps) method.Step(evaluator, n * h, h, y);
  }
  return last - first - work;
}

TEST(EnergyLedger, BalancesToTheIntegratorsOrder) {
  MechanismBuilder m = MakeFlyingBodies();
  m.Gravity({0, 0, -9.81});
  m.AddBushing("mount", At("world", {0.1, 0.2, -0.1}), At("a"))
      .Stiffness({4000, 3000, 5000, 60, 80, 70})
      .Damping({20, 20, 20, 1, 1, 1});
  m.AddSpring("link", BetweenPoints{kOnA, kOnB}).Stiffness(900).Damping(15);
  // holds b upright: the twist below is singular for opposite axes
  m.AddBushing("hold", At("a"), At("b")).Stiffness({300, 200, 200, 150, 150, 150});
  m.AddSpring("twist", AboutAxis{At("a"), At("b")}).Stiffness(40).Damping(2);
  m.AddSpring("slider", OnCoordinate{"slide", 0}).Stiffness(300).Damping(5);
  m.AddSpring("turner", OnCoordinate{"slide", 1}).Stiffness(20).Damping(0.3);
  m.AddMotor("motor", OnCoordinate{"slide", 1}).Force([](double t) { return std::sin(9 * t); });
  m.AddForce("push", kOnB).Force({3, 8, -2}).InFrame();
  m.AddCallback("drag", BetweenPoints{At("world"), kOnB},
                [](double, double, double rate) { return -2 * rate * rate * rate; });
  const Mechanism mechanism = m.Make();
  // of the order down to nothing: no share of the power is missing
  const double coarse = CalcImbalance(mechanism, 1, 400);
  const double fine = CalcImbalance(mechanism, 1, 800);
  const double finest = CalcImbalance(mechanism, 1, 1600);
  EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 4, 0.4);
  EXPECT_NEAR(std::log2(std::abs(fine / finest)), 4, 0.4);
}

TEST(EnergyLedger, AStateThatIsNotFiniteEndsTheRun) {
  const WithoutTraps nan_is_the_subject;
  const Mechanism mechanism = MakeFlyingBodies().Make();
  mechanism::Evaluator evaluator(mechanism.system);
  std::vector<double> y = mechanism.start, rate(mechanism.system.size());
  y[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(evaluator.CalcRates(0, y, rate), std::runtime_error);
}

TEST(EnergyLedger, BalancesThroughAStop) {
  MechanismBuilder m("drop");
  m.AddBody("b", bodies::MakeSphere(2, 0.1));
  m.AddPrismatic("fall", At("world"), At("b"), {0, 0, 1}).Position(0.3);
  m.AddStop("ground", OnCoordinate{"fall"}).Below(0).Stiffness(2e5, 1.5).Damping(300, 0.01);
  const Mechanism mechanism = m.Make();
  // 2 kg from 0.3 m: 5.9 J. At contact the force has kinks, where the order is lost: a step across
  // it may miss at most the work that the stop does over the depth u h that one step reaches,
  // k (u h)^2.5/2.5 of the spring, and of the damper, which rises as 3 (u h/depth)², its product
  // with u h. No more than four bounces happen, with two crossings each, none faster than the
  // first.
  const double u = std::sqrt(2 * 9.80665 * 0.3);
  for (int steps : {20000, 80000}) {
    const double d = u / steps;
    const double bound =
        8 * (2e5 / 2.5 * std::pow(d, 2.5) + 300 * u * 3 * (d / 0.01) * (d / 0.01) * d);
    EXPECT_LT(std::abs(CalcImbalance(mechanism, 1, steps)), bound);
  }
}

TEST(EnergyLedger, MomentumOfFreeBodiesStays) {
  MechanismBuilder m = MakeFlyingBodies();
  m.AddBushing("mount", kOnA, kOnB).Stiffness({400, 300, 500, 6, 8, 7}).Damping({2, 2, 2, 1, 1, 1});
  m.AddSpring("slider", OnCoordinate{"slide", 0}).Stiffness(300).Damping(5);
  const Mechanism mechanism = m.Make();
  mechanism::Evaluator evaluator(mechanism.system);
  solve::RungeKutta4 method(mechanism.system);
  std::vector<double> y = MakeRandomState(mechanism, 4, 0.3), rate(mechanism.system.size());
  const auto momentum = [&] {
    evaluator.CalcRates(0, y, rate);
    const auto& w = evaluator.workspace();
    math::Wrench<double> sum;
    const auto& links = mechanism.system.model.links;
    for (size_t l = 1; l < links.size(); ++l) {
      sum = sum + math::MakeInertia(links[l].mass, links[l].centre, links[l].central_inertia,
                                    w.R[l], w.p[l]) *
                      w.V[l];
    }
    sum.t += Cross(w.reference, sum.f);  // about the world's origin
    return sum;
  };
  const math::Wrench<double> before = momentum();
  for (int n = 0; n < 2000; ++n) method.Step(evaluator, n * 5e-4, 5e-4, y);
  const math::Wrench<double> after = momentum();
  // the method's own error at this step
  EXPECT_LT(CalcNorm(after.f - before.f), 1e-8 * CalcNorm(before.f));
  EXPECT_LT(CalcNorm(after.t - before.t), 1e-8 * CalcNorm(before.t));
}

// Two routes to the six frequencies of a body on mounts: the engine's derivatives, and K assembled
// by hand from each mount's Jacobian [1, -p×; 0, 1].
TEST(Bushing, SixFrequenciesOfABodyOnThreeMounts) {
  struct Mount {
    Vector3<double> p;
    std::array<double, 6> k;
  };
  const Mount mounts[] = {{{0.5, 0.3, -0.2}, {8e4, 6e4, 2e5, 20, 20, 20}},
                          {{0.5, -0.3, -0.2}, {8e4, 6e4, 2e5, 20, 20, 20}},
                          {{-0.6, 0, -0.1}, {1.2e5, 5e4, 1.5e5, 30, 30, 30}}};
  MechanismBuilder m("powertrain");
  m.Gravity({0, 0, 0});
  m.AddBody("engine", bodies::MakeFromPrincipalMoments(150, {}, {6, 12, 14}));
  m.AddFree("fly", At("world"), At("engine"));
  Eigen::Matrix<double, 6, 6> K = Eigen::Matrix<double, 6, 6>::Zero(), M = K;
  M.diagonal() << 150, 150, 150, 6, 12, 14;
  for (const Mount& mount : mounts) {
    const auto& p = mount.p;
    m.AddBushing(fmt::format("mount {}", &mount - mounts), At("world", p), At("engine", p))
        .Stiffness(mount.k);
    Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Identity();
    J.topRightCorner<3, 3>() << 0, p.z, -p.y, -p.z, 0, p.x, p.y, -p.x, 0;
    K += J.transpose() *
         Eigen::Map<const Eigen::Matrix<double, 6, 1>>(mount.k.data()).asDiagonal() * J;
  }
  const Mechanism mechanism = m.Make();
  mechanism::JacobianEvaluator derivatives(mechanism.system);
  Eigen::MatrixXd jacobian(6, 12);
  derivatives.Calc(0, mechanism.start, {}, jacobian);
  Eigen::VectorXd ours = (-jacobian.leftCols(6)).eigenvalues().real();
  std::sort(ours.begin(), ours.end());
  const Eigen::VectorXd expected =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(K, M).eigenvalues();
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(std::sqrt(ours[i] / expected[i]), 1, 1e-10) << i;
  }
}

}  // namespace
}  // namespace kingpin::joints
