#include "models/planar/planar_forces.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/io/error.h"
#include "core/math/dual.h"
#include "models/planar/accelerations.h"
#include "models/planar/paper_set.h"
#include "models/planar/validate.h"

namespace kingpin::planar {
namespace {

PaperSet ReadSet(const char* name) {
  return ReadPaperSet(std::string(KINGPIN_SOURCE_DIR) + "/examples/paper/set_" + name + ".json");
}

Parameters<double> MakeEverything() {
  Parameters<double> p = ReadSet("A").parameters;
  p.rod_compliance = 1e-8;
  p.aligning_stiffness = 700;
  p.rack_damping = 35;
  p.hands_damping = 0.3;
  p.hands_stiffness = 12;
  p.stop_angle = 0.02;
  p.stop_stiffness = 900;
  p.rod_free_play = 1e-4;
  p.design_origin_x = 0.01;
  p.design_origin_y = -0.012;
  return p;
}

template <class S>
State<S> MakeRandomState(std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  const double q_scale[] = {5e-3, 2e-3, 0.05, 1e-3, 0.2};
  State<S> x{};
  for (int i = 0; i < kCoordinates; ++i) {
    x.q[i] = S(q_scale[i] * any(random));
    x.v[i] = S(100 * q_scale[i] * any(random));
  }
  return x;
}

TEST(PlanarForces, ElasticForcesAreTheGradientOfThePotential) {
  const Parameters<double> p = MakeEverything();
  Parameters<double> no_assist = p;
  no_assist.assist_force.count = 0;
  const Model<double> model = MakeModel(no_assist);
  using D = math::Dual<double, kCoordinates>;
  Parameters<D> dual_parameters;
  std::mt19937_64 random(7);
  for (int n = 0; n < 50; ++n) {
    State<double> x = MakeRandomState<double>(random);
    for (double& v : x.v) v = 0;
    const Dynamics<double> d = CalcForces(model, x, 0.0);
    for (int i = 0; i < kCoordinates; ++i) {
      const double h = i == 2 || i == 4 ? 1e-6 : 1e-7;
      State<double> up = x, down = x;
      up.q[i] += h;
      down.q[i] -= h;
      const double gradient =
          (CalcPotentialEnergy(model, up) - CalcPotentialEnergy(model, down)) / (2 * h);
      const double force = d.a[i] / model.constants.inverse_mass[i];
      // The potential is up to 1e3 J: rounding 1e-13/h = 1e-6 N; forces reach 1e4 N.
      EXPECT_NEAR(force, -gradient, 2e-6 * (1e3 + std::abs(force))) << "coordinate " << i;
    }
  }
}

TEST(PlanarForces, DampersNeverSupplyPower) {
  const Model<double> model = MakeModel(MakeEverything());
  std::mt19937_64 random(8);
  for (int n = 0; n < 200; ++n) {
    const State<double> x = MakeRandomState<double>(random);
    EXPECT_GE(CalcForces(model, x, 0.0).dissipated_power, 0);
  }
}

TEST(PlanarForces, PowersAddUpToTheRateOfEnergy) {
  const Model<double> model = MakeModel(MakeEverything());
  std::mt19937_64 random(9);
  for (int n = 0; n < 50; ++n) {
    const State<double> x = MakeRandomState<double>(random);
    const Dynamics<double> d = CalcForces(model, x, 2500.0);
    double kinetic_power = 0;
    for (int i = 0; i < kCoordinates; ++i) {
      kinetic_power += x.v[i] * d.a[i] / model.constants.inverse_mass[i];
    }
    State<double> up = x, down = x;
    const double h = 1e-7;
    for (int i = 0; i < kCoordinates; ++i) {
      up.q[i] += h * x.v[i];
      down.q[i] -= h * x.v[i];
    }
    const double potential_power =
        (CalcPotentialEnergy(model, up) - CalcPotentialEnergy(model, down)) / (2 * h);
    EXPECT_NEAR(kinetic_power + potential_power, d.supplied_power - d.dissipated_power,
                3e-6 * (std::abs(kinetic_power) + std::abs(potential_power) + d.dissipated_power));
  }
}

TEST(PlanarForces, MirroredCarMirrorsTheMotion) {
  // Reflection at the x axis: y, psi, rack and wheel angle change sign.
  const Parameters<double> p = MakeEverything();
  Parameters<double> m = p;
  m.force_y = -p.force_y;
  m.lateral_share = -p.lateral_share;
  m.design_origin_y = -p.design_origin_y;
  m.rack_half_length = -p.rack_half_length;
  m.half_track = -p.half_track;
  m.outer_joint_y = -p.outer_joint_y;
  m.lateral_y = -p.lateral_y;
  m.lateral_angle = -p.lateral_angle;
  m.longitudinal_y = -p.longitudinal_y;
  m.longitudinal_angle = -p.longitudinal_angle;
  const Model<double> left = MakeModel(p), right = MakeModel(m);
  std::mt19937_64 random(10);
  const double sign[] = {1, -1, -1, -1, -1};
  for (int n = 0; n < 50; ++n) {
    const State<double> x = MakeRandomState<double>(random);
    State<double> y = x;
    for (int i = 0; i < kCoordinates; ++i) {
      y.q[i] = sign[i] * x.q[i];
      y.v[i] = sign[i] * x.v[i];
    }
    double a[kCoordinates], b[kCoordinates];
    CalcAccelerations(left, x, 1800.0, a);
    CalcAccelerations(right, y, 1800.0, b);
    for (int i = 0; i < kCoordinates; ++i) {
      // The polynomial of the trigonometric functions is exactly odd or even; rounding of the
      // angles remains.
      EXPECT_NEAR(b[i], sign[i] * a[i], 1e-10 * (1 + std::abs(a[i])));
    }
  }
}

TEST(PlanarForces, OneWayRodIgnoresTheRackButPushesIt) {
  Parameters<double> p = ReadSet("A").parameters;
  p.two_way = false;
  const Model<double> model = MakeModel(p);
  State<double> x{};
  x.q[3] = 1e-3;
  EXPECT_EQ(CalcForces(model, x, 0.0).rod_force, 0);
  x.q[1] = 1e-3;
  const Dynamics<double> d = CalcForces(model, x, 0.0);
  EXPECT_GT(d.rod_force, 0);
  EXPECT_DOUBLE_EQ(d.rack_rod_force, d.rod_force * d.rod_direction_y);
}

TEST(PlanarForces, DualsGiveTheDerivativesInStateAndDesign) {
  const Parameters<double> p = MakeEverything();
  using D = math::Dual<double, 1>;
  const auto to_dual = [&]() {
    Parameters<D> d;
    static_assert(std::is_trivially_copyable_v<Parameters<D>>);
    d.carrier_mass = p.carrier_mass;
    d.carrier_yaw_inertia = p.carrier_yaw_inertia;
    d.force_x = p.force_x;
    d.force_y = p.force_y;
    d.lateral_share = p.lateral_share;
    d.rack_half_length = p.rack_half_length;
    d.rack_position = p.rack_position;
    d.outer_joint_x = p.outer_joint_x;
    d.outer_joint_y = p.outer_joint_y;
    d.half_track = p.half_track;
    d.rod_rigidity = p.rod_rigidity;
    d.lateral_stiffness = p.lateral_stiffness;
    d.lateral_x = p.lateral_x;
    d.lateral_y = p.lateral_y;
    d.lateral_angle = p.lateral_angle;
    d.longitudinal_damping = p.longitudinal_damping;
    d.longitudinal_x = p.longitudinal_x;
    d.longitudinal_y = p.longitudinal_y;
    d.longitudinal_angle = p.longitudinal_angle;
    d.damping_time = p.damping_time;
    d.rack_mass = p.rack_mass;
    d.wheel_inertia = p.wheel_inertia;
    d.column_stiffness = p.column_stiffness;
    d.gear_ratio = p.gear_ratio;
    d.rim_radius = p.rim_radius;
    d.longitudinal_force.count = p.longitudinal_force.count;
    d.longitudinal_force.x = p.longitudinal_force.x;
    d.assist_force.count = p.assist_force.count;
    d.assist_force.x = p.assist_force.x;
    for (size_t k = 0; k < 16; ++k) {
      d.longitudinal_force.f[k] = p.longitudinal_force.f[k];
      d.assist_force.f[k] = p.assist_force.f[k];
    }
    return d;
  };
  Parameters<double> plain = ReadSet("A").parameters;
  std::mt19937_64 random(11);
  const State<double> x = MakeRandomState<double>(random);
  using Member = D Parameters<D>::*;
  using Plain = double Parameters<double>::*;
  const std::pair<Member, Plain> members[] = {
      {&Parameters<D>::rack_half_length, &Parameters<double>::rack_half_length},
      {&Parameters<D>::rack_position, &Parameters<double>::rack_position},
      {&Parameters<D>::outer_joint_x, &Parameters<double>::outer_joint_x},
      {&Parameters<D>::outer_joint_y, &Parameters<double>::outer_joint_y}};
  for (const auto& [member, plain_member] : members) {
    Parameters<D> dual = to_dual();
    (dual.*member).d[0] = 1;
    const Model<D> model = MakeModel(dual);
    State<D> y{};
    for (int i = 0; i < kCoordinates; ++i) {
      y.q[i] = x.q[i];
      y.v[i] = x.v[i];
    }
    Dynamics<D> d;
    CalcDynamics(model.structure, model.constants, y, D(1500.0), D(0.0), d);
    const double h = 1e-6;
    Parameters<double> up = plain, down = plain;
    up.*plain_member += h;
    down.*plain_member -= h;
    double a[kCoordinates], b[kCoordinates];
    CalcAccelerations(MakeModel(up), x, 1500.0, a);
    CalcAccelerations(MakeModel(down), x, 1500.0, b);
    for (int i = 0; i < kCoordinates; ++i) {
      const double difference = (a[i] - b[i]) / (2 * h);
      EXPECT_NEAR(d.a[i].d[0], difference, 1e-5 * (1e3 + std::abs(difference)));
    }
  }
}

TEST(ValidateParameters, NamesWhatMakesNoModel) {
  const Parameters<double> good = MakeEverything();
  ValidateParameters(good);
  const auto message = [&](auto change) {
    Parameters<double> p = good;
    change(p);
    try {
      ValidateParameters(p);
    } catch (const io::InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(message([](auto& p) { p.rack_mass = 0; }),
              testing::AllOf(testing::HasSubstr("planar.rack_mass"),
                             testing::HasSubstr("mass matrix is singular")));
  EXPECT_THAT(message([](auto& p) { p.gear_ratio = NAN; }),
              testing::HasSubstr("planar.gear_ratio"));
  EXPECT_THAT(message([](auto& p) { p.damping_time = -1; }),
              testing::HasSubstr("planar.damping_time"));
  EXPECT_THAT(message([](auto& p) { p.longitudinal_force.x[3] = -1; }),
              testing::HasSubstr("planar.longitudinal_force.x[3]"));
  EXPECT_THAT(message([](auto& p) { p.rod_rigidity = INFINITY; }),
              testing::HasSubstr("planar.rod_rigidity"));
}

}  // namespace
}  // namespace kingpin::planar
