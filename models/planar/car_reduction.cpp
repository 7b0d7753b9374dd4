#include "models/planar/car_reduction.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/io/error.h"
#include "models/parameters/car_mass.h"
#include "models/parameters/front_geometry.h"
#include "models/planar/assist_stability.h"
#include "models/planar/front_compliance.h"

namespace kingpin::planar {

using parameters::Car;
using parameters::DerivedQuantities;
using parameters::FrontGeometry;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

// Collects what is derived; does nothing when nobody asked.
class Recorder {
 public:
  explicit Recorder(DerivedQuantities* record) : record_(record) {}

  bool wanted() const { return record_ != nullptr; }

  double operator()(std::string name, double value, std::string unit, std::string formula,
                    std::string source) const {
    if (record_ != nullptr) {
      record_->push_back(
          {std::move(name), value, std::move(unit), std::move(formula), std::move(source)});
    }
    return value;
  }

 private:
  DerivedQuantities* record_;
};

void CheckOptions(const CarModeOptions& options) {
  const auto fail = [](const char* key, std::string found, const char* expected) {
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = key,
                          .found = std::move(found),
                          .expected = expected,
                          .suggestion = {}});
  };
  if (options.longitudinal_nodes < 3 || options.longitudinal_nodes > kMaxCurveNodes ||
      options.longitudinal_nodes % 2 == 0) {
    fail("longitudinal_nodes", fmt::format("{}", options.longitudinal_nodes),
         "an odd number from 3 to 15, as F_N is odd and zero has a node");
  }
  if (!(options.speed > 0.0)) fail("speed", fmt::format("{} m/s", options.speed), "above 0 m/s");
  if (!(options.longitudinal_range > 0.0)) {
    fail("longitudinal_range", fmt::format("{} N", options.longitudinal_range), "above 0 N");
  }
}

double InterpolateLinearly(const parameters::Table& table, double x) {
  if (x <= table.x.front()) return table.y.front();
  for (std::size_t i = 1; i < table.x.size(); ++i) {
    if (x <= table.x[i]) {
      const double share = (x - table.x[i - 1]) / (table.x[i] - table.x[i - 1]);
      return table.y[i - 1] + share * (table.y[i] - table.y[i - 1]);
    }
  }
  return table.y.back();
}

// Nodes at the table's rows times `scale`, then three at the limit, a last table interval apart:
// the monotone cubic is flat from the first of them on.
Curve<double> MakeAssistCurve(const parameters::Table& table, double scale, double limit,
                              const char* key) {
  constexpr int kLimitNodes = 3;
  const int count = static_cast<int>(table.x.size()) + kLimitNodes;
  if (count > kMaxCurveNodes) {
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = key,
                          .found = fmt::format("{} rows", table.x.size()),
                          .expected = fmt::format("at most {} rows", kMaxCurveNodes - kLimitNodes),
                          .suggestion = "leave out rows where the curve is straight"});
  }
  Curve<double> curve;
  curve.kind = CurveKind::kMonotone;
  curve.count = count;
  for (std::size_t i = 0; i < table.x.size(); ++i) {
    curve.x[i] = table.x[i];
    curve.f[i] = scale * table.y[i];
  }
  const std::size_t last = table.x.size() - 1;
  const double step = table.x[last] - table.x[last - 1];
  for (int k = 1; k <= kLimitNodes; ++k) {
    curve.x[last + static_cast<std::size_t>(k)] = table.x[last] + k * step;
    curve.f[last + static_cast<std::size_t>(k)] = scale * limit;
  }
  return curve;
}

double Series(double a, double b) { return a * b / (a + b); }

struct Builder {
  const Car& car;
  const CarModeOptions& options;
  const Recorder record;
  const FrontGeometry geometry = parameters::CalcFrontGeometry(car);
  const parameters::MassProperties carrier = parameters::CalcFrontCarrier(car);
  Parameters<double> p{};

  void BuildCarrier();
  void BuildRoadForce();
  void BuildTieRod();
  void BuildSupports();
  void BuildAligning();
  void BuildColumn();
  void BuildRack();
  void BuildAssistance();
};

