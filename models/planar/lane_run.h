#pragma once

#include <type_traits>

#include "core/math/dual.h"
#include "core/math/pack.h"
#include "models/planar/batch_kernel.h"
#include "models/planar/planar_forces.h"

// For `*_kernel.cpp` only, which are compiled once per instruction set. Nothing there may leave a
// symbol without its tag: only templates on tagged types, and no containers.
namespace kingpin::planar {

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

/// What the runs of a job by any method share: constants, state, samples, the watch over diverging
/// lanes.
template <class S, int N>
class LaneRun {
 public:
  explicit LaneRun(const LaneJob& job) : job_(job), st_(*job.structure) {
    LoadConstants<S, N>(job.constants, k_);
    x_ = State<S>{};
    for (int i = 0; i < kCoordinates; ++i) fastest_[i] = S(0.0);
    for (int lane = 0; lane < N; ++lane) {
      job.failed_sample[lane] = -1;
      job.error[lane] = __builtin_nan("");
    }
    for (int i = 0; i <= job_.first_sample; ++i) WriteSample(i);
  }

 protected:
  void UpdateEnd(double force) {
    Dynamics<S> d;
    // The rod's force depends neither on the road's nor on friction's.
    CalcDynamics(st_, k_, x_, force, S(0.0), d);
    rod_force_ = d.rod_force;
    rod_direction_y_ = d.rod_direction_y;
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
    Store<N>(rod_force_, to + kTieRodForce * kStride);
    Store<N>(rod_force_ * rod_direction_y_, to + kRackForce * kStride);
  }

  /// Notes lanes that have left all bounds; false when none is left.
  KINGPIN_INLINE bool CheckLanes(int sample) {
    using math::Max;
    using math::Value;
    // Written so that NaN is out of bounds: it makes the sums NaN.
    Lanes<N> fast(0.0), far(0.0);
    for (int i = 0; i < kCoordinates; ++i) {
      const S speed = Abs(x_.v[i]);
      fastest_[i] = Max(fastest_[i], speed);
      fast = fast + Value(speed);
      far = far + Abs(Value(x_.q[i]));
    }
    // Cheap first: a sum within the bound holds for each of its terms.
    if (__builtin_expect(All((fast < Lanes<N>(kFastest)) & (far < Lanes<N>(kFarthest))), 1)) {
      return true;
    }
    return NoteDiverged(sample);
  }

 private:
  static constexpr double kFastest = 1e6, kFarthest = 1e3;

  [[gnu::noinline]] bool NoteDiverged(int sample) {
    using math::Abs;
    using math::Value;
    bool all = true;
    for (int lane = 0; lane < N; ++lane) {
      int coordinate = -1;
      for (int i = kCoordinates - 1; i >= 0; --i) {
        if (!(Abs(GetLane(Value(x_.v[i]), lane)) < kFastest) ||
            !(Abs(GetLane(Value(x_.q[i]), lane)) < kFarthest)) {
          coordinate = i;
        }
      }
      if (coordinate < 0) {
        all = false;
      } else if (job_.failed_sample[lane] < 0) {
        job_.failed_sample[lane] = sample;
        job_.failed_coordinate[lane] = coordinate;
      }
    }
    return !all;
  }

 protected:
  const LaneJob& job_;
  const Structure st_;
  Constants<S> k_;
  State<S> x_;
  S rod_force_{}, rod_direction_y_{};  ///< at x_
  S fastest_[kCoordinates];
};

/// Runs a job by the classical Runge-Kutta method, the multistep method, or with located events
/// (one design); each defined and instantiated in its own source.
template <class S, int N>
void RunRungeKuttaJob(const LaneJob& job);
template <class S, int N>
void RunAdamsJob(const LaneJob& job);
template <class S>
void RunEventsJob(const LaneJob& job);

}  // namespace kingpin::planar
