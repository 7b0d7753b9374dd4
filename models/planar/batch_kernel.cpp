#include "models/planar/batch_kernel.h"

#include <type_traits>

#include "core/math/dual.h"
#include "core/math/pack.h"
#include "models/planar/events.h"
#include "models/planar/exponential_adams.h"
#include "models/planar/exponential_runge_kutta.h"
#include "models/planar/runge_kutta.h"

// Compiled once per instruction set. Nothing here may leave a symbol without its tag: only
// templates on tagged types, and no containers.
namespace kingpin::planar {
namespace {

using Isa = isa::KINGPIN_ISA;

template <int N>
using Lanes = math::Pack<double, N, Isa>;
template <int N>
using DualLanes = math::Dual<Lanes<N>, 1>;

template <class S>
inline constexpr int kParts = 1;
template <int N>
inline constexpr int kParts<DualLanes<N>> = 2;

template <int N>
void Assemble(const double* parts, Lanes<N>& to) {
  to = Lanes<N>::Load(parts);
}
template <int N>
void Assemble(const double* parts, DualLanes<N>& to) {
  to.v = Lanes<N>::Load(parts);
  to.d[0] = Lanes<N>::Load(parts + N);
}
template <int N>
KINGPIN_INLINE void Store(const Lanes<N>& from, double* to) {
  from.Store(to);
}
template <int N>
KINGPIN_INLINE void Store(const DualLanes<N>& from, double* to) {
  from.v.Store(to);
  from.d[0].Store(to + N);
}

template <class S, int N>
void LoadConstants(const double* const* from, Constants<S>& to) {
  constexpr int kCount = static_cast<int>(sizeof(Constants<double>) / sizeof(double));
  static_assert(sizeof(Constants<S>) == kCount * sizeof(S));
  static_assert(std::is_trivially_copyable_v<Constants<S>>);
  unsigned char* out = reinterpret_cast<unsigned char*>(&to);
  for (int i = 0; i < kCount; ++i) {
    double parts[kParts<S> * N];
    for (int part = 0; part < kParts<S>; ++part) {
      for (int lane = 0; lane < N; ++lane) {
        parts[part * N + lane] = from[lane][i * kParts<S> + part];
      }
    }
    S value;
    Assemble<N>(parts, value);
    __builtin_memcpy(out + i * sizeof(S), &value, sizeof(S));
  }
}

template <class S, int N>
class LaneRun {
 public:
  explicit LaneRun(const LaneJob& job) : job_(job), st_(*job.structure) {
    LoadConstants<S, N>(job.constants, k_);
    x_ = State<S>{};
    for (auto& r : history_.ring) r = Remainder<S>{};
    for (int i = 0; i < kCoordinates; ++i) error_[i] = fastest_[i] = S(0.0);
    rod_ = MakeRodMode(st_, k_, false);
    for (int lane = 0; lane < N; ++lane) job.failed_sample[lane] = -1;
  }

  void Run() {
    for (int i = 0; i <= job_.first_sample; ++i) WriteSample(i);
    if (job_.adams_step > 0) MakeAdamsWeights(rod_, job_.adams_step, adams_);
    int sample = job_.first_sample;
    for (int i = 0; i < job_.step_count; ++i) {
      const ScheduleStep& step = job_.steps[i];
      bool from_adams = false;
      switch (step.kind) {
        case StepKind::kRungeKutta4: {
          Ledger<S> unused;
          StepRungeKutta4<false>(st_, k_, S(step.h), step.force[0], step.force[1], step.force[2],
                                 S(0.0), x_, unused);
          break;
        }
        case StepKind::kAdams:
          StepAdams(st_, k_, rod_, adams_, step.force[2], history_, x_, error_, end_);
          from_adams = true;
          break;
        case StepKind::kOneStep:
        case StepKind::kOneStepRemembered:
          OneStep(step);
          break;
      }
      if (!step.sample) continue;
      ++sample;
      if (!from_adams) UpdateEnd(step.force[2]);
      WriteSample(sample);
      if (!CheckLanes(sample)) {
        // Every lane has diverged.
        break;
      }
    }
    WriteError();
  }