void Builder::BuildCarrier() {
  p.carrier_mass =
      record("carrier_mass", carrier.mass, "kg", "knuckle + hub + belt + rim", "sum of parts");
  record("centre_of_mass.x", carrier.centre_of_mass.x(), "m", "sum(m r)/sum(m)", "sum of parts");
  p.half_track = record("centre_of_mass.y", carrier.centre_of_mass.y(), "m", "sum(m r)/sum(m)",
                        "sum of parts; B of the planar model");
  record("centre_of_mass.z", carrier.centre_of_mass.z(), "m", "sum(m r)/sum(m)", "sum of parts");
  record("kingpin_inclination", geometry.inclination / kDegree, "deg",
         "atan((y_ball - y_top)/(z_top - z_ball))", "geometry");
  record("caster", geometry.caster / kDegree, "deg", "atan((x_ball - x_top)/(z_top - z_ball))",
         "geometry; ISO 8855");
  record("steering_axis.x", geometry.axis_at_hub.x(), "m",
         "line ball joint - top mount at hub height", "geometry");
  record("steering_axis.y", geometry.axis_at_hub.y(), "m",
         "line ball joint - top mount at hub height", "geometry");
  const double vertical = record("yaw_inertia.vertical", carrier.inertia(2, 2), "kg m^2",
                                 "sum(Izz + m d^2) about the centre of mass", "Huygens-Steiner");
  const double about_axis = record("steering_axis_inertia", geometry.carrier_axis_inertia, "kg m^2",
                                   "e.(I e) + m |e x (c - K)|^2", "Huygens-Steiner");
  const Eigen::Vector2d arm = (carrier.centre_of_mass - geometry.axis_at_hub).head<2>();
  const double equivalent =
      record("yaw_inertia.steering_axis",
             about_axis / std::pow(geometry.axis.z(), 2) - carrier.mass * arm.squaredNorm(),
             "kg m^2", "I_e/e_z^2 - m |c - K|^2 (plane)",
             "same kinetic energy for yaw psi = theta e_z about K; goes with moments M_e/e_z");
  p.carrier_yaw_inertia =
      options.yaw_inertia == CarModeOptions::YawInertia::kVertical ? vertical : equivalent;
  p.design_origin_x = record("design_origin.x", -arm.x(), "m", "K - centre of mass", "geometry");
  p.design_origin_y = record("design_origin.y", -arm.y(), "m", "K - centre of mass", "geometry");
}

void Builder::BuildRoadForce() {
  const double ez = geometry.axis.z();
  // The planar moment about K of (−F, −ρF) at (x_F, y_F) is M_e/e_z for the spatial force.
  const double centre = record("lever.wheel_centre", -geometry.moment_fx_centre / ez, "m",
                               "-M_e/(F_x e_z), force at the wheel centre",
                               "vehicle data 3.8: planar moment about K is M_e/e_z");
  const double patch =
      record("lever.contact_patch", -geometry.moment_fx_patch / ez, "m",
             "-M_e/(F_x e_z), force at the contact patch", "as above; the scrub radius");
  const double trail =
      record("lever.lateral", geometry.moment_fy_patch / ez, "m",
             "M_e/(F_y e_z), force at the contact patch", "as above; minus the caster trail");
  const bool at_centre = options.road_force_at == CarModeOptions::RoadForceAt::kWheelCentre;
  p.force_x = at_centre ? car.front.hardpoints.wheel_centre.x() - carrier.centre_of_mass.x()
                        : p.design_origin_x + trail;
  p.force_y = p.design_origin_y + (at_centre ? centre : patch);
  record("force_point.x", p.force_x, "m", "from the centre of mass", "road_force_at");
  record("force_point.y", p.force_y, "m", "from the centre of mass", "road_force_at");
  p.lateral_share = options.lateral_share;
}

