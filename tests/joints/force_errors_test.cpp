#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "joints/add_forces.h"
#include "tests/floating_point_traps.h"
#include "tests/joints/force_check.h"

namespace kingpin::joints {
namespace {

using testing::HasSubstr;

std::string FindError(ForceDescription force) {
  std::visit(
      [](auto& f) {
        f.name = f.name.empty() ? "f" : f.name, f.source = {"car.yaml", 7};
      },
      force);
  Mechanism mechanism = MakeFlyingBodies().Make();
  try {
    AddForces({force}, mechanism);
  } catch (const io::InputError& error) {
    EXPECT_EQ(error.problem().file, "car.yaml");
    EXPECT_EQ(error.problem().line, 7);
    return error.what();
  }
  return "no error";
}

SpringDescription MakeSpring() {
  SpringDescription spring;
  spring.place = OnCoordinate{"slide", 0};
  return spring;
}

TEST(ForceErrors, UnknownNamesAreSuggested) {
  SpringDescription spring = MakeSpring();
  spring.place = OnCoordinate{"slyde", 0};
  EXPECT_EQ(FindError(spring),
            "car.yaml:7: forces.f.joint: found 'slyde', expected the name of a joint that moves; "
            "did you mean 'slide'?");
  BushingDescription bushing;
  bushing.a = At("a");
  bushing.b = At("d");
  EXPECT_THAT(FindError(bushing), HasSubstr("forces.f.b: found 'd', expected the name of a body"));
}

TEST(ForceErrors, PlacesThatCannotBe) {
  SpringDescription spring = MakeSpring();
  spring.place = OnCoordinate{"slide", 2};
  EXPECT_THAT(FindError(spring), HasSubstr("expected a coordinate from 0 to 1"));
  spring.place = OnCoordinate{"fly_a", 0};
  EXPECT_THAT(FindError(spring), HasSubstr("whose rotation is a quaternion"));
  spring.place = BetweenPoints{At("a"), At("a", {1, 0, 0})};
  EXPECT_THAT(FindError(spring), HasSubstr("'a' and 'a', which move as one"));
  spring.place = BetweenPoints{At("a", {0.3, 0.3, 1}), At("b")};
  EXPECT_THAT(FindError(spring), HasSubstr("points that do not coincide"));
  spring.place = AboutAxis{At("a"), At("b", {}, {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}})};
  EXPECT_THAT(FindError(spring), HasSubstr("z axes that are opposite at the start"));
  BodyForceDescription force;
  force.at = At("world");
  EXPECT_THAT(FindError(force), HasSubstr("'world', which does not move"));
  force.at = At("a", {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_THAT(FindError(force), HasSubstr("expected a pose"));
}

TEST(ForceErrors, LawsThatCannotBe) {
  const WithoutTraps nan_is_the_subject;
  const auto law = [](LawDescription stiffness) {
    SpringDescription spring = MakeSpring();
    spring.stiffness = std::move(stiffness);
    return FindError(spring);
  };
  EXPECT_EQ(
      law({.coefficient = -5, .points = {}}),
      "car.yaml:7: forces.f.stiffness: found -5, expected a number that is not negative; give "
      "a falling characteristic by points");
  EXPECT_THAT(law({.coefficient = std::numeric_limits<double>::quiet_NaN(), .points = {}}),
              HasSubstr("expected a finite number"));
  EXPECT_THAT(law({.coefficient = 5, .points = {{0, 0}, {1, 1}}}), HasSubstr("one of the two"));
  EXPECT_THAT(law({.coefficient = 0, .points = {{0, 0}}}), HasSubstr("found 1 points"));
  EXPECT_THAT(law({.coefficient = 0, .points = {{0, 0}, {0, 1}}}),
              HasSubstr("arguments in rising order"));
  EXPECT_THAT(law({.coefficient = 0, .points = {{0, 0}, {1, 2}, {2, 1}}, .must_rise = true}),
              HasSubstr("forces that do not fall"));
  EXPECT_THAT(law({.coefficient = 0,
                   .points = {{0, 0}, {1, 0}, {1.1, 5}, {2, 5}},
                   .interpolation = LawDescription::Interpolation::kNatural,
                   .must_rise = true}),
              HasSubstr("use monotone interpolation"));
  EXPECT_EQ(law({.coefficient = 0, .points = {{0, 0}, {1, 2}, {2, 1}}}), "no error");

  SpringDescription damper = MakeSpring();
  damper.damping.points = {{-1, -5}, {0, 0}, {1, -1}};
  EXPECT_THAT(FindError(damper), HasSubstr("a damper that never drives"));
  damper.damping.points = {{-1, -5}, {1, 6}};  // not zero at rest
  EXPECT_THAT(FindError(damper), HasSubstr("a damper that never drives"));
}

TEST(ForceErrors, StopsMotorsAndFunctions) {
  StopDescription stop;
  stop.place = OnCoordinate{"slide", 0};
  EXPECT_THAT(FindError(stop), HasSubstr("a stiffness above zero"));
  stop.stiffness.points = {{0, 10}, {1, 20}};
  EXPECT_THAT(FindError(stop), HasSubstr("no force at contact"));
  stop.stiffness.points = {{0, 0}, {1, 20}};
  stop.exponent = 2;
  EXPECT_THAT(FindError(stop), HasSubstr("forces.f.exponent"));
  stop.stiffness = {.coefficient = 100, .points = {}};
  stop.exponent = 0.5;
  EXPECT_THAT(FindError(stop), HasSubstr("an exponent of 1 or more"));
  stop.exponent = 1;
  stop.depth = 0;
  EXPECT_THAT(FindError(stop), HasSubstr("a depth above zero"));
  stop.depth = 1e-3;
  stop.damping = -1;
  EXPECT_THAT(FindError(stop), HasSubstr("forces.f.damping: found -1"));

  MotorDescription motor;
  motor.place = OnCoordinate{"slide", 0};
  motor.target = [](double) { return std::array<double, 3>{}; };
  EXPECT_THAT(FindError(motor), HasSubstr("a motion follows a target exactly"));
  CallbackDescription callback;
  callback.place = OnCoordinate{"slide", 0};
  EXPECT_THAT(FindError(callback), HasSubstr("forces.f.force: found nothing"));
}

TEST(ForceErrors, CoupledMatricesHaveAPotential) {
  BushingDescription bushing;
  bushing.a = At("a");
  bushing.b = At("b");
  BushingDescription::Matrix6 K{};
  for (int i = 0; i < 6; ++i) K[i][i] = i < 3 ? 1e6 : 100;
  K[0][4] = 50;
  bushing.coupled_stiffness = K;
  EXPECT_THAT(FindError(bushing), HasSubstr("a symmetric matrix"));
  K[4][0] = 50;
  bushing.coupled_stiffness = K;
  EXPECT_EQ(FindError(bushing), "no error");
  K[0][4] = K[4][0] = 2e4;  // more than √(1e6 100)
  bushing.coupled_stiffness = K;
  EXPECT_THAT(FindError(bushing), HasSubstr("positive semi-definite"));
}

TEST(ForceErrors, NamesAreUnique) {
  Mechanism mechanism = MakeFlyingBodies().Make();
  SpringDescription spring = MakeSpring();
  spring.name = "s";
  MotorDescription motor;
  motor.name = "s";
  motor.place = OnCoordinate{"slide", 0};
  EXPECT_THROW(AddForces({spring, motor}, mechanism), io::InputError);
}

TEST(MechanismBuilder, ErrorsNameTheLineThatAddedTheCulprit) {
  MechanismBuilder m = MakeFlyingBodies();
  m.AddSpring("s", OnCoordinate{"slide"}).Stiffness(-1);
  const int line = __LINE__ - 1;
  try {
    m.Make();
    FAIL();
  } catch (const io::InputError& error) {
    EXPECT_EQ(error.problem().line, line);
    EXPECT_THAT(error.problem().file, HasSubstr("force_errors_test.cpp"));
  }
}

TEST(MechanismBuilder, ClosuresCouplingsAndMotionsInAFewLines) {
  // slider-crank with a gear to a counter shaft
  MechanismBuilder m("slider-crank");
  const Vector3<double> y{0, 1, 0};
  m.AddBody("crank", bodies::Move(bodies::MakeRod(1, 0.2), {{}, {0.1, 0, 0}}));
  m.AddBody("rod", bodies::Move(bodies::MakeRod(1, 0.5), {{}, {0.25, 0, 0}}));
  m.AddBody("slider", bodies::MakeBox(2, {0.1, 0.1, 0.1}));
  m.AddBody("shaft", bodies::MakeCylinder(1, 0.05, 0.1));
  m.AddRevolute("main", At("world"), At("crank"), y).Position(0.5);
  m.AddRevolute("big end", At("crank", {0.2, 0, 0}), At("rod"), y);
  m.AddPrismatic("guide", At("world"), At("slider"), {1, 0, 0});
  m.AddRevolute("counter", At("world"), At("shaft"), y);
  m.AddClosure("small end", ClosureType::kSpherical, At("rod", {0.5, 0, 0}), At("slider"));
  m.AddCoupling("gear", {{"main", 0, 2}, {"counter", 0, 1}});
  m.AddMotion("drive", {"main"}, [](double t) { return std::array<double, 3>{0.5 + 3 * t, 3, 0}; });
  const Mechanism mechanism = m.Make();
  const double reach = 0.2 * std::cos(0.5);
  const double height = 0.2 * std::sin(0.5);
  EXPECT_NEAR(std::abs(mechanism.start[mechanism.GetJoint("guide").q] - reach),
              std::sqrt(0.25 - height * height), 1e-10);
  const int nq = mechanism.system.model.positions;
  EXPECT_NEAR(mechanism.start[nq + mechanism.GetJoint("counter").v], -6, 1e-9);
}

}  // namespace
}  // namespace kingpin::joints
