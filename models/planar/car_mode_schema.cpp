#include "models/planar/car_mode_schema.h"

#include <fmt/format.h>

#include "models/planar/parameters.h"

namespace kingpin::planar {

const io::Schema<CarModeOptions>& CarModeSchema() {
  static const io::Schema<CarModeOptions> schema = [] {
    using O = CarModeOptions;
    io::Schema<O> s("car_mode", "How the car is reduced to the planar model.");
    s.Quantity("speed", &O::speed, "m/s", "of the car: electric assistance, tyre relaxation")
        .Positive()
        .Max(150.0)
        .Default("35 km/h");
    s.Choice("assistance", &O::assistance,
             {{"none", O::Assistance::kNone, "no power assistance"},
              {"hydraulic", O::Assistance::kHydraulic, "piston on the rack, first-order lag"},
              {"electric", O::Assistance::kElectric,
               "motor on the pinion with its inertia, friction and torque loop"}},
             "power assistance")
        .Default("hydraulic");
    s.Boolean("assist_lag", &O::assist_lag,
              "the assistance follows torque with its lag, uncompensated; check stability")
        .Default(false);
    s.Choice("hands", &O::hands,
             {{"free", O::HandsOnRim::kFree, "nobody holds the wheel"},
              {"light", O::HandsOnRim::kLight, "a light grip"},
              {"firm", O::HandsOnRim::kFirm, "a firm grip"}},
             "driver's hands on the rim")
        .Default("free");
    s.Choice("aligning", &O::aligning,
             {{"none", O::Aligning::kNone, "no aligning torque: the wheel drifts off"},
              {"constant", O::Aligning::kConstant,
               "a stiffness, the magnitude of the lagged torque at aligning_frequency"},
              {"lagged", O::Aligning::kLagged,
               "cornering stiffness times trail behind the tyre's relaxation"}},
             "tyre's aligning torque")
        .Default("lagged");
    s.Quantity("aligning_frequency", &O::aligning_frequency, "Hz",
               "at which a constant aligning stiffness stands for the lagged torque")
        .Positive()
        .Max(1000.0)
        .Default("15 Hz")
        .OnlyIf("aligning", {"constant"});
    s.Choice("friction", &O::friction,
             {{"none", O::Friction::kNone, "a smooth rack"},
              {"coefficient", O::Friction::kCoefficient,
               "coefficient times yoke preload and side force, set-valued"},
              {"constant", O::Friction::kConstant, "a constant limit, set-valued"}},
             "dry friction of the rack")
        .Default("coefficient");
    s.Boolean("opposite_wheel", &O::opposite_wheel,
              "the other wheel's steering inertia, geared to the rack")
        .Default(true);
    s.Boolean("torsion_bar_stops", &O::torsion_bar_stops, "stops of the torsion bar").Default(true);
    s.Boolean("column_damping", &O::column_damping, "damping of the column's bearings")
        .Default(true);
    s.Boolean("rack_damping", &O::rack_damping, "viscous damping of the rack").Default(true);
    s.Quantity("free_play", &O::free_play, "m",
               "whole clearance at the tie rod's inner joint, in place of the car's")
        .NonNegative()
        .Max(0.01)
        .Optional();
    s.Choice(
         "road_force_at", &O::road_force_at,
         {{"wheel_centre", O::RoadForceAt::kWheelCentre, "a free-rolling wheel"},
          {"contact_patch", O::RoadForceAt::kContactPatch, "a wheel locked by an outboard brake"}},
         "where the longitudinal road force acts")
        .Default("wheel_centre");
    s.Quantity("lateral_share", &O::lateral_share, "1", "lateral over longitudinal road force")
        .Min(-2.0)
        .Max(2.0)
        .Default(0.0);
    s.Boolean("dynamic_rubber", &O::dynamic_rubber,
              "rubber at its stiffness between 10 and 100 Hz instead of the static one")
        .Default(false);
    s.Choice("support_axes", &O::support_axes,
             {{"condensed", O::SupportAxes::kCondensed,
               "the lateral support leans so that the condensed stiffness is met exactly"},
              {"orthogonal", O::SupportAxes::kOrthogonal,
               "along x and y; the coupling of both is dropped"}},
             "directions of the two supports at the steering axis")
        .Default("condensed");
    s.Choice("yaw_inertia", &O::yaw_inertia,
             {{"steering_axis", O::YawInertia::kSteeringAxis,
               "gives the carrier's inertia about the inclined steering axis"},
              {"vertical", O::YawInertia::kVertical,
               "about a vertical axis through the centre of mass"}},
             "yaw inertia of the carrier")
        .Default("steering_axis");
    s.Integer("longitudinal_nodes", &O::longitudinal_nodes,
              "nodes of the longitudinal support's spline, odd")
        .Min(3)
        .Max(kMaxCurveNodes)
        .Default(7);
    s.Quantity("longitudinal_range", &O::longitudinal_range, "N",
               "force at which the longitudinal support's spline ends, continued linearly")
        .Positive()
        .Max(1e6)
        .Default("8 kN");
    s.Check([](const O& options, io::Check& check) {
      if (options.longitudinal_nodes % 2 == 1) return;
      check.Fail("longitudinal_nodes", fmt::format("{}", options.longitudinal_nodes),
                 "an odd number", "the curve is odd and has a node at zero");
    });
    return s;
  }();
  return schema;
}

}  // namespace kingpin::planar
