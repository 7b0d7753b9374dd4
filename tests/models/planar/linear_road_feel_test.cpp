#include "models/planar/linear_road_feel.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/math/dual.h"
#include "models/planar/linear_frequency_response.h"
#include "models/planar/linear_model.h"
#include "tests/models/planar/paper_sets.h"
#include "tests/models/planar/planar_car.h"

namespace kingpin::planar {
namespace {

double CalcSlopeAtZero(const Curve<double>& curve) { return MakeSpline(curve).CalcSlope(0.0); }

std::vector<Parameters<double>> Variants() {
  std::vector<Parameters<double>> all;
  for (const auto& set : sets::AllSets()) all.push_back(set.parameters);
  all.push_back(PlanarCar());
  auto p = PlanarCar();
  p.aligning_stiffness = 2700.0;
  p.aligning_lag = 0.05;
  p.assist_lag = AssistLag::kFirstOrder;
  p.assist_time = 0.012;
  p.rack_damping = 600.0;
  all.push_back(p);
  p = PlanarCar();
  p.aligning_stiffness = 700.0;
  p.assist_lag = AssistLag::kSecondOrder;
  p.assist_frequency = 377.0;
  p.assist_damping = 0.7;
  p.rack_mass = 467.0;
  p.rack_damping = 3000.0;
  all.push_back(p);
  p = sets::SetA().parameters;
  p.two_way = false;
  all.push_back(p);
  return all;
}

TEST(RoadFeel, StaticGainIsLeverAndShare) {
  // M_z is taken by the rod at its lever about the crossing of the support lines; the rack shares
  // F_R sin γ between column and assistance.
  for (const auto& set : sets::AllSets()) {
    const auto& p = set.parameters;
    const auto entries = CalcLinearEntries(p);
    const auto rod = CalcRodAtRest(p);
    const double cb = std::cos(p.lateral_angle), sb = std::sin(p.lateral_angle);
    const double ca = std::cos(p.longitudinal_angle), sa = std::sin(p.longitudinal_angle);
    // Crossing of L and N: normals' offsets equal; p × n is constant along each line.
    const double ml = p.lateral_x * sb - p.lateral_y * cb;
    const double mn = p.longitudinal_x * sa - p.longitudinal_y * ca;
    const double det = sb * -ca - -cb * sa;
    const double kx = (ml * -ca - -cb * mn) / det;
    const double ky = (sb * mn - ml * sa) / det;
    const double lever = (rod.outer_x - kx) * rod.sine - (rod.outer_y - ky) * rod.cosine;
    const double assist = CalcSlopeAtZero(p.assist_force);
    const double expected = std::abs(rod.sine / (lever * (p.gear_ratio + assist)));
    const double gain =
        CalcHeldWheelGain(p, entries, CalcSlopeAtZero(p.longitudinal_force), assist, 0.0);
    EXPECT_NEAR(gain, expected, 1e-10 * expected) << set.name;
    EXPECT_EQ(CalcStaticRoadFeel(p), gain) << set.name;
  }
}

TEST(RoadFeel, GainAtEveryFrequencyIsTheStateSpaceResponse) {
  for (const auto& p : Variants()) {
    const auto entries = CalcLinearEntries(p);
    const LinearModel held = HoldSteeringWheel(MakeLinearModel(p));
    const std::vector<double> grid{0.3, 1.0, 3.0, 6.5, 10.0};
    const auto curve = CalcBodeCurve(CalcFrequencyResponse(held, grid), "kingpin.moment",
                                     "steering.column.torque");
    for (std::size_t k = 0; k < grid.size(); ++k) {
      EXPECT_NEAR(CalcHeldWheelGain(p, entries, CalcSlopeAtZero(p.longitudinal_force),
                                    CalcSlopeAtZero(p.assist_force), grid[k]),
                  curve.magnitude[k], 1e-9 * curve.magnitude[k]);
    }
  }
}

TEST(RoadFeel, MeanIsTheIntegralOfTheResponse) {
  for (const auto& p : Variants()) {
    const auto entries = CalcLinearEntries(p);
    const double cn = CalcSlopeAtZero(p.longitudinal_force);
    const double fa = CalcSlopeAtZero(p.assist_force);
    // Composite Simpson rule, 2000 intervals.
    double sum = 0.0;
    constexpr int kIntervals = 2000;
    for (int i = 0; i <= kIntervals; ++i) {
      const double weight = i == 0 || i == kIntervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      sum += weight * CalcHeldWheelGain(p, entries, cn, fa, 10.0 * i / kIntervals);
    }
    const double mean = sum / (3.0 * kIntervals);
    // An electric motor's mass puts a resonance inside the band, and the lag of its assistance
    // takes the damping away: the quadrature converges slowly there. Its nodes are part of the
    // definition.
    const double tolerance = p.rack_mass > 100.0 ? 2e-3 : 1e-9;
    EXPECT_NEAR(CalcRoadFeelGain(p), mean, tolerance * mean);
  }
}

TEST(RoadFeel, GradientWithRespectToTheDesignIsExact) {
  using Scalar = math::Dual<double, 1>;
  const auto base = sets::SetB().parameters;
  const auto with = [&](int variable, auto value) {
    using S = decltype(value);
    Parameters<S> p;
    const auto take = [](const Curve<double>& from, Curve<S>& to) {
      to.count = from.count;
      to.x = from.x;
      for (std::size_t i = 0; i < from.f.size(); ++i) to.f[i] = S(from.f[i]);
    };
    p.carrier_mass = base.carrier_mass;
    p.carrier_yaw_inertia = base.carrier_yaw_inertia;
    p.lateral_share = base.lateral_share;
    p.rack_half_length = base.rack_half_length;
    p.rack_position = base.rack_position;
    p.outer_joint_x = base.outer_joint_x;
    p.outer_joint_y = base.outer_joint_y;
    p.half_track = base.half_track;
    p.rod_rigidity = base.rod_rigidity;
    p.lateral_stiffness = base.lateral_stiffness;
    p.lateral_x = base.lateral_x;
    p.lateral_y = base.lateral_y;
    p.lateral_angle = base.lateral_angle;
    take(base.longitudinal_force, p.longitudinal_force);
    p.longitudinal_damping = base.longitudinal_damping;
    p.longitudinal_x = base.longitudinal_x;
    p.longitudinal_y = base.longitudinal_y;
    p.longitudinal_angle = base.longitudinal_angle;
    p.damping_time = base.damping_time;
    p.rack_mass = base.rack_mass;
    p.wheel_inertia = base.wheel_inertia;
    p.column_stiffness = base.column_stiffness;
    p.gear_ratio = base.gear_ratio;
    take(base.assist_force, p.assist_force);
    if (variable == 0) p.rack_half_length = value;
    if (variable == 1) p.rack_position = value;
    if (variable == 2) p.outer_joint_x = value;
    if (variable == 3) p.outer_joint_y = value;
    if (variable == 4) p.assist_force.f[1] = value;
    if (variable == 5) p.longitudinal_force.f[4] = value;
    return CalcRoadFeelGain(p);
  };
  const std::array<double, 6> start{base.rack_half_length,  base.rack_position,
                                    base.outer_joint_x,     base.outer_joint_y,
                                    base.assist_force.f[1], base.longitudinal_force.f[4]};
  for (int i = 0; i < 6; ++i) {
    const double x = start[static_cast<std::size_t>(i)];
    const double h = 1e-3 * std::abs(x);
    const Scalar exact = with(i, Scalar::MakeVariable(x, 0));
    const double difference =
        (8.0 * (with(i, x + h) - with(i, x - h)) - (with(i, x + 2 * h) - with(i, x - 2 * h))) /
        (12.0 * h);
    EXPECT_NEAR(exact.v, with(i, x), 1e-13 * exact.v);  // divisions are ordered differently
    EXPECT_NEAR(exact.d[0], difference, 1e-7 * std::abs(exact.v / x)) << i;
  }
}

// An electric motor weighs 465 kg at the rack; on the held column that swings within the band of
// the mean. The static gain does not know it.
TEST(RoadFeel, AHeavyRackResonatesInTheMeanAndNotInTheStaticGain) {
  auto p = PlanarCar();
  p.assist_force.count = 0;
  p.aligning_stiffness = 700.0;
  p.rack_damping = 600.0;
  const double mean = CalcRoadFeelGain(p), at_rest = CalcStaticRoadFeel(p);
  EXPECT_NEAR(mean, at_rest, 0.1 * at_rest);
  p.rack_mass += 465.0;
  EXPECT_EQ(CalcStaticRoadFeel(p), at_rest);
  EXPECT_GT(CalcRoadFeelGain(p), 1.2 * mean);
}

TEST(RoadFeel, AssistanceTakesFeelAway) {
  auto p = PlanarCar();
  const double with = CalcRoadFeelGain(p);
  for (auto& f : p.assist_force.f) f = 0.0;
  EXPECT_GT(CalcRoadFeelGain(p), with);
}

}  // namespace
}  // namespace kingpin::planar