void Builder::BuildTieRod() {
  const parameters::FrontHardpoints& points = car.front.hardpoints;
  const Eigen::Vector3d& k = geometry.axis_at_hub;
  p.rack_half_length =
      record("r_L", points.tie_rod_inner.y(), "m", "y of the inner joint", "hardpoint");
  p.rack_position =
      record("r_X", points.tie_rod_inner.x() - k.x(), "m", "inner joint - K", "hardpoints");
  p.outer_joint_x =
      record("x_tr", points.tie_rod_outer.x() - k.x(), "m", "outer joint - K", "hardpoints");
  p.outer_joint_y =
      record("y_tr", points.tie_rod_outer.y() - k.y(), "m", "outer joint - K", "hardpoints");
  const Eigen::Vector3d& n = geometry.tie_rod;
  record("tie_rod.angle", std::atan2(n.y(), n.x()) / kDegree, "deg", "atan2(n_y, n_x)",
         "gamma of the paper");
  record("tie_rod.length", geometry.tie_rod_length, "m", "|outer - inner|", "hardpoints");
  record("tie_rod.lever", geometry.tie_rod_lever, "m", "|e.((outer - K) x n)|", "geometry");
  const parameters::TieRod& rod = car.front.tie_rod;
  const double rigidity =
      record("tie_rod.rigidity", rod.elastic_modulus * kPi * std::pow(rod.diameter, 2) / 4.0, "N",
             "E pi d^2/4", "strength of materials");
  const double bar = record("tie_rod.bar_stiffness", rigidity / geometry.tie_rod_length, "N/m",
                            "E A/l", "strength of materials; the paper's c_R");
  const double effective =
      record("tie_rod.stiffness", CalcTieRodStiffness(car, options.dynamic_rubber), "N/m",
             "1/(1/c_chain + n_y^2/c_mount)", "springs in series; the mounts give way along y");
  // In the plane the elongation n·u loses the factor |n_xy|; a stiffness c n nᵀ becomes c |n_xy|².
  const double planar_share = n.head<2>().squaredNorm();
  const double planar_length = geometry.tie_rod_length * std::sqrt(planar_share);
  p.rod_rigidity = bar * planar_share * planar_length;
  p.rod_compliance =
      record("tie_rod.compliance", 1.0 / (effective * planar_share) - 1.0 / (bar * planar_share),
             "m/N", "1/c - l/(E A), both projected on the plane", "ball joints and rack mounts");
  if (!(p.rod_compliance >= 0.0)) {
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = "front_suspension.tie_rod.chain_stiffness",
                          .found = fmt::format("{:.4g} N/m", rod.chain_stiffness),
                          .expected = fmt::format("at most the bar's own E A/l = {:.4g} N/m", bar),
                          .suggestion = "the chain is the bar in series with its ball joints"});
  }
  p.rod_free_play = options.free_play.value_or(car.steering.rack.free_play);
  p.two_way = true;
}

