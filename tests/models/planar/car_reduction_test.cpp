#include "models/planar/car_reduction.h"

#include <Eigen/Dense>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "core/io/schema.h"
#include "models/parameters/car_mass.h"
#include "models/parameters/front_geometry.h"
#include "models/planar/assist_stability.h"
#include "models/planar/car_mode_schema.h"
#include "models/planar/front_compliance.h"
#include "models/planar/planar_model.h"
#include "models/planar/simulate.h"
#include "models/planar/validate.h"
#include "tests/models/parameters/c_segment.h"

namespace kingpin::planar {
namespace {

using O = CarModeOptions;
using parameters::CSegment;
using parameters::DerivedQuantities;
using testing::HasSubstr;
using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

constexpr double kPi = 3.14159265358979323846;

double Find(const DerivedQuantities& list, const std::string& name) {
  for (const parameters::DerivedQuantity& quantity : list) {
    if (quantity.name == name) return quantity.value;
  }
  ADD_FAILURE() << "no quantity " << name;
  return 0.0;
}

double Evaluate(const Curve<double>& curve, double x) { return MakeSpline(curve)(x); }

// Printed digits of the data set's table of planar values, half a unit of the last one.
TEST(CarReduction, ValuesAreThoseOfTheDataSet) {
  DerivedQuantities record;
  const Parameters<double> p = MakePlanarParameters(CSegment(), O::PaperLike(), &record);
  EXPECT_NEAR(Find(record, "centre_of_mass.x"), -0.001, 0.0005);
  EXPECT_NEAR(Find(record, "centre_of_mass.y"), 0.707, 0.0005);
  EXPECT_NEAR(Find(record, "centre_of_mass.z"), 0.011, 0.0005);
  EXPECT_DOUBLE_EQ(p.carrier_mass, 35.0);
  // Printed 0.62 (paper and estimate); the parts give 0.588 about the vertical and 0.645 as what
  // moves about the inclined steering axis.
  EXPECT_NEAR(p.carrier_yaw_inertia, 0.588, 0.0005);
  EXPECT_NEAR(Find(record, "yaw_inertia.steering_axis"), 0.645, 0.0005);
  // K at (0.000, -0.012): printed without rounding up -0.0126.
  EXPECT_NEAR(p.design_origin_x, 0.000, 0.001);
  EXPECT_NEAR(p.design_origin_y, -0.012, 0.001);
  EXPECT_NEAR(p.force_x, 0.000, 0.0012);
  EXPECT_NEAR(p.force_y, 0.043, 0.0005);
  EXPECT_NEAR(Find(record, "lever.wheel_centre"), 0.0554, 0.00005);
  EXPECT_NEAR(Find(record, "lever.contact_patch"), -0.0186, 0.00005);
  // Tie rod: outer joint at (-127.5, -26.6) mm from K, the paper's start values nearby.
  EXPECT_NEAR(p.outer_joint_x, -0.1275, 0.00005);
  EXPECT_NEAR(p.outer_joint_y, -0.0266, 0.00005);
  EXPECT_NEAR(p.rack_position, -0.1635, 0.00005);
  EXPECT_DOUBLE_EQ(p.rack_half_length, 0.330);
  EXPECT_NEAR(Find(record, "tie_rod.angle"), 83.9, 0.05);
  EXPECT_NEAR(Find(record, "tie_rod.bar_stiffness"), 9.5e7, 0.05e7);
  EXPECT_NEAR(Find(record, "tie_rod.stiffness"), 5e6, 0.1e6);
  EXPECT_NEAR(p.lateral_stiffness, 4.0e6, 0.05e6);
  EXPECT_DOUBLE_EQ(p.lateral_angle, 0.5 * kPi);
  EXPECT_DOUBLE_EQ(p.longitudinal_angle, 0.0);
  EXPECT_NEAR(Find(record, "c_N"), 4.9e5, 0.05e5);
  EXPECT_NEAR(p.column_stiffness, 60.0, 0.05);
  EXPECT_NEAR(p.gear_ratio, 125.66, 0.005);
  EXPECT_NEAR(p.damping_time, 1.3e-3, 0.05e-3);
  EXPECT_DOUBLE_EQ(p.wheel_inertia, 0.04);
  EXPECT_DOUBLE_EQ(p.rim_radius, 0.185);
  // Rack 2 kg [paper] and the pinion's 2e-5 kg m² at 125.66 rad/m.
  EXPECT_NEAR(p.rack_mass, 2.0 + 2e-5 * 125.66 * 125.66, 1e-4);
}

TEST(CarReduction, ModelPutsTheJointsWhereTheHardpointsAre) {
  const Parameters<double> p = MakePlanarParameters(CSegment(), {});
  const Model<double> model = MakeModel(p);
  const auto& points = CSegment().front.hardpoints;
  const Eigen::Vector3d rod = points.tie_rod_outer - points.tie_rod_inner;
  EXPECT_NEAR(model.constants.rod_x, rod.x(), 1e-15);
  EXPECT_NEAR(model.constants.rod_y, rod.y(), 1e-15);
  // The planar rod resists like the spatial one projected on the plane.
  const double share = rod.head<2>().squaredNorm() / rod.squaredNorm();
  EXPECT_NEAR(model.constants.rod_stiffness, CalcTieRodStiffness(CSegment(), false) * share, 1.0);
}

TEST(CarReduction, SupportsGiveTheCondensedStiffnessExactly) {
  const Parameters<double> p = MakePlanarParameters(CSegment(), {});
  const Eigen::Vector3d k = parameters::CalcFrontGeometry(CSegment()).axis_at_hub;
  const Eigen::Matrix3d condensed = FrontCompliance(CSegment().front, {}).CalcCondensed(k, false);
  const double c_n = condensed(0, 0) - condensed(0, 1) * condensed(0, 1) / condensed(1, 1);
  const Eigen::Vector2d l(std::cos(p.lateral_angle), std::sin(p.lateral_angle));
  Eigen::Matrix2d planar = p.lateral_stiffness * l * l.transpose();
  planar(0, 0) += c_n;
  EXPECT_LT((planar - condensed.topLeftCorner<2, 2>()).norm(), 1e-9 * condensed.norm());
}

TEST(CarReduction, LongitudinalSplineFollowsTheRecessionOfK) {
  O options;
  const Eigen::Vector3d k = parameters::CalcFrontGeometry(CSegment()).axis_at_hub;
  const FrontCompliance front(CSegment().front, {});
  for (const int nodes : {7, 15}) {
    options.longitudinal_nodes = nodes;
    const Parameters<double> p = MakePlanarParameters(CSegment(), options);
    const Curve<double>& curve = p.longitudinal_force;
    ASSERT_EQ(curve.count, nodes);
    const double last = curve.x[static_cast<std::size_t>(nodes) - 1];
    EXPECT_NEAR(curve.f[static_cast<std::size_t>(nodes) - 1], 8000.0, 1e-5);
    double worst = 0.0;
    for (double x = 0.02 * last; x <= last; x += 0.02 * last) {
      EXPECT_NEAR(Evaluate(curve, -x), -Evaluate(curve, x), 1e-9) << "odd";
      worst = std::max(worst, std::abs(Evaluate(curve, x) - front.SolveForce(k, x)));
    }
    // The natural end condition has no curvature at 8 kN, where the bushings' curve bends most; the
    // error sits in the last interval and falls with its square: 3 % of the range, 0.6 %.
    EXPECT_LT(worst, nodes == 7 ? 260.0 : 50.0);
    const double slope = Evaluate(curve, 1e-8) / 1e-8;
    EXPECT_NEAR(slope, front.SolveForce(k, 1e-6) / 1e-6, nodes == 7 ? 0.05 * slope : 0.01 * slope);
  }
}

// Second route to the linear model: M and K written out by hand from d dᵀ, as in the notes.
Eigen::VectorXd Frequencies(double c_rod, double c_lateral, double c_longitudinal, double inertia,
                            double rack_mass, double k_y, const Eigen::Vector2d& rod_point) {
  const double gamma = 83.9 * kPi / 180.0;
  const double ratio = 125.66;
  Vector5 rod;
  rod << std::cos(gamma), std::sin(gamma),
      rod_point.x() * std::sin(gamma) - rod_point.y() * std::cos(gamma), -std::sin(gamma), 0.0;
  Vector5 lateral;
  lateral << 0.0, 1.0, 0.0, 0.0, 0.0;
  Vector5 longitudinal;
  longitudinal << 1.0, 0.0, -k_y, 0.0, 0.0;
  Vector5 column;
  column << 0.0, 0.0, 0.0, -ratio, 1.0;
  const Matrix5 stiffness =
      c_rod * rod * rod.transpose() + c_lateral * lateral * lateral.transpose() +
      c_longitudinal * longitudinal * longitudinal.transpose() + 60.0 * column * column.transpose();
  Matrix5 mass = Vector5(35.0, 35.0, inertia, rack_mass, 0.04).asDiagonal();
  const Vector5 squares =
      Eigen::GeneralizedSelfAdjointEigenSolver<Matrix5>(stiffness, mass).eigenvalues();
  return squares.cwiseMax(0.0).cwiseSqrt() / (2.0 * kPi);
}

TEST(CarReduction, EigenfrequenciesAreThoseOfTheDataSet) {
  // Inputs are known to two or three digits, hence 0.5 to 1 % in frequency.
  // The printed inputs: c_L 2.3e6, I_s 0.62, m_R 2 kg, K at -12 mm, R at (-128, -39) mm.
  const Eigen::VectorXd f = Frequencies(5e6, 2.3e6, 4.9e5, 0.62, 2.0, -0.012, {-0.128, -0.039});
  EXPECT_NEAR(f(0), 0.0, 1e-3);
  EXPECT_NEAR(f(1), 18.8, 0.1);
  EXPECT_NEAR(f(2), 19.3, 0.3);
  EXPECT_NEAR(f(3), 47.6, 0.5);
  EXPECT_NEAR(f(4), 284.0, 1.5);
  const Eigen::VectorXd bare =
      Frequencies(1.08e8, 2.3e6, 4.9e5, 0.62, 2.0, -0.012, {-0.128, -0.039});
  EXPECT_NEAR(bare(1), 18.9, 0.1);
  EXPECT_NEAR(bare(2), 20.1, 0.3);
  EXPECT_NEAR(bare(3), 48.7, 0.5);
  EXPECT_NEAR(bare(4), 1228.0, 6.0);
}

TEST(CarReduction, RackAndWheelMassesFollowFromKineticEnergy) {
  // Motor: 7e-5 kg m² behind worm 20.5, 0.0294 kg m² on the pinion, 465 kg at the rack.
  EXPECT_NEAR(CalcMotorMassAtRack(CSegment().steering), 465.0, 0.5);
  // Opposite wheel, second route: the carrier's twist for unit rack speed. With the height of the
  // wheel centre held it is a rotation about the steering axis, up to the arm's small motion.
  const parameters::FrontMotion motion = parameters::CalcRackMotion(CSegment());
  const parameters::MassProperties carrier = parameters::CalcFrontCarrier(CSegment());
  const Eigen::Vector3d velocity =
      motion.wheel_centre +
      motion.rotation.cross(carrier.centre_of_mass - CSegment().front.hardpoints.wheel_centre);
  const double mass = carrier.mass * velocity.squaredNorm() +
                      motion.rotation.dot(carrier.inertia * motion.rotation);
  EXPECT_NEAR(CalcWheelMassAtRack(CSegment()), mass, 0.01 * mass);
  // Printed "about 47 kg" from 0.65/0.118²: 0.65 kg m² is I_e/e_z², the yaw equivalent; about the
  // axis itself, where the lever of 118 mm holds, it is 0.611.
  EXPECT_NEAR(CalcWheelMassAtRack(CSegment()), 47.0, 4.0);
}

TEST(CarReduction, OptionsReachTheParameters) {
  O options;
  const Parameters<double> base = MakePlanarParameters(CSegment(), options);
  EXPECT_EQ(base.friction_law, FrictionLaw::kCoulomb);
  EXPECT_DOUBLE_EQ(base.friction_coefficient, 0.08);
  EXPECT_DOUBLE_EQ(base.friction_preload, 1200.0);
  EXPECT_DOUBLE_EQ(base.hands_damping, 0.05);
  EXPECT_GT(base.aligning_lag, 0.05);
  EXPECT_NEAR(base.stop_angle, 0.075 * 64.8 / base.column_stiffness, 1e-12);

  options.hands = O::HandsOnRim::kFirm;
  options.friction = O::Friction::kConstant;
  options.aligning = O::Aligning::kConstant;
  options.opposite_wheel = false;
  options.free_play = 2e-4;
  options.road_force_at = O::RoadForceAt::kContactPatch;
  options.assistance = O::Assistance::kElectric;
  const Parameters<double> p = MakePlanarParameters(CSegment(), options);
  EXPECT_DOUBLE_EQ(p.wheel_inertia, 0.12);
  EXPECT_DOUBLE_EQ(p.hands_stiffness, 30.0);
  EXPECT_DOUBLE_EQ(p.hands_damping, 1.05);
  EXPECT_DOUBLE_EQ(p.friction_constant, 250.0 + 120.0);
  EXPECT_DOUBLE_EQ(p.friction_coefficient, 0.0);
  // The constant stands within the 400 to 900 N m/rad that the data set estimates.
  EXPECT_GT(p.aligning_stiffness, 400.0);
  EXPECT_LT(p.aligning_stiffness, 900.0);
  EXPECT_DOUBLE_EQ(p.aligning_lag, 0.0);
  EXPECT_DOUBLE_EQ(p.rod_free_play, 2e-4);
  EXPECT_NEAR(p.rack_mass, 2.0 + 464.5 + 0.32, 0.1);
  EXPECT_NEAR(p.force_y - p.design_origin_y, -0.0186, 0.00005);
  // Torsion bar of 2.25 N m/deg in series with the shafts' 816.
  EXPECT_NEAR(p.column_stiffness, 1.0 / (1.0 / 128.9 + 1.0 / 815.8), 0.05);
  // Both lags off unless asked for.
  EXPECT_EQ(p.assist_lag, AssistLag::kNone);
  EXPECT_EQ(base.assist_lag, AssistLag::kNone);
}

TEST(CarReduction, HydraulicForceIsPressureTimesArea) {
  const Parameters<double> p = MakePlanarParameters(CSegment(), {});
  const double area = 0.25 * kPi * (0.044 * 0.044 - 0.025 * 0.025);
  EXPECT_NEAR(area, 1.03e-3, 0.005e-3);
  EXPECT_NEAR(Evaluate(p.assist_force, 4.0), 28e5 * area, 1e-9);
  // Beyond the table it stays at the pump's limit.
  for (const double torque : {7.0, 7.5, 8.5, 9.0, 12.0, 100.0}) {
    EXPECT_NEAR(Evaluate(p.assist_force, torque), 100e5 * area, 1e-9) << torque;
  }
}

TEST(CarReduction, AssistanceNeverFallsOrOvershootsAndIsFlatBeyondItsTable) {
  for (const auto assistance : {O::Assistance::kHydraulic, O::Assistance::kElectric}) {
    O options;
    options.assistance = assistance;
    const Curve<double> curve = MakePlanarParameters(CSegment(), options).assist_force;
    const auto spline = MakeSpline(curve);
    double last = 0.0;
    const double highest = curve.f[static_cast<std::size_t>(curve.count) - 1];
    for (int i = 0; i <= 20000; ++i) {
      const double torque = 1e-3 * i;
      const double force = spline(torque);
      // To rounding: sums of increments.
      EXPECT_GE(force, last - 1e-12 * highest) << torque;
      EXPECT_LE(force, highest * (1.0 + 1e-12)) << torque;
      EXPECT_GE(spline.CalcSlope(torque), 0.0) << torque;
      last = force;
    }
    EXPECT_EQ(spline.CalcSlope(20.0), 0.0);
  }
}

// Its table begins with a dead band: no push at all, in particular none the wrong way.
TEST(CarReduction, ElectricAssistanceRestsInItsDeadBand) {
  O options;
  options.assistance = O::Assistance::kElectric;
  const auto spline = MakeSpline(MakePlanarParameters(CSegment(), options).assist_force);
  for (double torque = 0.0; torque < 0.5; torque += 0.01) {
    EXPECT_EQ(spline(torque), 0.0) << torque;
    EXPECT_EQ(spline.CalcSlope(torque), 0.0) << torque;
  }
}

// 800 N m/rad are those of the whole column: its shafts (816 N m/rad) with a bar whose stop is
// metal. Were they the bar's alone, the stop would be no stiffer than the shafts behind it.
TEST(CarReduction, BeyondItsStopTheColumnIsNearlyItsShafts) {
  DerivedQuantities record;
  const Parameters<double> p = MakePlanarParameters(CSegment(), {}, &record);
  const double shafts = Find(record, "column.shafts");
  EXPECT_NEAR(shafts, 816.0, 0.5);
  EXPECT_DOUBLE_EQ(p.stop_stiffness, 800.0);
  EXPECT_LT(p.stop_stiffness, shafts);
  EXPECT_GT(1.0 / (1.0 / p.stop_stiffness - 1.0 / shafts), 3e4);
}

TEST(CarReduction, PaperLikeHasNoDampingOfTheRack) {
  EXPECT_DOUBLE_EQ(MakePlanarParameters(CSegment(), {}).rack_damping, 600.0);
  const Parameters<double> p = MakePlanarParameters(CSegment(), O::PaperLike());
  EXPECT_EQ(p.rack_damping, 0.0);
  EXPECT_EQ(p.hands_damping, 0.0);
}

TEST(CarReduction, ElectricForceFollowsTheSpeedFactor) {
  O options;
  options.assistance = O::Assistance::kElectric;
  EXPECT_NEAR(Evaluate(MakePlanarParameters(CSegment(), options).assist_force, 4.0), 3000.0, 1e-9);
  options.speed = 57.5 / 3.6;  // half way between 35 and 80 km/h: factor 0.8
  EXPECT_NEAR(Evaluate(MakePlanarParameters(CSegment(), options).assist_force, 4.0), 2400.0, 1e-9);
  options.speed = 300.0 / 3.6;  // held beyond the last row
  EXPECT_NEAR(Evaluate(MakePlanarParameters(CSegment(), options).assist_force, 4.0), 1200.0, 1e-9);
}

// The second-order lag that stands for torque loop and delay has their inverse up to s².
TEST(CarReduction, DelayJoinsTheTorqueLoop) {
  O options;
  options.assistance = O::Assistance::kElectric;
  options.assist_lag = true;
  const Parameters<double> p = MakePlanarParameters(CSegment(), options);
  EXPECT_EQ(p.assist_lag, AssistLag::kSecondOrder);
  using C = std::complex<double>;
  const double w = 2.0 * kPi * 60.0;
  for (const double f : {1.0, 2.0, 4.0}) {
    const C s(0.0, 2.0 * kPi * f);
    const C exact = std::exp(-0.002 * s) / (1.0 + 1.4 * s / w + s * s / (w * w));
    const C ours = 1.0 / (1.0 + 2.0 * p.assist_damping * s / p.assist_frequency +
                          s * s / std::pow(p.assist_frequency, 2));
    // The first neglected term is (2 ζ τ²/(2 ω) + τ/ω² + τ³/6) s³ = 2.3e-8 s³.
    EXPECT_LT(std::abs(ours / exact - 1.0), 2.5e-8 * std::pow(std::abs(s), 3)) << f;
  }
}

TEST(CarReduction, EveryCombinationOfOptionsMakesAModel) {
  for (const auto assistance :
       {O::Assistance::kNone, O::Assistance::kHydraulic, O::Assistance::kElectric}) {
    for (const auto aligning : {O::Aligning::kNone, O::Aligning::kConstant, O::Aligning::kLagged}) {
      for (const bool flag : {false, true}) {
        O options;
        options.assistance = assistance;
        options.aligning = aligning;
        options.assist_lag = flag;
        options.dynamic_rubber = flag;
        options.torsion_bar_stops = flag;
        options.lateral_share = flag ? 0.3 : 0.0;
        DerivedQuantities record;
        EXPECT_NO_THROW(ValidateParameters(MakePlanarParameters(CSegment(), options, &record)));
        for (const parameters::DerivedQuantity& quantity : record) {
          EXPECT_FALSE(std::isnan(quantity.value)) << quantity.name;
          EXPECT_FALSE(quantity.formula.empty()) << quantity.name;
          EXPECT_FALSE(quantity.source.empty()) << quantity.name;
        }
      }
    }
  }
}

TEST(CarReduction, DynamicRubberRaisesTheBounceFrequencies) {
  O options;
  DerivedQuantities soft;
  MakePlanarParameters(CSegment(), options, &soft);
  options.dynamic_rubber = true;
  DerivedQuantities stiff;
  MakePlanarParameters(CSegment(), options, &stiff);
  EXPECT_GT(Find(stiff, "c_N"), 1.2 * Find(soft, "c_N"));
  EXPECT_LE(Find(stiff, "c_N"), 1.3 * Find(soft, "c_N"));
  EXPECT_GT(Find(stiff, "tie_rod.stiffness"), Find(soft, "tie_rod.stiffness"));
}

// The data set's own runs: 3 kN for 20 ms at the wheel centre, hydraulic boost without lag, 250 N
// of friction, c_L 2.3e6 N/m, I_s 0.62 kg m², extra rack mass. Gamma_1 and Gamma_5 in mm/s².
TEST(CarReduction, KickOfTheReducedCarIsThatOfTheDataSet) {
  const double extra[] = {0.0, 47.0, 247.0, 497.0, 847.0};
  const double gamma_1[] = {24.9e3, 30.1e3, 31.7e3, 21.1e3, 15.7e3};
  const double gamma_5[] = {2638.0, 2914.0, 3097.0, 2024.0, 1712.0};
  O options = O::PaperLike();
  options.assistance = O::Assistance::kHydraulic;
  options.friction = O::Friction::kConstant;
  Pulse pulse;
  pulse.kind = PulseKind::kHalfSine;
  pulse.amplitude = 3000.0;
  pulse.start = 0.1;
  pulse.duration = 0.02;
  for (std::size_t i = 0; i < std::size(extra); ++i) {
    Parameters<double> p = MakePlanarParameters(CSegment(), options);
    p.rack_mass += extra[i];
    p.lateral_stiffness = 2.3e6;
    p.carrier_yaw_inertia = 0.62;
    const SimulationOptions simulation;
    const History history = Simulate(p, Excitation({pulse}), simulation);
    double low = 0.0;
    double high = 0.0;
    double energy = 0.0;
    for (const double a : history.rim_acceleration) {
      low = std::min(low, a);
      high = std::max(high, a);
      energy += a * a * simulation.sample_interval;
    }
    // The curve through the boost table, the recession curve and the damping of the data set's runs
    // are not printed: the level and the shape over rack mass are what must agree. Γ_1 is off by
    // 0.8, -0.1, -2.4, -5.8, -0.8 %, Γ_5 by 1.8, 6.8, -3.5, 10.5, 10.6 %. The rack's damping does
    // not explain it: with it 0.5, -1.8, -4.1, -7.2, -1.6 and 0.3, 4.6, -4.5, 8.7, 9.9 %.
    EXPECT_NEAR(1e3 * (high - low), gamma_1[i], 0.06 * gamma_1[i]) << extra[i];
    EXPECT_NEAR(1e3 * std::sqrt(energy), gamma_5[i], 0.11 * gamma_5[i]) << extra[i];
  }
}

TEST(CarReduction, WrongOptionsAreNamed) {
  O options;
  options.longitudinal_nodes = 8;
  try {
    MakePlanarParameters(CSegment(), options);
    FAIL();
  } catch (const io::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("longitudinal_nodes: found 8, expected an odd number"));
  }
}

TEST(CarMode, DefaultsOfTheSchemaAreThoseOfTheStruct) {
  const O read = io::ReadText(CarModeSchema(), "kind: car_mode\n", "text");
  DerivedQuantities from_schema;
  DerivedQuantities from_struct;
  MakePlanarParameters(CSegment(), read, &from_schema);
  MakePlanarParameters(CSegment(), {}, &from_struct);
  ASSERT_EQ(from_schema.size(), from_struct.size());
  for (std::size_t i = 0; i < from_schema.size(); ++i) {
    EXPECT_EQ(from_schema[i].value, from_struct[i].value) << from_schema[i].name;
  }
  EXPECT_EQ(read.friction, O{}.friction);
  EXPECT_EQ(read.assistance, O{}.assistance);
  EXPECT_EQ(read.opposite_wheel, O{}.opposite_wheel);
  EXPECT_EQ(read.free_play, O{}.free_play);
}

TEST(CarMode, ChoicesAndErrorsNameWhatIsPossible) {
  const O read = io::ReadText(
      CarModeSchema(),
      "kind: car_mode\nspeed: 50 km/h\nassistance: electric\nhands: light\naligning: constant\n"
      "aligning_frequency: 20 Hz\nfriction: none\nfree_play: 0.2 mm\n",
      "text");
  EXPECT_EQ(read.assistance, O::Assistance::kElectric);
  EXPECT_EQ(read.hands, O::HandsOnRim::kLight);
  EXPECT_DOUBLE_EQ(read.aligning_frequency, 20.0);
  EXPECT_DOUBLE_EQ(*read.free_play, 2e-4);
  try {
    io::ReadText(CarModeSchema(), "kind: car_mode\nassistance: hydrolic\n", "text");
    FAIL();
  } catch (const io::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("hydraulic"));
  }
}

}  // namespace
}  // namespace kingpin::planar
