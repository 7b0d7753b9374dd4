#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "models/parameters/car_schema.h"
#include "models/parameters/part_schemas.h"

namespace kingpin::parameters {

namespace {

constexpr double kColumnTolerance = 0.005;

// An odd assistance curve starts at the origin.
void CheckStartsAtOrigin(const Table& table, const char* key, io::Check& check) {
  if (table.x.front() == 0.0 && table.y.front() == 0.0) return;
  check.Fail(key, fmt::format("first row {:g}, {:g}", table.x.front(), table.y.front()),
             "first row 0, 0", "the curve is odd in the torque; list it for torques from 0 up");
}

const io::Schema<SteeringWheel>& SteeringWheelSchema() {
  static const io::Schema<SteeringWheel> schema = [] {
    using W = SteeringWheel;
    io::Schema<W> s("steering_wheel", "Steering wheel.");
    s.Quantity("mass", &W::mass, "kg", "mass").Positive().Max(50.0);
    s.Quantity("inertia", &W::inertia, "kg m^2", "about the column").Positive().Max(10.0);
    s.Quantity("rim_radius", &W::rim_radius, "m", "to the middle of the rim").Positive().Max(1.0);
    s.Point("centre", &W::centre, "m", "centre of the wheel").Min(-10.0).Max(10.0);
    return s;
  }();
  return schema;
}

const io::Schema<RoundShaft>& RoundShaftSchema() {
  static const io::Schema<RoundShaft> schema = [] {
    io::Schema<RoundShaft> s("round_shaft", "Solid round shaft in torsion.");
    s.Quantity("diameter", &RoundShaft::diameter, "m", "diameter").Positive().Max(0.5);
    s.Quantity("length", &RoundShaft::length, "m", "length").Positive().Max(5.0);
    s.Quantity("shear_modulus", &RoundShaft::shear_modulus, "Pa", "G").Positive().Max(1e13);
    return s;
  }();
  return schema;
}

const io::Schema<Column>& ColumnSchema() {
  static const io::Schema<Column> schema = [] {
    io::Schema<Column> s("column", "Torsion bar, upper column, intermediate shaft in series.");
    s.Quantity("torsion_bar_stiffness", &Column::torsion_bar_stiffness, "N m/rad",
               "of the torsion bar")
        .Positive()
        .Max(1e6);
    s.Quantity("stop_angle", &Column::stop_angle, "rad", "twist of the torsion bar at its stop")
        .Positive()
        .Max(1.0);
    s.Quantity("stop_stiffness", &Column::stop_stiffness, "N m/rad",
               "of the column beyond the stop")
        .Positive()
        .Max(1e6);
    s.Section("upper_shaft", &Column::upper_shaft, RoundShaftSchema(), "upper column");
    s.Section("intermediate_shaft", &Column::intermediate_shaft, RoundShaftSchema(),
              "intermediate shaft");
    s.Quantity("total_stiffness", &Column::total_stiffness, "N m/rad",
               "of the three in series; a check on the others")
        .Positive()
        .Max(1e6);
    s.Quantity("damping", &Column::damping, "N m s/rad", "of the bearings")
        .NonNegative()
        .Max(100.0);
    s.Quantity("friction", &Column::friction, "N m", "of the bearings").NonNegative().Max(100.0);
    s.Check([](const Column& column, io::Check& check) {
      double compliance = 1.0 / column.torsion_bar_stiffness;
      for (const RoundShaft* shaft : {&column.upper_shaft, &column.intermediate_shaft}) {
        compliance += 32.0 * shaft->length /
                      (shaft->shear_modulus * std::numbers::pi * std::pow(shaft->diameter, 4));
      }
      const double series = 1.0 / compliance;
      if (std::abs(series / column.total_stiffness - 1.0) > kColumnTolerance) {
        check.Fail("total_stiffness", fmt::format("{:g} N m/rad", column.total_stiffness),
                   fmt::format("{:.4g} N m/rad within 0.5 %, which torsion_bar_stiffness, "
                               "upper_shaft and intermediate_shaft in series have",
                               series),
                   "change one of the four");
      }
      if (column.stop_stiffness < column.total_stiffness) {
        check.Fail("stop_stiffness", fmt::format("{:g} N m/rad", column.stop_stiffness),
                   fmt::format("at least total_stiffness, {:g} N m/rad", column.total_stiffness),
                   "a stop stiffens the column");
      }
    });
    return s;
  }();
  return schema;
}

const io::Schema<Rack>& RackSchema() {
  static const io::Schema<Rack> schema = [] {
    io::Schema<Rack> s("rack", "Rack, pinion and housing.");
    s.Quantity("mass", &Rack::mass, "kg", "of the rack alone").Positive().Max(100.0);
    s.Quantity("travel", &Rack::travel, "m", "to either side").Positive().Max(1.0);
    s.Quantity("travel_per_turn", &Rack::travel_per_turn, "m", "rack travel per turn of the pinion")
        .Positive()
        .Max(1.0);
    s.Quantity("damping", &Rack::damping, "N s/m", "of the rack's travel").NonNegative().Max(1e6);
    s.Quantity("friction_coefficient", &Rack::friction_coefficient, "1",
               "on yoke preload and side force")
        .NonNegative()
        .Max(1.0);
    s.Quantity("yoke_preload", &Rack::yoke_preload, "N", "normal force on the rack at rest")
        .NonNegative()
        .Max(1e5);
    s.Quantity("friction_force", &Rack::friction_force, "N",
               "the alternative to the coefficient: a constant limit")
        .NonNegative()
        .Max(1e5);
    s.Section("housing_mounts", &Rack::housing_mounts, BushingAxisSchema(),
              "all mounts of the housing together, along y");
    s.Quantity("pinion_inertia", &Rack::pinion_inertia, "kg m^2", "about its axis")
        .NonNegative()
        .Max(1.0);
    s.Quantity("free_play", &Rack::free_play, "m", "whole clearance at the tie rod's inner joint")
        .NonNegative()
        .Max(0.01);
    return s;
  }();
  return schema;
}

const io::Schema<Hands>& HandsSchema() {
  static const io::Schema<Hands> schema = [] {
    io::Schema<Hands> s("hands", "Driver's hands on the rim, reduced to the column.");
    s.Quantity("inertia", &Hands::inertia, "kg m^2", "inertia").NonNegative().Max(10.0);
    s.Quantity("damping", &Hands::damping, "N m s/rad", "damping").NonNegative().Max(1000.0);
    s.Quantity("stiffness", &Hands::stiffness, "N m/rad", "stiffness").NonNegative().Max(1e5);
    return s;
  }();
  return schema;
}

const io::Schema<HydraulicAssist>& HydraulicAssistSchema() {
  static const io::Schema<HydraulicAssist> schema = [] {
    using H = HydraulicAssist;
    io::Schema<H> s("hydraulic_assist", "Piston on the rack, rotary valve on the torsion bar.");
    s.Quantity("piston_bore", &H::piston_bore, "m", "bore").Positive().Max(1.0);
    s.Quantity("rod_diameter", &H::rod_diameter, "m", "rack's diameter in the cylinder")
        .Positive()
        .Max(1.0);
    s.Curve("pressure", &H::pressure, {"torque", "N m"}, {"pressure", "Pa"},
            "boost curve, odd in the torsion bar's torque")
        .Increasing()
        .Monotone();
    s.Quantity("pressure_limit", &H::pressure_limit, "Pa", "of the pump").Positive().Max(1e9);
    s.Quantity("lag", &H::lag, "s", "time constant of the pressure, first order")
        .NonNegative()
        .Max(1.0);
    s.Quantity("pump_flow", &H::pump_flow, "m^3/s", "of the pump").Positive().Max(1.0);
    s.Check([](const H& assist, io::Check& check) {
      CheckStartsAtOrigin(assist.pressure, "pressure", check);
      if (assist.rod_diameter >= assist.piston_bore) {
        check.Fail("rod_diameter", fmt::format("{:g} m", assist.rod_diameter),
                   fmt::format("less than piston_bore, {:g} m", assist.piston_bore));
      }
      if (assist.pressure.y.back() > assist.pressure_limit) {
        check.Fail("pressure", fmt::format("up to {:g} Pa", assist.pressure.y.back()),
                   fmt::format("at most pressure_limit, {:g} Pa", assist.pressure_limit));
      }
    });
    return s;
  }();
  return schema;
}

const io::Schema<ElectricAssist>& ElectricAssistSchema() {
  static const io::Schema<ElectricAssist> schema = [] {
    using A = ElectricAssist;
    io::Schema<A> s("electric_assist", "Motor with a worm gear on the pinion.");
    s.Curve("force", &A::force, {"torque", "N m"}, {"force", "N"},
            "boost curve at the rack, odd in the torsion bar's torque; times speed_factor")
        .Increasing()
        .Monotone();
    s.Curve("speed_factor", &A::speed_factor, {"speed", "m/s"}, {"factor", "1"},
            "factor of the boost curve, linear in the car's speed, held outside")
        .Increasing();
    s.Quantity("motor_inertia", &A::motor_inertia, "kg m^2", "of the rotor").NonNegative().Max(1.0);
    s.Quantity("worm_ratio", &A::worm_ratio, "1", "turns of the motor per turn of the pinion")
        .Positive()
        .Max(1000.0);
    s.Quantity("motor_friction", &A::motor_friction, "N", "at the rack").NonNegative().Max(1e5);
    s.Quantity("loop_frequency", &A::loop_frequency, "Hz", "of the torque loop, second order")
        .Positive()
        .Max(1e5);
    s.Quantity("loop_damping", &A::loop_damping, "1", "damping ratio of the torque loop")
        .Positive()
        .Max(10.0);
    s.Quantity("controller_delay", &A::controller_delay, "s", "dead time").NonNegative().Max(0.1);
    s.Quantity("torsion_bar_stiffness", &A::torsion_bar_stiffness, "N m/rad",
               "in place of the column's")
        .Positive()
        .Max(1e6);
    s.Check([](const A& assist, io::Check& check) {
      CheckStartsAtOrigin(assist.force, "force", check);
      for (const double factor : assist.speed_factor.y) {
        if (factor >= 0.0) continue;
        check.Fail("speed_factor", fmt::format("a factor of {:g}", factor), "factors from 0 up");
      }
    });
    return s;
  }();
  return schema;
}

}  // namespace

const io::Schema<Steering>& SteeringSchema() {
  static const io::Schema<Steering> schema = [] {
    io::Schema<Steering> s("steering", "From the steering wheel to the rack.");
    s.Section("wheel", &Steering::wheel, SteeringWheelSchema(), "steering wheel");
    s.Section("column", &Steering::column, ColumnSchema(), "column");
    s.Section("rack", &Steering::rack, RackSchema(), "rack and pinion");
    s.Section("light_hands", &Steering::light_hands, HandsSchema(), "a light grip");
    s.Section("firm_hands", &Steering::firm_hands, HandsSchema(), "a firm grip");
    s.Section("hydraulic", &Steering::hydraulic, HydraulicAssistSchema(), "hydraulic assistance");
    s.Section("electric", &Steering::electric, ElectricAssistSchema(), "electric assistance");
    return s;
  }();
  return schema;
}

}  // namespace kingpin::parameters
