#include "models/parameters/car_mass.h"

#include <Eigen/Geometry>

#include "core/io/units.h"

namespace kingpin::parameters {

namespace {

Eigen::Matrix3d PointInertia(double mass, const Eigen::Vector3d& r) {
  return mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
}

MassProperties Point(double mass, const Eigen::Vector3d& position) {
  return {mass, position, Eigen::Matrix3d::Zero()};
}

MassProperties SlenderRod(double mass, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  // m l²/12 across the rod is the inertia of a point of mass m/12 at distance l.
  return {mass, 0.5 * (a + b), PointInertia(mass / 12.0, b - a)};
}

MassProperties BothSides(const MassProperties& left) { return Combine(left, Mirror(left)); }

}  // namespace

MassProperties ToMassProperties(const RigidBody& body) {
  MassProperties result{body.mass, body.centre_of_mass, body.inertia.asDiagonal()};
  result.inertia(0, 2) = result.inertia(2, 0) = body.inertia_xz;
  return result;
}

MassProperties Combine(const MassProperties& first, const MassProperties& second) {
  MassProperties sum;
  sum.mass = first.mass + second.mass;
  sum.centre_of_mass =
      (first.mass * first.centre_of_mass + second.mass * second.centre_of_mass) / sum.mass;
  for (const MassProperties* part : {&first, &second}) {
    sum.inertia +=
        part->inertia + PointInertia(part->mass, part->centre_of_mass - sum.centre_of_mass);
  }
  return sum;
}

MassProperties Mirror(const MassProperties& part) {
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal();
  return {part.mass, mirror * part.centre_of_mass, mirror * part.inertia * mirror};
}

MassProperties CalcWheel(const Tyres& tyres, const Eigen::Vector3d& centre) {
  const double across = tyres.belt.diameter_inertia + tyres.rim.diameter_inertia;
  const double spin = tyres.belt.spin_inertia + tyres.rim.spin_inertia;
  return {tyres.belt.mass + tyres.rim.mass, centre,
          Eigen::Vector3d(across, spin, across).asDiagonal()};
}

MassProperties CalcFrontCarrier(const Car& car) {
  return Combine(Combine(ToMassProperties(car.front.knuckle), ToMassProperties(car.front.hub)),
                 CalcWheel(car.tyres, car.front.hardpoints.wheel_centre));
}

MassProperties CalcWholeCar(const Car& car) {
  const FrontHardpoints& front = car.front.hardpoints;
  MassProperties sum = ToMassProperties(car.body.body);
  const auto add = [&sum](const MassProperties& part) { sum = Combine(sum, part); };
  add(BothSides(CalcFrontCarrier(car)));
  add(BothSides(ToMassProperties(car.front.lower_control_arm)));
  add(BothSides(SlenderRod(car.front.tie_rod.mass, front.tie_rod_inner, front.tie_rod_outer)));
  const Eigen::Vector3d hub = car.front.hub.centre_of_mass;
  add(SlenderRod(car.driveline.left.mass, car.driveline.left.inner_joint, hub));
  add(SlenderRod(car.driveline.right.mass, car.driveline.right.inner_joint,
                 {hub.x(), -hub.y(), hub.z()}));
  add(Point(car.steering.rack.mass, {front.tie_rod_inner.x(), 0.0, front.tie_rod_inner.z()}));
  add(Point(car.steering.wheel.mass, car.steering.wheel.centre));
  add(BothSides(CalcWheel(car.tyres, car.rear.wheel_centre)));
  add(BothSides(Point(car.rear.hub_mass, car.rear.wheel_centre)));
  add(ToMassProperties(car.rear.beam));
  return sum;
}

StaticLoads CalcStaticLoads(const Car& car) {
  const MassProperties whole = CalcWholeCar(car);
  StaticLoads loads;
  const double front_x = car.front.hardpoints.wheel_centre.x();
  loads.wheelbase = front_x - car.rear.wheel_centre.x();
  loads.centre_behind = front_x - whole.centre_of_mass.x();
  loads.centre_height = whole.centre_of_mass.z() - car.body.ground_height;
  const double rear_share = loads.centre_behind / loads.wheelbase;
  loads.front_wheel = 0.5 * whole.mass * io::kStandardGravity * (1.0 - rear_share);
  loads.rear_wheel = 0.5 * whole.mass * io::kStandardGravity * rear_share;
  const double half_shafts = 0.5 * (car.driveline.left.mass + car.driveline.right.mass);
  loads.front_unsprung = CalcFrontCarrier(car).mass + 0.5 * (car.front.lower_control_arm.mass +
                                                             car.front.tie_rod.mass + half_shafts);
  const double pivot_x = car.rear.pivot.position.x();
  const double beam_share =
      (pivot_x - car.rear.beam.centre_of_mass.x()) / (pivot_x - car.rear.wheel_centre.x());
  loads.rear_unsprung = car.tyres.belt.mass + car.tyres.rim.mass + car.rear.hub_mass +
                        0.5 * car.rear.beam.mass * beam_share;
  return loads;
}

}  // namespace kingpin::parameters