  /// One design whose forces switch.
  void RunWithEvents() {
    for (int i = 0; i <= job_.first_sample; ++i) WriteSample(i);
    const Excitation& excitation = *job_.excitation;
    held_rod_ = MakeRodMode(st_, k_, true);
    const auto force = [&](double t, const S& since) -> S {
      const double at = t + First(since);
      const double f = excitation.CalcForce(at);
      if constexpr (kParts<S> == 1) {
        return S(f);
      } else {
        // The force moves with the event's time.
        S result(f);
        const double e = 1e-7;
        result.d[0] =
            since.d[0] *
            Lanes<N>((excitation.CalcForce(at + e) - excitation.CalcForce(at - e)) / (2 * e));
        return result;
      }
    };
    const bool exponential = job_.step_count > 0 && job_.steps[0].kind != StepKind::kRungeKutta4;
    const auto advance = [&](const State<S>& from, double t, const S& since, const S& h,
                             const S& slip) {
      State<S> x = from;
      const S f0 = force(t, since), f1 = force(t, since + 0.5 * h), f2 = force(t, since + h);
      if (exponential) {
        const bool held = st_.friction_law == FrictionLaw::kCoulomb && Any(slip == S(0.0));
        OneStepWeights<S, S>& w = held ? held_weights_ : event_weights_;
        const RodMode<S>& rod = held ? held_rod_ : rod_;
        if (!(held ? held_known_ : event_known_) || !Same(w.h, h)) {
          MakeOneStepWeights(rod, h, w);
          (held ? held_known_ : event_known_) = true;
        }
        StepOneStep(st_, k_, rod, w, f0, f1, f2, slip, x);
      } else {
        Ledger<S> unused;
        StepRungeKutta4<false>(st_, k_, h, f0, f1, f2, slip, x, unused);
      }
      return x;
    };
    const auto ignore = [](const S&, const S&) {};
    Switches<S> switches = MakeSwitches(st_, k_, x_, S(excitation.CalcForce(0)));
    int sample = job_.first_sample;
    for (int i = 0; i < job_.step_count; ++i) {
      const ScheduleStep& step = job_.steps[i];
      if (!AdvanceThroughEvents(st_, k_, step.t, step.h, x_, switches, advance, force, ignore)) {
        job_.failed_sample[0] = sample + 1;
        job_.failed_coordinate[0] = 3;
        break;
      }
      if (!step.sample) continue;
      ++sample;
      UpdateEnd(step.force[2]);
      WriteSample(sample);
      if (!CheckLanes(sample)) break;
    }
    for (int lane = 0; lane < N; ++lane) job_.error[lane] = __builtin_nan("");
  }

 private:
  static double First(const S& x) {
    if constexpr (kParts<S> == 1) {
      return x.get(0);
    } else {
      return x.v.get(0);
    }
  }
  static bool Same(const S& a, const S& b) {
    if constexpr (kParts<S> == 1) {
      return a.get(0) == b.get(0);
    } else {
      return a.v.get(0) == b.v.get(0) && a.d[0].get(0) == b.d[0].get(0);
    }
  }

  void OneStep(const ScheduleStep& step) {
    OneStepWeights<S, double>& w = 4 * step.h == job_.adams_step ? part_weights_ : odd_weights_;
    if (w.h != step.h) MakeOneStepWeights(rod_, step.h, w);
    StepOneStep(st_, k_, rod_, w, step.force[0], step.force[1], step.force[2], S(0.0), x_);
    if (step.kind == StepKind::kOneStepRemembered) {
      EvaluateRemainder(st_, k_, rod_, x_, step.force[2], S(0.0), history_.Push());
    }
  }

  void UpdateEnd(double force) {
    Dynamics<S> d;
    // The rod's force depends neither on the road's nor on friction's.
    CalcDynamics(st_, k_, x_, force, S(0.0), d);
    end_.rod_force = d.rod_force;
    end_.rod_direction_y = d.rod_direction_y;
  }

