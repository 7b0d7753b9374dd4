#include "models/parameters/car_schema.h"

#include <cmath>

#include <fmt/format.h>

#include "models/parameters/car_mass.h"
#include "models/parameters/part_schemas.h"

namespace kingpin::parameters {

namespace {

constexpr double kFarthest = 10.0;
constexpr double kGroundTolerance = 0.005;  // [m]

const io::Schema<HalfShaft>& HalfShaftSchema() {
  static const io::Schema<HalfShaft> schema = [] {
    io::Schema<HalfShaft> s("half_shaft", "Solid round half shaft with a joint at each end.");
    s.Quantity("mass", &HalfShaft::mass, "kg", "with joints").Positive().Max(100.0);
    s.Quantity("diameter", &HalfShaft::diameter, "m", "diameter").Positive().Max(0.5);
    s.Quantity("length", &HalfShaft::length, "m", "length between the joints").Positive().Max(5.0);
    s.Point("inner_joint", &HalfShaft::inner_joint, "m", "centre of the inner joint")
        .Min(-kFarthest)
        .Max(kFarthest);
    return s;
  }();
  return schema;
}

}  // namespace

const io::Schema<Body>& BodySchema() {
  static const io::Schema<Body> schema = [] {
    io::Schema<Body> s("car_body", "The car body with everything that moves with it.");
    s.Section("body", &Body::body, RigidBodySchema(), "mass and inertia");
    s.Quantity("ground_height", &Body::ground_height, "m", "z of the road under the car at rest")
        .Below(0.0)
        .Min(-5.0);
    return s;
  }();
  return schema;
}

const io::Schema<RearSuspension>& RearSuspensionSchema() {
  static const io::Schema<RearSuspension> schema = [] {
    using R = RearSuspension;
    io::Schema<R> s("rear_suspension", "Twist-beam rear axle, left side.");
    const auto point = [&s](const char* key, Eigen::Vector3d R::*member, const char* text) {
      s.Point(key, member, "m", text).Min(-kFarthest).Max(kFarthest);
    };
    point("wheel_centre", &R::wheel_centre, "wheel centre");
    s.Section("pivot", &R::pivot, BushingSchema(), "bushing between arm and body");
    point("shear_centre", &R::shear_centre, "of the cross beam, y = 0");
    point("spring_lower", &R::spring_lower, "spring's seat on the arm");
    point("spring_upper", &R::spring_upper, "spring's seat on the body");
    point("damper_lower", &R::damper_lower, "damper's joint on the arm");
    point("damper_upper", &R::damper_upper, "damper's joint on the body");
    s.Section("beam", &R::beam, RigidBodySchema(), "the beam with both arms");
    s.Quantity("hub_mass", &R::hub_mass, "kg", "hub and brake of one side").Positive().Max(1000.0);
    s.Quantity("torsion_stiffness", &R::torsion_stiffness, "N m/rad", "of the cross beam")
        .NonNegative()
        .Max(1e7);
    s.Section("spring_damper", &R::spring_damper, SpringDamperSchema(), "spring, damper, stops");
    s.Check([](const R& rear, io::Check& check) {
      for (const auto& [key, p] : {std::pair("wheel_centre", &rear.wheel_centre),
                                   std::pair("pivot.position", &rear.pivot.position),
                                   std::pair("spring_lower", &rear.spring_lower),
                                   std::pair("spring_upper", &rear.spring_upper),
                                   std::pair("damper_lower", &rear.damper_lower),
                                   std::pair("damper_upper", &rear.damper_upper)}) {
        if (p->y() > 0.0) continue;
        check.Fail(key, fmt::format("y = {:g} m", p->y()), "y above 0 m",
                   "list the left side; y is positive to the left");
      }
      for (const auto& [key, p] : {std::pair("shear_centre", &rear.shear_centre),
                                   std::pair("beam.centre_of_mass", &rear.beam.centre_of_mass)}) {
        if (p->y() == 0.0) continue;
        check.Fail(key, fmt::format("y = {:g} m", p->y()), "y = 0 m",
                   "the beam lies across the car's centre plane");
      }
      if (rear.pivot.position.x() <= rear.wheel_centre.x()) {
        check.Fail("pivot.position", fmt::format("x = {:g} m", rear.pivot.position.x()),
                   fmt::format("ahead of wheel_centre, x = {:g} m", rear.wheel_centre.x()),
                   "the arms trail");
      }
    });
    return s;
  }();
  return schema;
}

const io::Schema<Driveline>& DrivelineSchema() {
  static const io::Schema<Driveline> schema = [] {
    using D = Driveline;
    io::Schema<D> s("driveline", "Front-wheel drive with an open differential.");
    s.Section("left", &D::left, HalfShaftSchema(), "left half shaft");
    s.Section("right", &D::right, HalfShaftSchema(), "right half shaft");
    s.Quantity("shear_modulus", &D::shear_modulus, "Pa", "of the half shafts").Positive().Max(1e13);
    s.Quantity("shaft_damping", &D::shaft_damping, "N m s/rad", "of each half shaft")
        .NonNegative()
        .Max(1e4);
    s.Quantity("differential_inertia", &D::differential_inertia, "kg m^2",
               "cage and final-drive wheel")
        .Positive()
        .Max(100.0);
    s.Quantity("final_drive_ratio", &D::final_drive_ratio, "1", "final drive")
        .Positive()
        .Max(100.0);
    s.Quantity("gear_ratio", &D::gear_ratio, "1", "of the gear engaged").Positive().Max(100.0);
    s.Quantity("engine_inertia", &D::engine_inertia, "kg m^2", "with flywheel and clutch")
        .Positive()
        .Max(100.0);
    s.Check([](const D& driveline, io::Check& check) {
      if (driveline.left.inner_joint.y() <= driveline.right.inner_joint.y()) {
        check.Fail(
            "left.inner_joint", fmt::format("y = {:g} m", driveline.left.inner_joint.y()),
            fmt::format("left of right.inner_joint, y = {:g} m", driveline.right.inner_joint.y()),
            "y is positive to the left");
      }
    });
    return s;
  }();
  return schema;
}

const io::Schema<Tyres>& TyresSchema() {
  static const io::Schema<Tyres> schema = [] {
    using T = Tyres;
    io::Schema<T> s("tyres", "Wheel and tyre, alike on all four corners.");
    s.Section("belt", &T::belt, RevolvedBodySchema(), "belt of the tyre");
    s.Section("rim", &T::rim, RevolvedBodySchema(), "rim with the lower sidewall");
    s.Quantity("free_radius", &T::free_radius, "m", "unloaded radius").Positive().Max(2.0);
    s.Quantity("effective_rolling_radius", &T::effective_rolling_radius, "m", "speed over spin")
        .Positive()
        .Max(2.0);
    s.Quantity("vertical_stiffness", &T::vertical_stiffness, "N/m", "vertical").Positive().Max(1e8);
    s.Quantity("vertical_damping", &T::vertical_damping, "N s/m", "vertical")
        .NonNegative()
        .Max(1e5);
    s.Quantity("ring_torsion_stiffness", &T::ring_torsion_stiffness, "N m/rad",
               "belt against rim about the axle")
        .Positive()
        .Max(1e8);
    s.Quantity("ring_torsion_damping", &T::ring_torsion_damping, "N m s/rad",
               "belt against rim about the axle")
        .NonNegative()
        .Max(1e5);
    s.Quantity("ring_radial_stiffness", &T::ring_radial_stiffness, "N/m",
               "belt against rim in the wheel's plane")
        .Positive()
        .Max(1e9);
    s.Quantity("cornering_stiffness", &T::cornering_stiffness, "N/rad",
               "lateral force per slip angle at static load")
        .Positive()
        .Max(1e7);
    s.Quantity("pneumatic_trail", &T::pneumatic_trail, "m", "pneumatic trail").Min(-1.0).Max(1.0);
    s.Quantity("relaxation_length", &T::relaxation_length, "m", "sigma").Positive().Max(10.0);
    s.Check([](const T& tyres, io::Check& check) {
      if (tyres.effective_rolling_radius <= tyres.free_radius) return;
      check.Fail("effective_rolling_radius", fmt::format("{:g} m", tyres.effective_rolling_radius),
                 fmt::format("at most free_radius, {:g} m", tyres.free_radius));
    });
    return s;
  }();
  return schema;
}

const io::Schema<Car>& CarSchema() {
  static const io::Schema<Car> schema = [] {
    io::Schema<Car> s("car", "A car, for the planar and the spatial model.");
    s.Text("name", &Car::name, "what reports call it");
    s.Include("body", &Car::body, BodySchema(), "car body");
    s.Include("front_suspension", &Car::front, FrontSuspensionSchema(), "front axle");
    s.Include("rear_suspension", &Car::rear, RearSuspensionSchema(), "rear axle");
    s.Include("steering", &Car::steering, SteeringSchema(), "steering");
    s.Include("driveline", &Car::driveline, DrivelineSchema(), "driveline");
    s.Include("tyres", &Car::tyres, TyresSchema(), "wheels and tyres");
    s.Check([](const Car& car, io::Check& check) {
      const double front = car.front.hardpoints.wheel_centre.x();
      if (car.rear.wheel_centre.x() >= front) {
        check.Fail(
            "rear_suspension.wheel_centre", fmt::format("x = {:g} m", car.rear.wheel_centre.x()),
            fmt::format("behind front_suspension.hardpoints.wheel_centre, x = {:g} m", front),
            "x points forward");
        return;
      }
      const StaticLoads loads = CalcStaticLoads(car);
      if (loads.front_wheel <= 0.0 || loads.rear_wheel <= 0.0) {
        check.Fail("body.body.centre_of_mass",
                   fmt::format("the car's centre of mass {:g} m behind the front axle",
                               loads.centre_behind),
                   fmt::format("between the axles, 0 to {:g} m", loads.wheelbase),
                   "x points forward; points behind the front axle have a negative x");
        return;
      }
      const double ground = car.front.hardpoints.wheel_centre.z() - car.tyres.free_radius +
                            loads.front_wheel / car.tyres.vertical_stiffness;
      if (std::abs(ground - car.body.ground_height) > kGroundTolerance) {
        check.Fail(
            "body.ground_height", fmt::format("{:g} m", car.body.ground_height),
            fmt::format("{:.4f} m within 5 mm, the front wheel centre less tyres.free_radius "
                        "plus the deflection under {:.0f} N",
                        ground, loads.front_wheel),
            "change ground_height, tyres.free_radius or tyres.vertical_stiffness");
      }
    });
    return s;
  }();
  return schema;
}

}  // namespace kingpin::parameters