void Builder::BuildSupports() {
  FrontComplianceOptions compliance;
  compliance.dynamic_rubber = options.dynamic_rubber;
  const FrontCompliance front(car.front, compliance);
  const Eigen::Vector3d& k = geometry.axis_at_hub;
  const Eigen::Matrix3d at_k = front.CalcCondensed(k, false);
  const Eigen::Matrix2d plane = at_k.topLeftCorner<2, 2>();
  const char* source = "linear condensation of the front suspension, rod out, height free";
  record("support.k_xx", plane(0, 0), "N/m", "condensed at K", source);
  record("support.k_xy", plane(0, 1), "N/m", "condensed at K", source);
  record("support.k_yy", plane(1, 1), "N/m", "condensed at K", source);
  // K lies on the axis about which the carrier turns freely: its row and column of yaw are zero.
  record("support.k_psi", at_k(2, 2), "N m/rad", "condensed at K",
         "zero but for rounding: the condensed stiffness has rank two");
  const double c_n = record("c_N", plane(0, 0) - plane(0, 1) * plane(0, 1) / plane(1, 1), "N/m",
                            "k_xx - k_xy^2/k_yy", "recession of K under F_x alone");
  const bool condensed = options.support_axes == CarModeOptions::SupportAxes::kCondensed;
  p.lateral_angle = condensed ? std::atan2(plane(1, 1), plane(0, 1)) : 0.5 * kPi;
  record("beta", p.lateral_angle / kDegree, "deg", condensed ? "atan2(k_yy, k_xy)" : "90 deg",
         condensed ? "c_L d_L d_L' + c_N d_N d_N' equals the condensed stiffness"
                   : "lateral by definition");
  p.lateral_stiffness = record("c_L", plane(1, 1) / std::pow(std::sin(p.lateral_angle), 2), "N/m",
                               "k_yy/sin^2(beta)", source);
  p.longitudinal_angle = 0.0;
  p.lateral_x = p.longitudinal_x = p.design_origin_x;
  p.lateral_y = p.longitudinal_y = p.design_origin_y;

  // Odd nodes, evenly spaced in displacement.
  const int half = options.longitudinal_nodes / 2;
  const Eigen::Vector3d reach =
      front.CalcPointDisplacement(front.SolveEquilibrium(front.CalcLoad(
                                      k, options.longitudinal_range * Eigen::Vector3d::UnitX())),
                                  k);
  record("F_N.range", reach.x(), "m",
         fmt::format("recession of K at {:g} N", options.longitudinal_range),
         "quasi-static equilibrium with the bushings' laws");
  p.longitudinal_force.kind = CurveKind::kMonotone;
  p.longitudinal_force.count = options.longitudinal_nodes;
  for (int i = -half; i <= half; ++i) {
    const int index = i + half;
    const auto node = static_cast<std::size_t>(index);
    const double displacement = reach.x() * i / half;
    p.longitudinal_force.x[node] = displacement;
    p.longitudinal_force.f[node] = i == 0 ? 0.0 : front.SolveForce(k, displacement);
    if (i > 0) {
      record(fmt::format("F_N.node_{}", i), p.longitudinal_force.f[node], "N",
             fmt::format("F_N at {:.3f} mm", displacement * 1e3),
             "quasi-static equilibrium with the bushings' laws; odd");
    }
  }
  p.longitudinal_damping =
      record("b_N", front.CalcDamping(k), "N s/m", "sum(b (j q)^2), q the shape under F_x at K",
             "b = (loss factor) k/(2 pi f) of each bushing");
  record("zeta_N", p.longitudinal_damping / (2.0 * std::sqrt(c_n * p.carrier_mass)), "-",
         "b_N/(2 sqrt(c_N m_s))", "for judgement only");
  p.damping_time =
      record("eta", CalcBushingDamping(car.front.arm_front.y) / car.front.arm_front.y.stiffness,
             "s", "(loss factor)/(2 pi f) of the arm's front bushing", "P = eta K of the paper");
}

void Builder::BuildAligning() {
  const parameters::Tyres& tyres = car.tyres;
  const double full =
      record("aligning.quasi_static",
             tyres.cornering_stiffness * (tyres.pneumatic_trail + geometry.caster_trail), "N m/rad",
             "C_alpha (pneumatic trail + caster trail)", "linear tyre");
  const double lag = record("aligning.lag", tyres.relaxation_length / options.speed, "s", "sigma/V",
                            "first-order tyre relaxation");
  const double w = 2.0 * kPi * options.aligning_frequency;
  const double constant = record(
      "aligning.constant", full / std::sqrt(1.0 + std::pow(w * lag, 2)), "N m/rad",
      fmt::format("quasi-static/sqrt(1 + (omega lag)^2) at {:g} Hz", options.aligning_frequency),
      "magnitude of the lagged torque");
  switch (options.aligning) {
    case CarModeOptions::Aligning::kNone:
      break;
    case CarModeOptions::Aligning::kConstant:
      p.aligning_stiffness = constant;
      break;
    case CarModeOptions::Aligning::kLagged:
      p.aligning_stiffness = full;
      p.aligning_lag = lag;
      break;
  }
}

