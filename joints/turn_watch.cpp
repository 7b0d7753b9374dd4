#include "joints/turn_watch.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "joints/rotation_vector.h"

namespace kingpin::joints {

namespace {

bool IsZero(const LawDescription& law) { return law.coefficient == 0 && law.points.empty(); }

// Whether the force depends on how far it is turned; of a callback nothing is known.
bool FollowsAngle(const SpringDescription& spring) { return !IsZero(spring.stiffness); }
bool FollowsAngle(const StopDescription& /*stop*/) { return true; }
bool FollowsAngle(const MotorDescription& motor) { return motor.proportional != 0; }
bool FollowsAngle(const BushingDescription& bushing) {
  for (int i = 3; i < 6; ++i) {
    if (!IsZero(bushing.stiffness[i]) || bushing.preload[i] != 0) return true;
  }
  return bushing.coupled_stiffness.has_value();
}

Vector3<double> CalcTurn(const AxisPlace& place, bool is_bushing,
                         const mechanism::ForceContext<double>& context) {
  if (!is_bushing) return {0, 0, place.Calc(context).x};
  const FramePair<double> pair(context.w, place.a, place.b);
  return RotationVector<double>(pair.R_A.Transpose() * pair.R_B).r;
}

}  // namespace

TurnWatch::TurnWatch(const std::vector<ForceDescription>& forces, const Mechanism& mechanism) {
  const auto add_axis = [&](const auto& force) {
    const auto* axis = std::get_if<AboutAxis>(&force.place);
    if (axis == nullptr || !FollowsAngle(force)) return;
    AxisPlace place = MakeAxisPlace(mechanism, *axis);
    if (place.turns.empty()) watches_.push_back({force.name, false, std::move(place), {}});
  };
  for (const ForceDescription& force : forces) {
    if (const auto* spring = std::get_if<SpringDescription>(&force)) add_axis(*spring);
    if (const auto* stop = std::get_if<StopDescription>(&force)) add_axis(*stop);
    if (const auto* motor = std::get_if<MotorDescription>(&force)) add_axis(*motor);
    const auto* bushing = std::get_if<BushingDescription>(&force);
    if (bushing == nullptr || !FollowsAngle(*bushing)) continue;
    AxisPlace place;
    place.a = mechanism.MakeFrame(bushing->a);
    place.b = mechanism.MakeFrame(bushing->b);
    watches_.push_back({bushing->name, true, std::move(place), {}});
  }
}

void TurnWatch::Look(const mechanism::ForceContext<double>& context) {
  for (Watch& watch : watches_) {
    const Vector3<double> turn = CalcTurn(watch.place, watch.is_bushing, context);
    if (looked_ && CalcNorm(turn - watch.last) > std::numbers::pi) {
      throw std::runtime_error(fmt::format(
          "'{}' passes half a turn at t = {:g} s, where its {} would jump by a full turn: let a "
          "spring act on the coordinate of a joint there, which counts turns",
          watch.name, context.time, watch.is_bushing ? "deflection" : "angle"));
    }
    watch.last = turn;
  }
  looked_ = true;
}

}  // namespace kingpin::joints
