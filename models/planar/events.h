#pragma once

#include "models/planar/planar_forces.h"

/// Switching of the planar model, for one design at a time: Coulomb friction between sticking and
/// sliding, torsion-bar stops, free play. A step that crosses a switch is cut at the crossing,
/// which is found by repeating the step with other lengths, so that no step of the integrator sees
/// two branches of a force.
namespace kingpin::planar {

/// Switching functions; the sign of each says on which side the state is.
enum SwitchIndex { kFrictionSwitch, kUpperStop, kLowerStop, kUpperPlay, kLowerPlay, kSwitches };

template <class S>
struct Switches {
  S slip{};  ///< −1, 0 or 1; as for CalcDynamics
  bool positive[kSwitches] = {};
};

template <class S>
KINGPIN_INLINE S CalcElongation(const Structure& st, const Constants<S>& k, const State<S>& x) {
  using math::InverseSqrtNearOne;
  using math::SinCos;
  S s, c;
  SinCos(x.q[2], s, c);
  const S c1 = c - 1.0;
  const S move_x = x.q[0] + (c1 * k.outer_x - s * k.outer_y);
  S move_y = x.q[1] + (s * k.outer_x + c1 * k.outer_y);
  if (st.two_way) move_y = move_y - x.q[3];
  const S growth = move_x * (k.rod_x + k.rod_x + move_x) + move_y * (k.rod_y + k.rod_y + move_y);
  const S u = growth * k.inverse_rod_length_squared;
  return k.rod_length * ((1.0 + u) * InverseSqrtNearOne(u) - 1.0);
}

/// The value of one switching function. Friction: while sliding, the speed in the direction of
/// sliding; while sticking, limit − |reaction|.
template <class S>
[[gnu::noinline]] S CalcSwitch(const Structure& st, const Constants<S>& k, const State<S>& x,
                               const S& road_force, const S& slip, int index) {
  using math::Abs;
  using math::Any;
  switch (index) {
    case kFrictionSwitch: {
      if (Any(slip == S(0.0))) {
        Dynamics<S> d;
        CalcDynamics(st, k, x, road_force, slip, d);
        return d.friction_limit - Abs(d.friction_force);
      }
      return slip * x.v[3];
    }
    case kUpperStop:
      return x.q[4] - k.gear_ratio * x.q[3] - k.stop_angle;
    case kLowerStop:
      return x.q[4] - k.gear_ratio * x.q[3] + k.stop_angle;
    case kUpperPlay:
      return CalcElongation(st, k, x) - k.rod_half_play;
    default:
      return CalcElongation(st, k, x) + k.rod_half_play;
  }
}

KINGPIN_INLINE bool IsSwitchUsed(const Structure& st, int index) {
  if (index == kFrictionSwitch) return st.friction_law == FrictionLaw::kCoulomb;
  if (index == kUpperStop || index == kLowerStop) return st.has_stops;
  return st.has_free_play;
}

/// Decides what friction does in a state where the rack rests: holds it if it can, else lets it
/// slide the way it is pushed.
template <class S>
[[gnu::noinline]] void UpdateFriction(const Structure& st, const Constants<S>& k, const State<S>& x,
                                      const S& road_force, bool breaks_away, Switches<S>& sw) {
  using math::Abs;
  using math::Any;
  Dynamics<S> d;
  CalcDynamics(st, k, x, road_force, S(0.0), d);
  // At a located breakaway the reaction equals the limit: the answer is known, and asking again
  // would let rounding decide.
  if (!breaks_away && Any(d.friction_limit - Abs(d.friction_force) > S(0.0))) {
    sw.slip = S(0.0);
  } else {
    sw.slip = Any(d.friction_force < S(0.0)) ? S(1.0) : S(-1.0);
  }
  sw.positive[kFrictionSwitch] = true;
}

/// At rest at the start of a run.
template <class S>
Switches<S> MakeSwitches(const Structure& st, const Constants<S>& k, const State<S>& x,
                         const S& road_force) {
  using math::Any;
  Switches<S> sw;
  for (int i = 0; i < kSwitches; ++i) {
    if (!IsSwitchUsed(st, i) || i == kFrictionSwitch) continue;
    sw.positive[i] = Any(CalcSwitch(st, k, x, road_force, sw.slip, i) > S(0.0));
  }
  if (st.friction_law == FrictionLaw::kCoulomb) UpdateFriction(st, k, x, road_force, false, sw);
  return sw;
}

/// Advances `x` from t by h. `step(x, t, since, h, slip)` returns the state after one step of
/// length h from t + since (scalars of type S, so that tangents know how an event moves); `force(t,
/// since)` is the road force; `on_accept(until, slip)` is told of every piece that is kept, by its
/// end since t. Returns false when switching does not come to an end.
template <class S, class Step, class Force, class OnAccept>
bool AdvanceThroughEvents(const Structure& st, const Constants<S>& k, double t, double h_total,
                          State<S>& x, Switches<S>& sw, const Step& step, const Force& force,
                          const OnAccept& on_accept) {
  using math::Any;
  S begin(0.0);  // since t
  bool hold = false;
  int at_once = 0;  // friction events in a row without time between them
  for (int events = 0; events < 200; ++events) {
    const S rest = h_total - begin;
    const auto value = [&](const State<S>& at, const S& h, int i) {
      return CalcSwitch(st, k, at, force(t, begin + h), sw.slip, i);
    };
    const auto crossed = [&](const S& g, int i) { return Any(g > S(0.0)) != sw.positive[i]; };
    const State<S> trial = step(x, t, begin, rest, sw.slip);
    for (int i = 0; i < kCoordinates; ++i) {
      if (!Any(trial.v[i] - trial.v[i] == S(0.0))) {  // diverged: the caller will say so
        x = trial;
        return true;
      }
    }
    // The earliest crossing wins; each candidate shortens the interval.
    int which = -1;
    S found = rest;
    State<S> found_state = trial;
    for (int i = 0; i < kSwitches; ++i) {
      if (!IsSwitchUsed(st, i) || (hold && i == kFrictionSwitch)) continue;
      S g_high = value(found_state, found, i);
      // A rack that has just come to rest and broken away starts at exactly zero speed; only a
      // speed beyond zero is a crossing.
      if (i == kFrictionSwitch && Any(g_high == S(0.0))) continue;
      if (!crossed(g_high, i)) continue;
      S low(0.0), high = found;
      S g_low = value(x, S(0.0), i);
      if (crossed(g_low, i)) g_low = S(0.0);
      State<S> high_state = found_state;
      // Illinois: a bracket that always holds the crossing, superlinear.
      int kept = 0;
      for (int n = 0; n < 60; ++n) {
        const S width = high - low;
        if (!Any(width > S(1e-15))) break;
        S at = high - g_high * (width / (g_high - g_low));
        if (!Any(at > low) || !Any(at < high)) at = low + 0.5 * width;
        const State<S> state = step(x, t, begin, at, sw.slip);
        const S g = value(state, at, i);
        if (crossed(g, i)) {
          high = at;
          g_high = g;
          high_state = state;
          if (kept == 1) g_low = 0.5 * g_low;
          kept = 1;
        } else {
          low = at;
          g_low = g;
          if (kept == -1) g_high = 0.5 * g_high;
          kept = -1;
        }
      }
      which = i;
      found = high;
      found_state = high_state;
    }
    on_accept(begin + found, sw.slip);
    if (which < 0) {
      x = trial;
      return true;
    }
    x = found_state;
    begin = begin + found;
    if (which == kFrictionSwitch) {
      const bool slid = !Any(sw.slip == S(0.0));
      if (slid) x.v[3] = S(0.0);
      UpdateFriction(st, k, x, force(t, begin), !slid, sw);
      // A push that only just touches the limit: broken away and back at once. Held to the end of
      // the step. A single break-away at once is none of these: a jump of the rod's damper at the
      // end of its free play can push beyond the limit from one moment to the next.
      at_once = Any(found > S(1e-12)) ? 0 : at_once + 1;
      if (at_once > 1) {
        sw.slip = S(0.0);
        hold = true;
      }
    } else {
      sw.positive[which] = !sw.positive[which];
    }
    if (!Any(h_total - begin > S(1e-14))) return true;
  }
  return false;
}

}  // namespace kingpin::planar
