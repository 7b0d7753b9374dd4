#include "models/planar/front_compliance.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "core/io/error.h"

namespace kingpin::planar {

using Eigen::Vector3d;
using parameters::BushingAxis;

namespace {

constexpr int kMaxIterations = 200;
constexpr double kSteeringHold = 1e4;  // [N m/rad]

FrontCompliance::Row12 RotationRow(int body, int axis) {
  FrontCompliance::Row12 row = FrontCompliance::Row12::Zero();
  row(6 * body + 3 + axis) = 1.0;
  return row;
}

}  // namespace

double CalcBushingDamping(const BushingAxis& axis) {
  return axis.loss_factor * axis.stiffness / (2.0 * std::numbers::pi * axis.loss_frequency);
}

FrontCompliance::FrontCompliance(const parameters::FrontSuspension& front,
                                 const FrontComplianceOptions& options)
    : wheel_centre_(front.hardpoints.wheel_centre), ball_joint_(front.hardpoints.lower_ball_joint) {
  using Progression = FrontComplianceOptions::Progression;
  const bool all = options.progression == Progression::kAll;
  const double rubber = options.dynamic_rubber ? front.rubber_dynamic_factor : 1.0;
  const auto add_linear = [this](const Row12& row, double stiffness, double damping = 0.0) {
    elements_.push_back({row, stiffness, 0.0, damping});
  };
  const auto add_rubber = [&](const Row12& row, const BushingAxis& axis, bool progressive) {
    elements_.push_back({row, rubber * axis.stiffness, progressive ? 1.0 / axis.progression : 0.0,
                         CalcBushingDamping(axis)});
  };
  for (const parameters::Bushing* bushing : {&front.arm_front, &front.arm_rear}) {
    const bool rear = bushing == &front.arm_rear;
    add_rubber(ArmRow(bushing->position, Vector3d::UnitX()), bushing->x, all);
    add_rubber(ArmRow(bushing->position, Vector3d::UnitY()), bushing->y, all || rear);
    add_rubber(ArmRow(bushing->position, Vector3d::UnitZ()), bushing->z, all);
    for (int axis = 0; axis < 3; ++axis) {
      add_linear(RotationRow(1, axis), rubber * bushing->rotation[axis]);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d direction = Vector3d::Unit(axis);
    add_linear(CarrierRow(ball_joint_, direction) - ArmRow(ball_joint_, direction),
               front.ball_joint_stiffness);
  }
  const Vector3d top = front.hardpoints.strut_top;
  const Vector3d strut = (top - front.hardpoints.strut_lower).normalized();
  const Vector3d across = strut.unitOrthogonal();
  add_rubber(CarrierRow(top, across), front.top_mount.radial, all);
  add_rubber(CarrierRow(top, strut.cross(across)), front.top_mount.radial, all);
  add_linear(CarrierRow(top, strut), 1.0 / (1.0 / front.strut.spring_rate +
                                            1.0 / (rubber * front.top_mount.axial.stiffness)));
  const Vector3d axis = (top - ball_joint_).normalized();
  steering_.segment<3>(3) = axis.transpose();
  steering_shape_.segment<3>(0) = axis.cross(wheel_centre_ - ball_joint_);
  steering_shape_.segment<3>(3) = axis;
  has_tie_rod_ = options.tie_rod_stiffness.has_value();
  if (options.tie_rod_stiffness) {
    const Vector3d outer = front.hardpoints.tie_rod_outer;
    add_linear(CarrierRow(outer, (outer - front.hardpoints.tie_rod_inner).normalized()),
               *options.tie_rod_stiffness);
  }
}

FrontCompliance::Row12 FrontCompliance::CarrierRow(const Vector3d& point,
                                                   const Vector3d& direction) const {
  Row12 row = Row12::Zero();
  row.segment<3>(0) = direction.transpose();
  row.segment<3>(3) = (point - wheel_centre_).cross(direction).transpose();
  return row;
}

FrontCompliance::Row12 FrontCompliance::ArmRow(const Vector3d& point,
                                               const Vector3d& direction) const {
  Row12 row = Row12::Zero();
  row.segment<3>(6) = direction.transpose();
  row.segment<3>(9) = (point - ball_joint_).cross(direction).transpose();
  return row;
}

FrontCompliance::Vector12 FrontCompliance::CalcLoad(const Vector3d& point, const Vector3d& force,
                                                    const Vector3d& moment) const {
  Vector12 load = Vector12::Zero();
  load.segment<3>(0) = force;
  load.segment<3>(3) = (point - wheel_centre_).cross(force) + moment;
  return load;
}

FrontCompliance::Matrix12 FrontCompliance::CalcStiffness(const Vector12& q) const {
  Matrix12 stiffness = Matrix12::Zero();
  for (const Element& element : elements_) {
    const double ratio = element.row.dot(q) * element.progression;
    const double tangent = element.stiffness * (1.0 + 5.0 * std::pow(ratio, 4));
    stiffness.noalias() += tangent * element.row.transpose() * element.row;
  }
  return stiffness;
}

void FrontCompliance::CheckLoad(const Vector12& load) const {
  const double moment = load.dot(steering_shape_);
  if (has_tie_rod_ || std::abs(moment) <= 1e-9 * load.norm()) return;
  throw std::invalid_argument(fmt::format(
      "without a tie rod nothing carries the moment {:.3g} N m about the steering axis", moment));
}

FrontCompliance::Vector12 FrontCompliance::SolveLinear(const Matrix12& stiffness,
                                                       const Vector12& load) const {
  if (has_tie_rod_) return stiffness.ldlt().solve(load);
  // A spring about the steering axis holds the free motion; it carries nothing.
  return (stiffness + kSteeringHold * steering_.transpose() * steering_).ldlt().solve(load);
}

FrontCompliance::Displacement FrontCompliance::CalcLinearResponse(const Vector12& load) const {
  CheckLoad(load);
  const Vector12 q = SolveLinear(CalcStiffness(), load);
  return {q.segment<3>(0), q.segment<3>(3)};
}

Eigen::Matrix3d FrontCompliance::CalcCondensed(const Vector3d& point, bool hold_height) const {
  // The carrier's displacement moves from the wheel centre to the point: u_W = u_P − θ × (p_P −
  // p_W).
  Matrix12 change = Matrix12::Identity();
  const Vector3d arm = point - wheel_centre_;
  for (int axis = 0; axis < 3; ++axis) {
    change.block<3, 1>(0, 3 + axis) = -Vector3d::Unit(axis).cross(arm);
  }
  const Matrix12 stiffness = change.transpose() * CalcStiffness() * change;
  const std::array<int, 3> kept = {0, 1, 5};
  std::vector<int> eliminated;
  for (int i = 0; i < 12; ++i) {
    const bool keep = std::find(kept.begin(), kept.end(), i) != kept.end();
    if (!keep && !(hold_height && i == 2)) eliminated.push_back(i);
  }
  const Eigen::MatrixXd inner = stiffness(eliminated, eliminated);
  const Eigen::MatrixXd coupling = stiffness(eliminated, kept);
  return stiffness(kept, kept) - coupling.transpose() * inner.ldlt().solve(coupling);
}

double FrontCompliance::CalcPotential(const Vector12& q, const Vector12& load) const {
  double potential = -load.dot(q);
  for (const Element& element : elements_) {
    const double d = element.row.dot(q);
    const double ratio = d * element.progression;
    potential += element.stiffness * d * d * (0.5 + std::pow(ratio, 4) / 6.0);
  }
  return potential;
}

FrontCompliance::Vector12 FrontCompliance::SolveEquilibrium(const Vector12& load) const {
  CheckLoad(load);
  Vector12 q = Vector12::Zero();
  const double tolerance = 1e-10 * (load.norm() + 1.0);
  double residual_norm = 0.0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Vector12 residual = -load;
    for (const Element& element : elements_) {
      const double d = element.row.dot(q);
      const double ratio = d * element.progression;
      residual += element.stiffness * d * (1.0 + std::pow(ratio, 4)) * element.row.transpose();
    }
    residual_norm = residual.norm();
    if (residual_norm <= tolerance) return q;
    const Vector12 step = -SolveLinear(CalcStiffness(q), residual);
    const double slope = residual.dot(step);
    const double start = CalcPotential(q, load);
    // Near the minimum the potential cannot tell a good step from rounding any more: take it whole.
    double length = 1.0;
    while (length > 1e-6 && -slope > 1e-12 * std::abs(start) &&
           CalcPotential(q + length * step, load) > start + 1e-4 * length * slope) {
      length *= 0.5;
    }
    q += length * step;
  }
  throw io::RunError(fmt::format(
      "the front suspension's equilibrium was not found in {} iterations (residual {:.3g} of load "
      "{:.3g}); check the bushings' stiffnesses",
      kMaxIterations, residual_norm, load.norm()));
}

double FrontCompliance::SolveForce(const Vector3d& point, double recession) const {
  // x(F) rises and bends down (the bushings stiffen), so Newton's method on it from F = 0 climbs to
  // the solution without overshooting. The laws are odd.
  const Vector12 unit = CalcLoad(point, Vector3d::UnitX());
  const double target = std::abs(recession);
  double force = 0.0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Vector12 q = SolveEquilibrium(force * unit);
    const double gap = target - unit.dot(q);
    if (std::abs(gap) <= 1e-12 * target) break;
    force += gap / unit.dot(SolveLinear(CalcStiffness(q), unit));
  }
  return std::copysign(force, recession);
}

Vector3d FrontCompliance::CalcPointDisplacement(const Vector12& q, const Vector3d& point) const {
  return q.segment<3>(0) + Vector3d(q.segment<3>(3)).cross(point - wheel_centre_);
}

double FrontCompliance::CalcDamping(const Vector3d& point) const {
  const Vector12 unit = CalcLoad(point, Vector3d::UnitX());
  Vector12 shape = SolveLinear(CalcStiffness(), unit);
  shape /= unit.dot(shape);
  double damping = 0.0;
  for (const Element& element : elements_) {
    damping += element.damping * std::pow(element.row.dot(shape), 2);
  }
  return damping;
}

}  // namespace kingpin::planar
