#include "models/parameters/car_derived.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/io/units.h"
#include "models/parameters/car_mass.h"
#include "models/parameters/front_geometry.h"

namespace kingpin::parameters {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

double CalcFrequency(double stiffness, double mass) {
  return std::sqrt(stiffness / mass) / (2.0 * kPi);
}

class List {
 public:
  void Add(const char* name, double value, const char* unit, const char* formula,
           const char* source) {
    quantities_.push_back({name, value, unit, formula, source});
  }
  DerivedQuantities Take() { return std::move(quantities_); }

 private:
  DerivedQuantities quantities_;
};

void AddMasses(const Car& car, List* list) {
  const MassProperties whole = CalcWholeCar(car);
  const StaticLoads loads = CalcStaticLoads(car);
  list->Add("total.mass", whole.mass, "kg", "sum of parts", "definition");
  list->Add("total.centre_behind_front_axle", loads.centre_behind, "m", "sum(m r)/sum(m)",
            "definition");
  list->Add("total.centre_above_ground", loads.centre_height, "m", "sum(m r)/sum(m)", "definition");
  list->Add("total.Ixx", whole.inertia(0, 0), "kg m^2", "sum(I + m d^2)", "Huygens-Steiner");
  list->Add("total.Iyy", whole.inertia(1, 1), "kg m^2", "sum(I + m d^2)", "Huygens-Steiner");
  list->Add("total.Izz", whole.inertia(2, 2), "kg m^2", "sum(I + m d^2)", "Huygens-Steiner");
  list->Add("total.dynamic_index",
            whole.inertia(2, 2) /
                (whole.mass * loads.centre_behind * (loads.wheelbase - loads.centre_behind)),
            "-", "Izz/(m a b)", "definition");
  list->Add("total.wheelbase", loads.wheelbase, "m", "x_front - x_rear", "definition");
  list->Add("front.track", 2.0 * car.front.hardpoints.wheel_centre.y(), "m", "2 y_wheel",
            "definition");
  list->Add("rear.track", 2.0 * car.rear.wheel_centre.y(), "m", "2 y_wheel", "definition");
  list->Add("front.wheel_load", loads.front_wheel, "N", "m g b/(2 L)", "statics");
  list->Add("rear.wheel_load", loads.rear_wheel, "N", "m g a/(2 L)", "statics");
  list->Add("front.unsprung_mass", loads.front_unsprung, "kg",
            "carrier + half of arm, tie rod and half shaft", "convention");
  list->Add("rear.unsprung_mass", loads.rear_unsprung, "kg", "wheel + hub + the beam's wheel share",
            "statics of the beam about its pivots");
}

void AddGeometry(const Car& car, List* list) {
  const FrontGeometry g = CalcFrontGeometry(car);
  const char* moment = "e.((r - r_ball) x F)/|F|, + to the left";
  list->Add("front.kingpin_inclination", g.inclination / kDegree, "deg",
            "atan((y_ball - y_top)/(z_top - z_ball))", "ISO 8855");
  list->Add("front.caster", g.caster / kDegree, "deg", "atan((x_ball - x_top)/(z_top - z_ball))",
            "ISO 8855");
  list->Add("front.steering_axis.x", g.axis_at_hub.x(), "m", "axis at hub height", "geometry");
  list->Add("front.steering_axis.y", g.axis_at_hub.y(), "m", "axis at hub height", "geometry");
  list->Add("front.hub_offset", g.hub_offset, "m", "y_wheel - y_axis at hub height", "geometry");
  list->Add("front.scrub_radius", g.scrub_radius, "m", "y_patch - y_axis at ground", "ISO 8855");
  list->Add("front.caster_trail", g.caster_trail, "m", "x_axis - x_patch at ground", "ISO 8855");
  list->Add("front.kingpin_moment.fx_wheel_centre", g.moment_fx_centre, "m", moment, "statics");
  list->Add("front.kingpin_moment.fx_patch", g.moment_fx_patch, "m", moment, "statics");
  list->Add("front.kingpin_moment.fy_patch", g.moment_fy_patch, "m", moment, "statics");
  list->Add("front.kingpin_moment.fz_patch", g.moment_fz_patch, "m", moment, "statics");
  list->Add("front.tie_rod_length", g.tie_rod_length, "m", "|outer - inner|", "geometry");
  list->Add("front.tie_rod_lever", g.tie_rod_lever, "m", "|e.((outer - ball) x n)|", "geometry");
  list->Add("front.rack_force_per_fx", g.rack_force_per_fx, "-", "|M_fx_wheel_centre| |n_y|/lever",
            "statics");
  list->Add("front.carrier_axis_inertia", g.carrier_axis_inertia, "kg m^2",
            "e.(I e) + m |e x (c - r_ball)|^2", "Huygens-Steiner");
}

void AddMotion(const Car& car, List* list) {
  const char* kinematics = "rigid links, ideal joints";
  const FrontMotion bump = CalcBumpMotion(car);
  const FrontMotion rack = CalcRackMotion(car);
  list->Add("front.bump_toe", bump.rotation.z() / kDegree, "deg/m",
            "rotation about z per wheel travel, + is toe-out on the left", kinematics);
  list->Add("front.bump_camber", -bump.rotation.x() / kDegree, "deg/m",
            "-rotation about x per wheel travel", kinematics);
  list->Add("front.strut_ratio", bump.strut, "-", "strut travel per wheel travel", kinematics);
  const double half_track = car.front.hardpoints.wheel_centre.y();
  // The patch moves at right angles to the line to the instant centre, which by symmetry meets the
  // centre plane at the roll centre.
  list->Add("front.roll_centre_height", half_track * bump.patch.y() / bump.patch.z(), "m",
            "y_patch v_y/v_z of the patch", kinematics);
  list->Add("steering.steer_per_rack", std::abs(rack.rotation.z()) / kDegree, "deg/m",
            "rotation about z per rack travel", kinematics);
  list->Add("steering.overall_ratio",
            2.0 * kPi / car.steering.rack.travel_per_turn / std::abs(rack.rotation.z()), "-",
            "i_U/(rotation about z per rack travel)", kinematics);
  const StaticLoads loads = CalcStaticLoads(car);
  const double front_sprung = loads.front_wheel - loads.front_unsprung * io::kStandardGravity;
  list->Add("front.spring_force", front_sprung / bump.strut, "N",
            "(wheel load - unsprung weight)/strut ratio", "virtual work");
  const double front_rate = car.front.strut.spring_rate * bump.strut * bump.strut;
  list->Add("front.wheel_rate", front_rate, "N/m", "c ratio^2", "virtual work");
  list->Add("front.body_frequency", CalcFrequency(front_rate, front_sprung / io::kStandardGravity),
            "Hz", "sqrt(c_wheel/m_sprung)/(2 pi), rigid tyre", "one mass");
  list->Add("front.wheel_hop",
            CalcFrequency(front_rate + car.tyres.vertical_stiffness, loads.front_unsprung), "Hz",
            "sqrt((c_wheel + c_tyre)/m_unsprung)/(2 pi)", "one mass");

  const RearSuspension& rear = car.rear;
  const double arm = rear.pivot.position.x() - rear.wheel_centre.x();
  const double spring_ratio = (rear.pivot.position.x() - rear.spring_lower.x()) / arm;
  list->Add("rear.spring_ratio", spring_ratio, "-", "spring's lever/arm length", "geometry");
  list->Add("rear.damper_ratio", (rear.pivot.position.x() - rear.damper_lower.x()) / arm, "-",
            "damper's lever/arm length", "geometry");
  const double rear_sprung = loads.rear_wheel - loads.rear_unsprung * io::kStandardGravity;
  list->Add("rear.spring_force", rear_sprung / spring_ratio, "N",
            "(wheel load - unsprung weight)/spring ratio", "virtual work");
  const double rear_rate = rear.spring_damper.spring_rate * spring_ratio * spring_ratio;
  list->Add("rear.wheel_rate", rear_rate, "N/m", "c ratio^2", "virtual work");
  list->Add("rear.body_frequency", CalcFrequency(rear_rate, rear_sprung / io::kStandardGravity),
            "Hz", "sqrt(c_wheel/m_sprung)/(2 pi), rigid tyre", "one mass");
  list->Add("rear.wheel_hop",
            CalcFrequency(rear_rate + car.tyres.vertical_stiffness, loads.rear_unsprung), "Hz",
            "sqrt((c_wheel + c_tyre)/m_unsprung)/(2 pi)", "one mass");

  const AntiRollBar& bar = car.front.anti_roll_bar;
  const double link_ratio =
      std::abs(bump.anti_roll_link.dot((bar.link_on_strut - bar.link_on_bar).normalized()));
  list->Add("front.anti_roll_ratio", link_ratio, "-", "link travel per wheel travel", kinematics);
  list->Add("front.anti_roll_stiffness",
            bar.torsion_stiffness * std::pow(2.0 * half_track * link_ratio / bar.arm_length, 2),
            "N m/rad", "c (track ratio/arm)^2", "virtual work");
  list->Add("front.spring_roll_stiffness", 2.0 * front_rate * half_track * half_track, "N m/rad",
            "c_wheel track^2/2", "virtual work");
  list->Add("rear.beam_roll_stiffness",
            rear.torsion_stiffness * std::pow(2.0 * rear.wheel_centre.y() / arm, 2), "N m/rad",
            "c (track/arm)^2", "virtual work");
  list->Add("rear.spring_roll_stiffness", 2.0 * rear_rate * std::pow(rear.wheel_centre.y(), 2),
            "N m/rad", "c_wheel track^2/2", "virtual work");
}

void AddDriveline(const Car& car, List* list) {
  const Driveline& d = car.driveline;
  const auto stiffness = [&d](const HalfShaft& shaft) {
    return d.shear_modulus * kPi * std::pow(shaft.diameter, 4) / (32.0 * shaft.length);
  };
  const char* torsion = "strength of materials";
  list->Add("driveline.left_stiffness", stiffness(d.left), "N m/rad", "G pi d^4/(32 l)", torsion);
  list->Add("driveline.right_stiffness", stiffness(d.right), "N m/rad", "G pi d^4/(32 l)", torsion);
  list->Add("driveline.engine_inertia_at_cage",
            d.engine_inertia * std::pow(d.final_drive_ratio * d.gear_ratio, 2), "kg m^2",
            "J (i_final i_gear)^2", "kinetic energy");
  list->Add("driveline.front_spin_inertia",
            car.tyres.belt.spin_inertia + car.tyres.rim.spin_inertia + car.front.hub.inertia.y(),
            "kg m^2", "belt + rim + hub", "sum of parts");
}

}  // namespace

DerivedQuantities CalcDerivedQuantities(const Car& car) {
  List list;
  AddMasses(car, &list);
  AddGeometry(car, &list);
  AddMotion(car, &list);
  AddDriveline(car, &list);
  return list.Take();
}

}  // namespace kingpin::parameters
