#include "models/planar/linear_model.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/math/dual.h"
#include "models/planar/linear_promotion.h"
#include "models/planar/planar_forces.h"
#include "models/planar/planar_model.h"

namespace kingpin::planar {
namespace {

constexpr int kVelocities = kCoordinates;
constexpr int kExtras = 2 * kCoordinates;
// Directions of differentiation: all states, F_T.
constexpr int kDirections = kExtras + kExtraStates + 1;
using Scalar = math::Dual<double, kDirections>;

// One output: its value and its derivatives with respect to states and F_T.
struct Output {
  const char* name;
  const char* unit;
  Scalar value;
};

}  // namespace

LinearModel MakeLinearModel(const Parameters<double>& parameters, const OperatingPoint& at) {
  Model<double> model = MakeModel(parameters);
  Structure& structure = model.structure;
  LinearModel result;
  if (structure.friction_law == FrictionLaw::kCoulomb) {
    structure.friction_law = FrictionLaw::kNone;
    result.notes.emplace_back(
        "set-valued rack friction has no derivative: the linear model is that of a rack sliding "
        "without friction");
  }
  if (structure.has_free_play) {
    structure.has_free_play = false;
    result.notes.emplace_back(
        "free play has no derivative at its ends: the linear model is that of a tie rod without "
        "clearance");
  }

  std::vector<int> used;
  used.reserve(kExtras + kExtraStates);
  for (int i = 0; i < kExtras; ++i) used.push_back(i);
  const auto use_extra = [&](ExtraState which, const char* name, const char* unit) {
    used.push_back(kExtras + which);
    result.state_names.emplace_back(name);
    result.state_units.emplace_back(unit);
  };
  result.state_names = {"carrier.x",
                        "carrier.y",
                        "carrier.yaw",
                        "rack.travel",
                        "steering.wheel.angle",
                        "carrier.x_rate",
                        "carrier.y_rate",
                        "carrier.yaw_rate",
                        "rack.speed",
                        "steering.wheel.angular_velocity"};
  result.state_units = {"m", "m", "rad", "m", "rad", "m/s", "m/s", "rad/s", "m/s", "rad/s"};
  if (structure.has_aligning_lag) use_extra(kAligningState, "tyre.lagged_yaw", "rad");
  if (structure.assist_lag != AssistLag::kNone) use_extra(kAssistState, "assist.force", "N");
  if (structure.assist_lag == AssistLag::kSecondOrder) {
    use_extra(kAssistRateState, "assist.force_rate", "N/s");
  }
  const auto n = static_cast<Eigen::Index>(used.size());
  result.coordinate_names = {"carrier x", "carrier y", "carrier yaw", "rack", "steering wheel"};
  for (int i = 0; i < kCoordinates; ++i) {
    result.mass.push_back(1.0 / model.constants.inverse_mass[i]);
  }

  State<Scalar> x{};
  result.state = Eigen::VectorXd::Zero(n);
  const auto variable = [](double value, int direction) {
    return Scalar::MakeVariable(value, direction);
  };
  for (int i = 0; i < kCoordinates; ++i) {
    const auto k = static_cast<std::size_t>(i);
    result.state(i) = at.position[k];
    result.state(kVelocities + i) = at.velocity[k];
    x.q[i] = variable(at.position[k], i);
    x.v[i] = variable(at.velocity[k], kVelocities + i);
  }
  if (!at.extra.empty() && at.extra.size() != used.size() - kExtras) {
    throw io::RunError(fmt::format("linear model: found {} extra states, expected {}",
                                   at.extra.size(), used.size() - kExtras));
  }
  for (int i = 0; i < kExtraStates; ++i) x.extra[i] = variable(0.0, kExtras + i);
  for (std::size_t i = 0; i < at.extra.size(); ++i) {
    x.extra[used[kExtras + i] - kExtras].v = at.extra[i];
    result.state(static_cast<Eigen::Index>(kExtras + i)) = at.extra[i];
  }
  const auto constants = PromoteConstants<Scalar>(model.constants);
  const Scalar force = variable(at.road_force, kDirections - 1);
  Dynamics<Scalar> out{};
  CalcDynamics<Scalar>(structure, constants, x, force, Scalar(0.0), out);

  const auto rate_of = [&](int state) {
    if (state < kVelocities) return x.v[state];
    if (state < kExtras) return out.a[state - kVelocities];
    return out.extra_rate[state - kExtras];
  };
  result.input_names = {"road.force", "kingpin.moment"};
  result.input_units = {"N", "N m"};
  result.a = Eigen::MatrixXd::Zero(n, n);
  result.b = Eigen::MatrixXd::Zero(n, 2);
  result.rate = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Scalar rate = rate_of(used[static_cast<std::size_t>(i)]);
    result.rate(i) = rate.v;
    for (Eigen::Index j = 0; j < n; ++j) {
      result.a(i, j) = rate.d[used[static_cast<std::size_t>(j)]];
    }
    result.b(i, 0) = rate.d[kDirections - 1];
  }
  // A moment on the carrier turns the carrier and acts on nothing else directly.
  result.b(kVelocities + 2, 1) = model.constants.inverse_mass[2];