  void WriteSample(int index) {
    constexpr int kStride = kParts<S> * N;
    double* to = job_.samples + static_cast<long>(index) * kBatchSignals * kStride;
    if (index <= job_.first_sample) {
      for (int i = 0; i < kBatchSignals * kStride; ++i) to[i] = 0.0;
      return;
    }
    using math::Max;
    using math::Min;
    const S twist = x_.q[4] - k_.gear_ratio * x_.q[3];
    S torque = k_.column_stiffness * twist;
    if (st_.has_stops) {
      const S beyond = twist - Max(Min(twist, k_.stop_angle), -k_.stop_angle);
      torque = torque + (k_.stop_stiffness - k_.column_stiffness) * beyond;
    }
    torque = torque + k_.column_damping * (x_.v[4] - k_.gear_ratio * x_.v[3]);
    const S acceleration =
        (-torque - k_.hands_stiffness * x_.q[4] - k_.hands_damping * x_.v[4]) * k_.inverse_mass[4];
    Store<N>(acceleration * k_.rim_radius, to + kRimAcceleration * kStride);
    Store<N>(torque, to + kTorsionTorque * kStride);
    Store<N>(end_.rod_force, to + kTieRodForce * kStride);
    Store<N>(end_.rod_force * end_.rod_direction_y, to + kRackForce * kStride);
  }

  /// Notes lanes that have left all bounds; false when none is left.
  bool CheckLanes(int sample) {
    using math::Max;
    using math::Value;
    // Written so that NaN is out of bounds.
    const auto out_of_bounds = [&](int i) {
      const auto fast = !(Value(Abs(x_.v[i])) < Value(S(1e6)));
      const auto far = !(Value(Abs(x_.q[i])) < Value(S(1e3)));
      return fast | far;
    };
    auto bad = out_of_bounds(0);
    for (int i = 0; i < kCoordinates; ++i) {
      bad = bad | out_of_bounds(i);
      fastest_[i] = Max(fastest_[i], Abs(x_.v[i]));
    }
    if (__builtin_expect(!Any(bad), 1)) return true;
    bool all = true;
    for (int lane = 0; lane < N; ++lane) {
      if (!bad.get(lane)) {
        all = false;
        continue;
      }
      if (job_.failed_sample[lane] >= 0) continue;
      job_.failed_sample[lane] = sample;
      for (int i = kCoordinates - 1; i >= 0; --i) {
        if (out_of_bounds(i).get(lane)) job_.failed_coordinate[lane] = i;
      }
    }
    return !all;
  }

  void WriteError() {
    using math::Max;
    using math::Value;
    Lanes<N> worst(0.0);
    for (int i = 0; i < kCoordinates; ++i) {
      const Lanes<N> scale = Max(Value(fastest_[i]), Lanes<N>(1e-300));
      worst = Max(worst, Value(error_[i]) / scale);
    }
    (worst * Lanes<N>(kAdamsErrorConstant * job_.adams_step)).Store(job_.error);
  }

  const LaneJob& job_;
  const Structure st_;
  Constants<S> k_;
  State<S> x_;
  RodMode<S> rod_, held_rod_;
  AdamsWeights<S> adams_;
  OneStepWeights<S, double> part_weights_{}, odd_weights_{};
  OneStepWeights<S, S> event_weights_{}, held_weights_{};
  bool event_known_ = false, held_known_ = false;
  AdamsHistory<S> history_;
  AdamsEnd<S> end_{};
  S error_[kCoordinates], fastest_[kCoordinates];
};

template <class S, int N>
void RunJob(const LaneJob& job) {
  LaneRun<S, N> run(job);
  if constexpr (N == 1) {
    if (job.structure->has_events()) {
      run.RunWithEvents();
      return;
    }
  }
  run.Run();
}

}  // namespace

LaneKernels GetLaneKernels(Isa) {
  constexpr int N = Isa::kLanes;
  return {N, &RunJob<Lanes<N>, N>, &RunJob<Lanes<1>, 1>, &RunJob<DualLanes<N>, N>,
          &RunJob<DualLanes<1>, 1>};
}

}  // namespace kingpin::planar