void Builder::BuildColumn() {
  const parameters::Column& column = car.steering.column;
  const bool electric = options.assistance == CarModeOptions::Assistance::kElectric;
  const double bar =
      record("column.torsion_bar",
             electric ? car.steering.electric.torsion_bar_stiffness : column.torsion_bar_stiffness,
             "N m/rad", electric ? "of the electric assistance" : "of the column", "datum");
  const double shafts = record(
      "column.shafts",
      Series(CalcShaftStiffness(column.upper_shaft), CalcShaftStiffness(column.intermediate_shaft)),
      "N m/rad", "G pi d^4/(32 l), both in series", "strength of materials");
  p.column_stiffness =
      record("c_k", Series(bar, shafts), "N m/rad", "torsion bar and shafts in series", "series");
  p.gear_ratio = record("i_U", CalcGearRatio(car.steering.rack), "rad/m", "2 pi/(travel per turn)",
                        "rack and pinion");
  if (options.torsion_bar_stops) {
    p.stop_angle = record("column.stop_angle", column.stop_angle * bar / p.column_stiffness, "rad",
                          "(bar's stop) c_bar/c_k", "twist of the whole column at the bar's stop");
    // Of the whole column, as the schema says: with the bar blocked its shafts remain.
    p.stop_stiffness = column.stop_stiffness;
  }
  static const parameters::Hands kNobody{};
  const parameters::Hands& hands =
      options.hands == CarModeOptions::HandsOnRim::kLight  ? car.steering.light_hands
      : options.hands == CarModeOptions::HandsOnRim::kFirm ? car.steering.firm_hands
                                                           : kNobody;
  p.wheel_inertia = record("I_sw", car.steering.wheel.inertia + hands.inertia, "kg m^2",
                           "steering wheel + hands", "sum of parts");
  p.hands_damping = (options.column_damping ? column.damping : 0.0) + hands.damping;
  p.hands_stiffness = hands.stiffness;
  p.rim_radius = car.steering.wheel.rim_radius;
}

void Builder::BuildRack() {
  const parameters::Rack& rack = car.steering.rack;
  const bool electric = options.assistance == CarModeOptions::Assistance::kElectric;
  const double pinion = record("rack.pinion_mass", rack.pinion_inertia * std::pow(p.gear_ratio, 2),
                               "kg", "J_pinion i_U^2", "kinetic energy");
  const double motor = record("rack.motor_mass", CalcMotorMassAtRack(car.steering), "kg",
                              "J_motor (i_worm i_U)^2", "kinetic energy; electric only");
  const double opposite = record("rack.opposite_wheel_mass", CalcWheelMassAtRack(car), "kg",
                                 "I_e (n_y/lever)^2", "kinetic energy, linear kinematics");
  p.rack_mass = record(
      "m_R",
      rack.mass + pinion + (electric ? motor : 0.0) + (options.opposite_wheel ? opposite : 0.0),
      "kg", "rack + what is geared to it and switched on", "sum");
  p.rack_damping = options.rack_damping ? rack.damping : 0.0;
  const double motor_friction = electric ? car.steering.electric.motor_friction : 0.0;
  switch (options.friction) {
    case CarModeOptions::Friction::kNone:
      break;
    case CarModeOptions::Friction::kCoefficient:
      p.friction_law = FrictionLaw::kCoulomb;
      p.friction_coefficient = rack.friction_coefficient;
      p.friction_preload = rack.yoke_preload;
      p.friction_constant = motor_friction;
      break;
    case CarModeOptions::Friction::kConstant:
      p.friction_law = FrictionLaw::kCoulomb;
      p.friction_constant = rack.friction_force + motor_friction;
      break;
  }
  record("rack.breakaway", p.friction_coefficient * p.friction_preload + p.friction_constant, "N",
         "mu (preload) + constant limit + motor friction", "at rest, without side force");
}

