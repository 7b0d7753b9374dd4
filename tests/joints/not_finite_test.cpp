#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bodies/rigid_inertia.h"
#include "core/solve/simulate.h"
#include "joints/mechanism_builder.h"
#include "tests/floating_point_traps.h"

// A user's function may return anything. What is not a number ends the run, with the culprit's
// name.

namespace kingpin::joints {
namespace {

using solve::Method;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

MechanismBuilder MakeBlock() {
  MechanismBuilder m("block");
  m.AddBody("block", bodies::MakeBox(2, {0.1, 0.2, 0.3}));
  m.AddPrismatic("slide", At("world"), At("block"), {1, 0, 0}).Velocity(0.1);
  m.AddSpring("spring", OnCoordinate{"slide"}).Stiffness(100).Damping(1);
  return m;
}

void ExpectNamed(const MechanismBuilder& m, const std::string& message) {
  const WithoutTraps nan_is_the_subject;
  const Mechanism mechanism = m.Make();
  for (Method method :
       {Method::kRungeKutta4, Method::kRosenbrock, Method::kExplicit8, Method::kBdf}) {
    solve::SimulationOptions options;
    options.stepper.method = method;
    options.stepper.step = 1e-3;
    std::vector<double> y = mechanism.start;
    double last = 0;
    try {
      Simulate(mechanism.system, options, y, [&](double t, auto state, auto&) {
        last = t;
        EXPECT_TRUE(std::isfinite(state[0]));
      });
      ADD_FAILURE() << "no error: " << message << ", method " << static_cast<int>(method);
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
    EXPECT_LT(last, 0.5001);
  }
}

double FailAfter(double t) { return t < 0.5 ? 0 : kNaN; }

TEST(NotFinite, ACallbackIsNamed) {
  MechanismBuilder m = MakeBlock();
  m.AddCallback("good", OnCoordinate{"slide"}, [](double, double x, double) { return -x; });
  m.AddCallback("bad", OnCoordinate{"slide"},
                [](double t, double, double) { return FailAfter(t); });
  ExpectNamed(m, "force 'bad' is not a finite number at t = 0.5");
}

TEST(NotFinite, AnInfiniteOneToo) {
  MechanismBuilder m = MakeBlock();
  m.AddCallback("pole", OnCoordinate{"slide"},
                [](double t, double, double) { return t < 0.5 ? 1.0 : HUGE_VAL; });
  ExpectNamed(m, "force 'pole' is not a finite number at t = 0.5");
}

TEST(NotFinite, AWrenchIsNamed) {
  MechanismBuilder m = MakeBlock();
  m.AddWrenchCallback("wrench", At("world"), At("block"),
                      [](double t, const RelativeMotion<double>&) {
                        return math::Wrench<double>{{0, FailAfter(t), 0}, {}};
                      });
  ExpectNamed(m, "force 'wrench' is not a finite number at t = 0.5");
}

// A limit does not make a number of it.
TEST(NotFinite, AMotorWithALimitIsNamed) {
  MechanismBuilder m = MakeBlock();
  m.AddMotor("motor", OnCoordinate{"slide"}).Force(FailAfter).Limit(3);
  ExpectNamed(m, "force 'motor' is not a finite number at t = 0.5");
}

TEST(NotFinite, ALoadsScaleIsNamed) {
  MechanismBuilder m = MakeBlock();
  m.AddForce("load", At("block")).Force({1, 0, 0}).Scale(FailAfter);
  ExpectNamed(m, "force 'load' is not a finite number at t = 0.5");
}

TEST(NotFinite, AMotionIsNamed) {
  MechanismBuilder m = MakeBlock();
  m.AddBody("cart", bodies::MakeBox(2, {0.1, 0.2, 0.3}));
  m.AddPrismatic("rail", At("world"), At("cart"), {0, 1, 0});
  m.AddMotion("drive", OnCoordinate{"rail"}, [](double t) {
    return std::array<double, 3>{0, 0, FailAfter(t)};
  });
  ExpectNamed(m, "the motion that 'drive' follows is not a finite number at t = 0.5");
}

}  // namespace
}  // namespace kingpin::joints
