#include <gtest/gtest.h>

#include "bodies/rigid_inertia.h"
#include "core/solve/simulate.h"
#include "joints/add_forces.h"
#include "joints/mechanism_builder.h"
#include "tests/joints/example_mechanisms.h"

// Forces and motions that are functions of time. The Jacobians of the implicit methods leave the
// derivative by time out: as a W-method, the fixed-step one keeps its order with any matrix.

namespace kingpin::joints {
namespace {

using solve::Method;

std::vector<double> Integrate(const Mechanism& mechanism, Method method, double duration,
                              double step, int jacobian_every = 1) {
  solve::SimulationOptions options;
  options.stepper.method = method;
  options.stepper.step = step;
  options.stepper.jacobian_every = jacobian_every;
  options.stepper.projection_tolerance = 1e-13;
  options.stepper.relative_tolerance = 1e-12;
  options.stepper.absolute_tolerance = 1e-14;
  options.duration = duration;
  options.sample_interval = duration;
  std::vector<double> y = mechanism.start;
  Simulate(mechanism.system, options, y, [](double, auto, auto&) {});
  return y;
}

double CalcDistance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

double CalcOrder(const Mechanism& mechanism, Method method, double duration, double step,
                 int jacobian_every = 1) {
  const std::vector<double> exact = Integrate(mechanism, Method::kExplicit8, duration, step);
  const double coarse =
      CalcDistance(Integrate(mechanism, method, duration, step, jacobian_every), exact);
  const double fine =
      CalcDistance(Integrate(mechanism, method, duration, step / 2, jacobian_every), exact);
  return std::log2(coarse / fine);
}

// With a damper that decays at more than a hundred per second as well as without.
Mechanism MakeDriven(bool stiff) {
  Mechanism mechanism = MakeMechanism(MakeFourBar(5));
  MotorDescription motor;
  motor.name = "motor";
  motor.place = OnCoordinate{"A"};
  motor.force = [](double t) { return 5 * std::sin(30 * t) + 20 * t * t; };
  CallbackDescription callback;
  callback.name = "callback";
  callback.place = OnCoordinate{"D"};
  callback.force = [](double t, double x, double) { return 3 * std::cos(25 * t) * x; };
  std::vector<ForceDescription> forces = {motor, callback};
  if (stiff) {
    SpringDescription spring;
    spring.name = "damper";
    spring.place = OnCoordinate{"D"};
    spring.damping.coefficient = 60;
    forces.push_back(spring);
  }
  AddForces(forces, mechanism);
  return mechanism;
}

TEST(ExplicitTime, MethodsKeepTheirOrder) {
  const Mechanism driven = MakeDriven(false);
  EXPECT_NEAR(CalcOrder(driven, Method::kRungeKutta4, 0.5, 1e-3), 4, 0.3);
  EXPECT_NEAR(CalcOrder(driven, Method::kRosenbrock, 0.5, 2e-3), 3, 0.3);
  EXPECT_NEAR(CalcOrder(driven, Method::kRosenbrock, 0.5, 2e-3, 20), 3, 0.3);
  EXPECT_NEAR(CalcOrder(MakeDriven(true), Method::kRosenbrock, 0.5, 2e-3), 3, 0.3);
  EXPECT_LT(CalcDistance(Integrate(driven, Method::kBdf, 0.5, 1e-3),
                         Integrate(driven, Method::kExplicit8, 0.5, 1e-3)),
            1e-8);
}

TEST(ExplicitTime, MethodsKeepTheirOrderUnderAPrescribedMotion) {
  MechanismDescription d = MakeFourBar(5);
  d.joints[0].position = {1.0};
  d.joints[0].velocity = {};
  MotionDescription motion;
  motion.name = "drive";
  motion.joint = "A";
  motion.motion = [](double t) {
    return std::array<double, 3>{1 + 2 * t + 0.3 * std::sin(10 * t), 2 + 3 * std::cos(10 * t),
                                 -30 * std::sin(10 * t)};
  };
  d.motions = {motion};
  // a pendulum on the coupler is what remains free
  d.bodies.push_back(MakeRod("bob", 0.5, {0.2, 0, 0}, 0.01));
  d.joints.push_back(
      MakeJoint("E", JointType::kRevolute, "coupler", {0.5, 0, 0}, "bob", {0, -1, 0}));
  const Mechanism driven = MakeMechanism(d);
  EXPECT_NEAR(CalcOrder(driven, Method::kRungeKutta4, 0.5, 2e-3), 4, 0.3);
  EXPECT_NEAR(CalcOrder(driven, Method::kRosenbrock, 0.5, 2e-3), 3, 0.3);
}

// Every coordinate of every joint type follows its motion, under every method; the start, which is
// off it, is moved onto it.
TEST(PrescribedMotion, IsFollowedByEveryCoordinateOfEveryJoint) {
  const std::vector<std::pair<JointType, int>> joints = {
      {JointType::kRevolute, 1},    {JointType::kPrismatic, 1}, {JointType::kScrew, 1},
      {JointType::kCylindrical, 2}, {JointType::kUniversal, 2}, {JointType::kPlanar, 3},
      {JointType::kSpherical, 3},   {JointType::kFree, 6}};
  const auto motion = [](double t) {
    return std::array<double, 3>{0.3 + 0.2 * std::sin(5 * t), std::cos(5 * t),
                                 -5 * std::sin(5 * t)};
  };
  for (const auto& [type, coordinates] : joints) {
    const bool quaternion = type == JointType::kSpherical || type == JointType::kFree;
    for (int c = 0; c < coordinates; ++c) {
      MechanismBuilder m("driven");
      m.AddBody("body", bodies::Move(bodies::MakeBox(2, {0.1, 0.2, 0.3}), {{}, {0.1, 0.2, 0}}));
      m.AddJoint("joint", type, At("world"), At("body"), {0, 0, 1});
      m.AddMotion("drive", OnCoordinate{"joint", c}, motion);
      const Mechanism mechanism = m.Make();
      const mechanism::Model& model = mechanism.system.model;
      const Mechanism::JointPlace& place = mechanism.GetJoint("joint");
      for (Method method :
           {Method::kRungeKutta4, Method::kRosenbrock, Method::kExplicit8, Method::kBdf}) {
        solve::SimulationOptions options;
        options.stepper.method = method;
        options.stepper.step = 2.5e-4;
        options.duration = 0.5;
        options.sample_interval = 1e-3;  // adaptive steps end there: the books are of order four
        std::vector<double> y = mechanism.start;
        const solve::Ledger ledger = Simulate(
            mechanism.system, options, y, [&](double t, auto state, mechanism::Evaluator& e) {
              if (!quaternion) {
                EXPECT_NEAR(state[place.q + c], motion(t)[0], 1e-10);
              }
              EXPECT_NEAR(state[model.positions + place.v + c], motion(t)[1], 1e-9);
              EXPECT_NEAR(e.accelerations()[place.v + c], motion(t)[2], 1e-9);
            });
        // the drive's work is on the books
        EXPECT_LT(ledger.largest_energy_error, 1e-6 * std::max(ledger.largest_kinetic, 1.0))
            << static_cast<int>(type) << ' ' << c << ' ' << static_cast<int>(method);
        EXPECT_GT(std::abs(ledger.supplied), 1e-6);
      }
    }
  }
}

TEST(PrescribedMotion, AContradictionIsNamed) {
  MechanismBuilder m("driven twice");
  m.AddBody("body", bodies::MakeBox(2, {0.1, 0.2, 0.3}));
  m.AddRevolute("joint", At("world"), At("body"), {0, 0, 1});
  m.AddMotion("first", OnCoordinate{"joint"}, [](double t) {
    return std::array<double, 3>{t, 1, 0};
  });
  m.AddMotion("second", OnCoordinate{"joint"}, [](double t) {
    return std::array<double, 3>{0.1 + t, 1, 0};
  });
  try {
    m.Make();
    ADD_FAILURE();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("first"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("second"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace kingpin::joints
