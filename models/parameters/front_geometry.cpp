#include "models/parameters/front_geometry.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "models/parameters/car_mass.h"

namespace kingpin::parameters {

using Eigen::Vector3d;

namespace {

using Row6 = Eigen::Matrix<double, 1, 6>;

// n·(v + ω × r) = [nᵀ (r × n)ᵀ] (v, ω), with v the velocity of the wheel centre.
Row6 VelocityAlong(const Vector3d& n, const Vector3d& r) {
  Row6 row;
  row << n.transpose(), r.cross(n).transpose();
  return row;
}

FrontMotion CalcMotion(const Car& car, double wheel_travel, double rack_travel) {
  const FrontHardpoints& p = car.front.hardpoints;
  const Vector3d arm_axis =
      (car.front.arm_front.position - car.front.arm_rear.position).normalized();
  const Vector3d strut = (p.strut_top - p.strut_lower).normalized();
  const Vector3d across = strut.unitOrthogonal();
  const Vector3d rod = (p.tie_rod_outer - p.tie_rod_inner).normalized();
  const Vector3d ball = p.lower_ball_joint - p.wheel_centre;
  const Vector3d top = p.strut_top - p.wheel_centre;
  const Vector3d outer = p.tie_rod_outer - p.wheel_centre;
  Eigen::Matrix<double, 6, 6> a;
  a << VelocityAlong(arm_axis, ball),
      VelocityAlong((p.lower_ball_joint - car.front.arm_rear.position).normalized(), ball),
      VelocityAlong(across, top), VelocityAlong(strut.cross(across), top),
      VelocityAlong(rod, outer), VelocityAlong(Vector3d::UnitZ(), Vector3d::Zero());
  Eigen::Matrix<double, 6, 1> b;
  b << 0.0, 0.0, 0.0, 0.0, rod.y() * rack_travel, wheel_travel;
  const Eigen::Matrix<double, 6, 1> x = a.fullPivLu().solve(b);
  FrontMotion motion;
  motion.wheel_centre = x.head<3>();
  motion.rotation = x.tail<3>();
  const auto velocity = [&](const Vector3d& point) -> Vector3d {
    return motion.wheel_centre + motion.rotation.cross(point - p.wheel_centre);
  };
  motion.strut = strut.dot(velocity(p.strut_top));
  motion.anti_roll_link = velocity(car.front.anti_roll_bar.link_on_strut);
  motion.patch = velocity({p.wheel_centre.x(), p.wheel_centre.y(), car.body.ground_height});
  return motion;
}

}  // namespace

FrontGeometry CalcFrontGeometry(const Car& car) {
  const FrontHardpoints& p = car.front.hardpoints;
  FrontGeometry g;
  const Vector3d line = p.strut_top - p.lower_ball_joint;
  g.axis = line.normalized();
  g.inclination = std::atan2(-line.y(), line.z());
  g.caster = std::atan2(-line.x(), line.z());
  const auto at_height = [&](double z) -> Vector3d {
    return p.lower_ball_joint + line * ((z - p.lower_ball_joint.z()) / line.z());
  };
  g.axis_at_hub = at_height(p.wheel_centre.z());
  g.axis_at_ground = at_height(car.body.ground_height);
  g.contact_patch = {p.wheel_centre.x(), p.wheel_centre.y(), car.body.ground_height};
  g.hub_offset = p.wheel_centre.y() - g.axis_at_hub.y();
  g.scrub_radius = g.contact_patch.y() - g.axis_at_ground.y();
  g.caster_trail = g.axis_at_ground.x() - g.contact_patch.x();
  const auto moment = [&](const Vector3d& point, const Vector3d& force) {
    return g.axis.dot((point - p.lower_ball_joint).cross(force));
  };
  g.moment_fx_centre = moment(p.wheel_centre, Vector3d::UnitX());
  g.moment_fx_patch = moment(g.contact_patch, Vector3d::UnitX());
  g.moment_fy_patch = moment(g.contact_patch, Vector3d::UnitY());
  g.moment_fz_patch = moment(g.contact_patch, Vector3d::UnitZ());
  const Vector3d rod = p.tie_rod_outer - p.tie_rod_inner;
  g.tie_rod_length = rod.norm();
  g.tie_rod = rod.normalized();
  g.tie_rod_lever = std::abs(moment(p.tie_rod_outer, g.tie_rod));
  g.rack_force_per_fx = std::abs(g.moment_fx_centre) / g.tie_rod_lever * std::abs(g.tie_rod.y());
  const MassProperties carrier = CalcFrontCarrier(car);
  const Vector3d arm = g.axis.cross(carrier.centre_of_mass - p.lower_ball_joint);
  g.carrier_axis_inertia = g.axis.dot(carrier.inertia * g.axis) + carrier.mass * arm.squaredNorm();
  return g;
}

FrontMotion CalcBumpMotion(const Car& car) { return CalcMotion(car, 1.0, 0.0); }

FrontMotion CalcRackMotion(const Car& car) { return CalcMotion(car, 0.0, 1.0); }

}  // namespace kingpin::parameters
