#include "models/planar/validate.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"
#include "models/planar/curve_spline.h"

namespace kingpin::planar {
namespace {

[[noreturn]] void Fail(std::string_view name, std::string found, std::string expected,
                       std::string suggestion = {}) {
  io::InputProblem problem;
  problem.key = fmt::format("planar.{}", name);
  problem.found = std::move(found);
  problem.expected = std::move(expected);
  problem.suggestion = std::move(suggestion);
  throw io::InputError(problem);
}

void Finite(std::string_view name, double value) {
  if (!std::isfinite(value)) Fail(name, fmt::format("{}", value), "a finite number");
}

void Positive(std::string_view name, double value, std::string_view unit) {
  Finite(name, value);
  if (!(value > 0)) Fail(name, fmt::format("{}", value), fmt::format("a number > 0 [{}]", unit));
}

void NotNegative(std::string_view name, double value, std::string_view unit) {
  Finite(name, value);
  if (!(value >= 0)) Fail(name, fmt::format("{}", value), fmt::format("a number >= 0 [{}]", unit));
}

void Mass(std::string_view name, double value, std::string_view unit) {
  Finite(name, value);
  if (!(value > 0)) {
    Fail(name, fmt::format("{}", value), fmt::format("a number > 0 [{}]", unit),
         "without it the mass matrix is singular");
  }
}

void CheckCurve(std::string_view name, const Curve<double>& curve, int least) {
  if (curve.count < least || curve.count > kMaxCurveNodes || curve.count == 1) {
    Fail(name, fmt::format("{} nodes", curve.count),
         fmt::format("{}2 to {} nodes", least == 0 ? "none or " : "", kMaxCurveNodes));
  }
  // Names are put together only for a message: batches validate every design.
  for (size_t k = 0; k < static_cast<size_t>(curve.count); ++k) {
    if (!std::isfinite(curve.x[k])) Finite(fmt::format("{}.x[{}]", name, k), curve.x[k]);
    if (!std::isfinite(curve.f[k])) Finite(fmt::format("{}.f[{}]", name, k), curve.f[k]);
    if (k > 0 && !(curve.x[k] > curve.x[k - 1])) {
      Fail(fmt::format("{}.x[{}]", name, k), fmt::format("{} after {}", curve.x[k], curve.x[k - 1]),
           "nodes that increase");
    }
  }
}

/// Every method starts from rest, the methods of fixed step only when the excitation begins.
void CheckRest(std::string_view name, const Curve<double>& curve) {
  double largest = 0;
  const auto count = static_cast<size_t>(curve.count);
  for (size_t k = 0; k < count; ++k) largest = std::max(largest, std::abs(curve.f[k]));
  const auto end = curve.x.begin() + curve.count;
  const auto zero = std::find(curve.x.begin(), end, 0.0);
  // Nearly always there is a node, and a spline need not be made for every design of a batch.
  const double force =
      zero != end ? curve.f[static_cast<size_t>(zero - curve.x.begin())] : MakeSpline(curve)(0.0);
  if (std::abs(force) <= 1e-9 * largest) return;
  Fail(name, fmt::format("{:g} N at rest (x = 0)", force), "no force at rest",
       "shift the curve so that it runs through (0, 0)");
}

}  // namespace

void ValidateParameters(const Parameters<double>& p) {
  Mass("carrier_mass", p.carrier_mass, "kg");
  Mass("carrier_yaw_inertia", p.carrier_yaw_inertia, "kg m^2");
  Mass("rack_mass", p.rack_mass, "kg");
  Mass("wheel_inertia", p.wheel_inertia, "kg m^2");
  Finite("force_x", p.force_x);
  Finite("force_y", p.force_y);
  Finite("lateral_share", p.lateral_share);
  Finite("design_origin_x", p.design_origin_x);
  Finite("design_origin_y", p.design_origin_y);
  Finite("rack_half_length", p.rack_half_length);
  Finite("rack_position", p.rack_position);
  Finite("outer_joint_x", p.outer_joint_x);
  Finite("outer_joint_y", p.outer_joint_y);
  Finite("half_track", p.half_track);
  Positive("rod_rigidity", p.rod_rigidity, "N");
  NotNegative("rod_compliance", p.rod_compliance, "m/N");
  NotNegative("rod_free_play", p.rod_free_play, "m");
  const double rod_x = p.outer_joint_x - p.rack_position;
  const double rod_y = p.design_origin_y + p.outer_joint_y - (p.rack_half_length - p.half_track);
  if (!(std::hypot(rod_x, rod_y) > 1e-6)) {
    Fail("rack_position", fmt::format("a tie rod of length {} m", std::hypot(rod_x, rod_y)),
         "inner and outer joint at different points");
  }
  NotNegative("lateral_stiffness", p.lateral_stiffness, "N/m");
  Finite("lateral_x", p.lateral_x);
  Finite("lateral_y", p.lateral_y);
  Finite("lateral_angle", p.lateral_angle);
  CheckCurve("longitudinal_force", p.longitudinal_force, 2);
  CheckRest("longitudinal_force", p.longitudinal_force);
  NotNegative("longitudinal_damping", p.longitudinal_damping, "N s/m");
  Finite("longitudinal_x", p.longitudinal_x);
  Finite("longitudinal_y", p.longitudinal_y);
  Finite("longitudinal_angle", p.longitudinal_angle);
  NotNegative("damping_time", p.damping_time, "s");
  NotNegative("aligning_stiffness", p.aligning_stiffness, "N m/rad");
  NotNegative("aligning_lag", p.aligning_lag, "s");
  NotNegative("rack_damping", p.rack_damping, "N s/m");
  NotNegative("friction_coefficient", p.friction_coefficient, "-");
  NotNegative("friction_preload", p.friction_preload, "N");
  NotNegative("friction_constant", p.friction_constant, "N");
  if (p.friction_law == FrictionLaw::kSmoothed) {
    Positive("friction_speed", p.friction_speed, "m/s");
  } else {
    Finite("friction_speed", p.friction_speed);
  }
  NotNegative("column_stiffness", p.column_stiffness, "N m/rad");
  Finite("gear_ratio", p.gear_ratio);
  NotNegative("stop_angle", p.stop_angle, "rad");
  if (p.stop_angle > 0 && !(p.stop_stiffness >= p.column_stiffness)) {
    Fail("stop_stiffness", fmt::format("{}", p.stop_stiffness),
         "at least the column's stiffness [N m/rad]");
  }
  NotNegative("stop_stiffness", p.stop_stiffness, "N m/rad");
  NotNegative("hands_damping", p.hands_damping, "N m s/rad");
  NotNegative("hands_stiffness", p.hands_stiffness, "N m/rad");
  Positive("rim_radius", p.rim_radius, "m");
  CheckCurve("assist_force", p.assist_force, 0);
  if (p.assist_force.count > 0 && (p.assist_force.x[0] != 0 || p.assist_force.f[0] != 0)) {
    Fail("assist_force", fmt::format("({}, {})", p.assist_force.x[0], p.assist_force.f[0]),
         "(0, 0) as the first node, because the assistance is odd");
  }
  if (p.assist_lag == AssistLag::kFirstOrder) Positive("assist_time", p.assist_time, "s");
  if (p.assist_lag == AssistLag::kSecondOrder) {
    Positive("assist_frequency", p.assist_frequency, "rad/s");
    NotNegative("assist_damping", p.assist_damping, "-");
  }
}

}  // namespace kingpin::planar
