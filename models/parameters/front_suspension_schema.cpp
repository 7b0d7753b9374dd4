#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "models/parameters/car_schema.h"
#include "models/parameters/part_schemas.h"

namespace kingpin::parameters {

namespace {

constexpr double kFarthest = 10.0;

const io::Schema<FrontHardpoints>& FrontHardpointsSchema() {
  static const io::Schema<FrontHardpoints> schema = [] {
    using H = FrontHardpoints;
    io::Schema<H> s("front_hardpoints", "Left front corner in design position, car frame.");
    const auto point = [&s](const char* key, Eigen::Vector3d H::*member, const char* text) {
      s.Point(key, member, "m", text).Min(-kFarthest).Max(kFarthest);
    };
    point("lower_ball_joint", &H::lower_ball_joint, "ball joint of the lower control arm");
    point("strut_top", &H::strut_top, "centre of the top mount");
    point("strut_lower", &H::strut_lower, "on the knuckle; with strut_top the strut's axis");
    point("tie_rod_outer", &H::tie_rod_outer, "tie rod's joint on the knuckle");
    point("tie_rod_inner", &H::tie_rod_inner, "tie rod's joint on the rack");
    point("wheel_centre", &H::wheel_centre, "wheel centre");
    s.Quantity("spring_seat_lower", &H::spring_seat_lower, "m",
               "above strut_lower, along the strut")
        .Min(-1.0)
        .Max(2.0);
    s.Quantity("spring_seat_upper", &H::spring_seat_upper, "m",
               "above strut_lower, along the strut")
        .Min(-1.0)
        .Max(2.0);
    s.Check([](const H& h, io::Check& check) {
      for (const auto& [key, p] :
           {std::pair("lower_ball_joint", &h.lower_ball_joint),
            std::pair("strut_top", &h.strut_top), std::pair("strut_lower", &h.strut_lower),
            std::pair("tie_rod_outer", &h.tie_rod_outer),
            std::pair("tie_rod_inner", &h.tie_rod_inner),
            std::pair("wheel_centre", &h.wheel_centre)}) {
        if (p->y() > 0.0) continue;
        check.Fail(key, fmt::format("y = {:g} m", p->y()), "y above 0 m",
                   "list the left side; y is positive to the left");
      }
      if (h.strut_top.z() <= h.lower_ball_joint.z()) {
        check.Fail("strut_top", fmt::format("z = {:g} m", h.strut_top.z()),
                   fmt::format("above lower_ball_joint, z = {:g} m", h.lower_ball_joint.z()),
                   "z points upwards");
      }
      if (h.strut_top.z() <= h.strut_lower.z()) {
        check.Fail("strut_top", fmt::format("z = {:g} m", h.strut_top.z()),
                   fmt::format("above strut_lower, z = {:g} m", h.strut_lower.z()),
                   "z points upwards");
      }
      if (h.tie_rod_outer.y() <= h.tie_rod_inner.y()) {
        check.Fail("tie_rod_outer", fmt::format("y = {:g} m", h.tie_rod_outer.y()),
                   fmt::format("outboard of tie_rod_inner, y = {:g} m", h.tie_rod_inner.y()),
                   "are the two joints exchanged?");
      }
      if (h.spring_seat_upper <= h.spring_seat_lower) {
        check.Fail("spring_seat_upper", fmt::format("{:g} m", h.spring_seat_upper),
                   fmt::format("more than spring_seat_lower, {:g} m", h.spring_seat_lower));
      }
      // A rod whose line meets the steering axis cannot steer.
      const Eigen::Vector3d axis = (h.strut_top - h.lower_ball_joint).normalized();
      const Eigen::Vector3d rod = (h.tie_rod_outer - h.tie_rod_inner).normalized();
      const double lever = axis.dot((h.tie_rod_outer - h.lower_ball_joint).cross(rod));
      if (std::abs(lever) < 1e-3) {
        check.Fail("tie_rod_outer",
                   fmt::format("a lever of {:.3g} m about the steering axis", lever),
                   "at least 0.001 m", "the tie rod must not point at the steering axis");
      }
    });
    return s;
  }();
  return schema;
}

const io::Schema<StrutMount>& StrutMountSchema() {
  static const io::Schema<StrutMount> schema = [] {
    io::Schema<StrutMount> s("strut_mount", "Rubber mount on top of the strut.");
    s.Section("radial", &StrutMount::radial, BushingAxisSchema(), "across the strut");
    s.Section("axial", &StrutMount::axial, BushingAxisSchema(), "along the strut");
    s.Quantity("bearing_friction", &StrutMount::bearing_friction, "N m", "about the strut")
        .NonNegative()
        .Max(100.0);
    return s;
  }();
  return schema;
}

const io::Schema<AntiRollBar>& AntiRollBarSchema() {
  static const io::Schema<AntiRollBar> schema = [] {
    using B = AntiRollBar;
    io::Schema<B> s("anti_roll_bar", "Bar with an arm at each end, linked to the struts.");
    s.Quantity("torsion_stiffness", &B::torsion_stiffness, "N m/rad", "of the whole bar")
        .Positive()
        .Max(1e5);
    s.Quantity("arm_length", &B::arm_length, "m", "of each arm").Positive().Max(2.0);
    s.Point("link_on_strut", &B::link_on_strut, "m", "link's joint on the left strut")
        .Min(-kFarthest)
        .Max(kFarthest);
    s.Point("link_on_bar", &B::link_on_bar, "m", "link's joint on the bar's left end")
        .Min(-kFarthest)
        .Max(kFarthest);
    s.Point("bar_bushing", &B::bar_bushing, "m", "left bushing of the bar")
        .Min(-kFarthest)
        .Max(kFarthest);
    return s;
  }();
  return schema;
}

const io::Schema<TieRod>& TieRodSchema() {
  static const io::Schema<TieRod> schema = [] {
    io::Schema<TieRod> s("tie_rod", "Solid round tie rod with a ball joint at each end.");
    s.Quantity("mass", &TieRod::mass, "kg", "mass").Positive().Max(100.0);
    s.Quantity("diameter", &TieRod::diameter, "m", "of the bar").Positive().Max(0.5);
    s.Quantity("elastic_modulus", &TieRod::elastic_modulus, "Pa", "E").Positive().Max(1e13);
    s.Quantity("chain_stiffness", &TieRod::chain_stiffness, "N/m",
               "bar and both ball joints in series")
        .Positive()
        .Max(1e10);
    return s;
  }();
  return schema;
}

}  // namespace

const io::Schema<FrontSuspension>& FrontSuspensionSchema() {
  static const io::Schema<FrontSuspension> schema = [] {
    using F = FrontSuspension;
    io::Schema<F> s("front_suspension", "McPherson front axle, left side.");
    s.Section("hardpoints", &F::hardpoints, FrontHardpointsSchema(), "points in design position");
    s.Section("knuckle", &F::knuckle, RigidBodySchema(), "knuckle, strut tube, brake caliper");
    s.Section("hub", &F::hub, RigidBodySchema(), "hub, brake disc, outer joint; spins");
    s.Section("lower_control_arm", &F::lower_control_arm, RigidBodySchema(), "lower control arm");
    s.Section("tie_rod", &F::tie_rod, TieRodSchema(), "tie rod");
    s.Section("strut", &F::strut, SpringDamperSchema(), "coil, damper and stops, along the strut");
    s.Section("anti_roll_bar", &F::anti_roll_bar, AntiRollBarSchema(), "anti-roll bar");
    s.Section("arm_front", &F::arm_front, BushingSchema(), "front bushing of the arm");
    s.Section("arm_rear", &F::arm_rear, BushingSchema(), "rear bushing of the arm");
    s.Section("top_mount", &F::top_mount, StrutMountSchema(), "mount on top of the strut");
    s.Quantity("ball_joint_stiffness", &F::ball_joint_stiffness, "N/m",
               "lower ball joint, all directions")
        .Positive()
        .Max(1e12);
    s.Quantity("ball_joint_friction", &F::ball_joint_friction, "N m", "of each ball joint")
        .NonNegative()
        .Max(100.0);
    s.Quantity("rubber_dynamic_factor", &F::rubber_dynamic_factor, "1",
               "stiffness of rubber between 10 and 100 Hz over the static one")
        .Min(1.0)
        .Max(5.0);
    s.Check([](const F& front, io::Check& check) {
      const auto left = [&check](const char* key, double y) {
        if (y > 0.0) return;
        check.Fail(key, fmt::format("y = {:g} m", y), "y above 0 m",
                   "list the left side; y is positive to the left");
      };
      left("knuckle.centre_of_mass", front.knuckle.centre_of_mass.y());
      left("hub.centre_of_mass", front.hub.centre_of_mass.y());
      left("lower_control_arm.centre_of_mass", front.lower_control_arm.centre_of_mass.y());
      left("arm_front.position", front.arm_front.position.y());
      left("arm_rear.position", front.arm_rear.position.y());
      left("anti_roll_bar.link_on_strut", front.anti_roll_bar.link_on_strut.y());
      left("anti_roll_bar.link_on_bar", front.anti_roll_bar.link_on_bar.y());
      left("anti_roll_bar.bar_bushing", front.anti_roll_bar.bar_bushing.y());
      if ((front.arm_front.position - front.arm_rear.position).norm() < 1e-3) {
        check.Fail("arm_rear.position", "the place of arm_front",
                   "two bushings at least 1 mm apart", "the arm turns about the line through both");
      }
      const TieRod& rod = front.tie_rod;
      const double length =
          (front.hardpoints.tie_rod_outer - front.hardpoints.tie_rod_inner).norm();
      const double bar =
          rod.elastic_modulus * std::numbers::pi * rod.diameter * rod.diameter / (4.0 * length);
      if (rod.chain_stiffness > bar) {
        check.Fail("tie_rod.chain_stiffness", fmt::format("{:.4g} N/m", rod.chain_stiffness),
                   fmt::format("at most the bar's own E A/l = {:.4g} N/m", bar),
                   "the chain is the bar in series with its ball joints");
      }
    });
    return s;
  }();
  return schema;
}

}  // namespace kingpin::parameters