  const Scalar rim = model.constants.rim_radius * out.a[4];
  const Output outputs[] = {
      {"tie_rod.force", "N", out.rod_force},
      {"steering.wheel.angle", "rad", x.q[4]},
      {"steering.wheel.rim_acceleration", "m/s^2", rim},
      {"steering.column.torque", "N m", out.torsion_torque},
      {"rack.travel", "m", x.q[3]},
      {"rack.force", "N", out.rack_rod_force},
  };
  const auto rows = static_cast<Eigen::Index>(std::size(outputs));
  result.c = Eigen::MatrixXd::Zero(rows, n);
  result.d = Eigen::MatrixXd::Zero(rows, 2);
  for (Eigen::Index o = 0; o < rows; ++o) {
    const Output& output = outputs[o];
    result.output_names.emplace_back(output.name);
    result.output_units.emplace_back(output.unit);
    for (Eigen::Index j = 0; j < n; ++j) {
      result.c(o, j) = output.value.d[used[static_cast<std::size_t>(j)]];
    }
    result.d(o, 0) = output.value.d[kDirections - 1];
  }
  if (!result.a.allFinite() || !result.b.allFinite() || !result.c.allFinite()) {
    throw io::RunError(
        "linear model: a derivative is not finite; check masses, lengths and the operating point");
  }
  return result;
}

LinearModel HoldSteeringWheel(const LinearModel& model) {
  constexpr int kWheel = 4;
  std::vector<Eigen::Index> keep;
  LinearModel held = model;
  held.state_names.clear();
  held.state_units.clear();
  for (Eigen::Index i = 0; i < model.a.rows(); ++i) {
    if (i == kWheel || i == model.coordinates + kWheel) continue;
    keep.push_back(i);
    held.state_names.push_back(model.state_names[static_cast<std::size_t>(i)]);
    held.state_units.push_back(model.state_units[static_cast<std::size_t>(i)]);
  }
  held.a = model.a(keep, keep);
  held.b = model.b(keep, Eigen::all);
  held.c = model.c(Eigen::all, keep);
  held.state = model.state(keep);
  held.rate = model.rate(keep);
  held.coordinates = model.coordinates - 1;
  held.coordinate_names.erase(held.coordinate_names.begin() + kWheel);
  held.mass.erase(held.mass.begin() + kWheel);
  const auto rim = std::find(held.output_names.begin(), held.output_names.end(),
                             "steering.wheel.rim_acceleration");
  if (rim != held.output_names.end()) {
    held.c.row(rim - held.output_names.begin()).setZero();
    held.d.row(rim - held.output_names.begin()).setZero();
  }
  held.notes.emplace_back("the driver holds the steering wheel");
  return held;
}

Eigen::MatrixXd CalcStiffness(const LinearModel& model) {
  const int n = model.coordinates;
  const Eigen::Map<const Eigen::VectorXd> mass(model.mass.data(), n);
  return -(mass.asDiagonal() * model.a.block(n, 0, n, n));
}

Eigen::MatrixXd CalcDamping(const LinearModel& model) {
  const int n = model.coordinates;
  const Eigen::Map<const Eigen::VectorXd> mass(model.mass.data(), n);
  return -(mass.asDiagonal() * model.a.block(n, n, n, n));
}

}  // namespace kingpin::planar