void Builder::BuildAssistance() {
  using Assistance = CarModeOptions::Assistance;
  switch (options.assistance) {
    case Assistance::kNone:
      return;
    case Assistance::kHydraulic: {
      const parameters::HydraulicAssist& assist = car.steering.hydraulic;
      const double area = record("assist.piston_area", CalcPistonArea(assist), "m^2",
                                 "pi (D^2 - d^2)/4", "geometry; p_A of the paper");
      p.assist_force = MakeAssistCurve(assist.pressure, area, assist.pressure_limit,
                                       "steering.hydraulic.pressure");
      if (options.assist_lag && assist.lag > 0.0) {
        p.assist_lag = AssistLag::kFirstOrder;
        p.assist_time = assist.lag;
      }
      record("assist.pump_speed", assist.pump_flow / area, "m/s", "Q/p_A",
             "rack speed above which the pump would not follow; not modelled");
      break;
    }
    case Assistance::kElectric: {
      const parameters::ElectricAssist& assist = car.steering.electric;
      const double factor =
          record("assist.speed_factor", InterpolateLinearly(assist.speed_factor, options.speed),
                 "-", fmt::format("linear in speed, at {:.4g} m/s", options.speed), "datum");
      p.assist_force =
          MakeAssistCurve(assist.force, factor, assist.force.y.back(), "steering.electric.force");
      // e^{τs} (1 + 2ζ s/ω + s²/ω²) cut after s²: the delay joins the second-order lag, exact in
      // the inverse transfer function up to the second order.
      const double w = 2.0 * kPi * assist.loop_frequency;
      const double tau = assist.controller_delay;
      const double first = 2.0 * assist.loop_damping / w + tau;
      const double second = 1.0 / (w * w) + 2.0 * assist.loop_damping * tau / w + 0.5 * tau * tau;
      const double frequency = record("assist.loop_frequency", 1.0 / std::sqrt(second), "rad/s",
                                      "(1/w^2 + 2 zeta tau/w + tau^2/2)^(-1/2)",
                                      "torque loop and controller delay, inverse expanded to s^2");
      const double damping = record("assist.loop_damping", 0.5 * first * frequency, "-",
                                    "(2 zeta/w + tau) w'/2", "as above");
      if (options.assist_lag) {
        p.assist_lag = AssistLag::kSecondOrder;
        p.assist_frequency = frequency;
        p.assist_damping = damping;
      }
      break;
    }
  }
  const double slope = record("assist.steepest_slope", CalcSteepestChord(p.assist_force), "N/(N m)",
                              "largest chord between nodes", "assistance curve");
  record("assist.loop_stiffness", slope * p.column_stiffness * p.gear_ratio, "N/m",
         "max(dF_A/dM) c_k i_U", "rack stiffness the assistance mimics at its steepest");
  if (!record.wanted()) return;
  record("assist.stable_slope", CalcLargestStableSlope(p), "N/(N m)",
         "largest dF_A/dM at which no small motion grows",
         "eigenvalues at rest (assist_stability.h); infinite: none up to 1e6");
}

}  // namespace

double CalcShaftStiffness(const parameters::RoundShaft& shaft) {
  return shaft.shear_modulus * kPi * std::pow(shaft.diameter, 4) / (32.0 * shaft.length);
}

double CalcPistonArea(const parameters::HydraulicAssist& assist) {
  return 0.25 * kPi * (std::pow(assist.piston_bore, 2) - std::pow(assist.rod_diameter, 2));
}

double CalcGearRatio(const parameters::Rack& rack) { return 2.0 * kPi / rack.travel_per_turn; }

double CalcWheelMassAtRack(const Car& car) {
  const FrontGeometry g = parameters::CalcFrontGeometry(car);
  return g.carrier_axis_inertia * std::pow(g.tie_rod.y() / g.tie_rod_lever, 2);
}

double CalcMotorMassAtRack(const parameters::Steering& steering) {
  return steering.electric.motor_inertia *
         std::pow(steering.electric.worm_ratio * CalcGearRatio(steering.rack), 2);
}

double CalcTieRodStiffness(const Car& car, bool dynamic_rubber) {
  const double rubber = dynamic_rubber ? car.front.rubber_dynamic_factor : 1.0;
  const double ny = parameters::CalcFrontGeometry(car).tie_rod.y();
  return 1.0 / (1.0 / car.front.tie_rod.chain_stiffness +
                ny * ny / (rubber * car.steering.rack.housing_mounts.stiffness));
}

Parameters<double> MakePlanarParameters(const Car& car, const CarModeOptions& options,
                                        DerivedQuantities* record) {
  CheckOptions(options);
  Builder builder{car, options, Recorder(record)};
  builder.BuildCarrier();
  builder.BuildRoadForce();
  builder.BuildTieRod();
  builder.BuildSupports();
  builder.BuildAligning();
  builder.BuildColumn();
  builder.BuildRack();
  builder.BuildAssistance();
  return builder.p;
}

}  // namespace kingpin::planar
