#pragma once

#include "models/planar/exponential_adams.h"
#include "models/planar/exponential_runge_kutta.h"
#include "models/planar/lane_run.h"

// For `*_kernel.cpp` only, as lane_run.h.
namespace kingpin::planar {

/// A run by the multistep method.
template <class S, int N>
class AdamsRun : public LaneRun<S, N> {
 public:
  explicit AdamsRun(const LaneJob& job) : LaneRun<S, N>(job) {
    for (auto& r : history_.ring) r = Remainder<S>{};
    for (int i = 0; i < kCoordinates; ++i) error_[i] = S(0.0);
    rod_ = MakeRodMode(st_, k_, false);
    MakeAdamsWeights(rod_, job.adams_step, adams_);
  }

  void Run() {
    if (!IsPlain(st_)) {
      RunSteps(st_);
    } else if (kParts<S> == 1 && st_.is_bare) {
      if constexpr (kParts<S> == 1) RunSteps(PlainStructure<true>(st_));
    } else {
      // A derivative may be what is not zero.
      RunSteps(PlainStructure<false>(st_));
    }
    WriteError();
  }

 private:
  using LaneRun<S, N>::job_;
  using LaneRun<S, N>::st_;
  using LaneRun<S, N>::k_;
  using LaneRun<S, N>::x_;
  using LaneRun<S, N>::fastest_;

  template <class St>
  [[gnu::noinline]] void RunSteps(const St& st) {
    int sample = job_.first_sample;
    for (int i = 0; i < job_.step_count; ++i) {
      const ScheduleStep& step = job_.steps[i];
      if (step.kind == StepKind::kAdams) {
        AdamsEnd<S> end;
        StepAdams(st, k_, rod_, adams_, step.force[2], curves_, history_, x_, error_, end);
        this->rod_force_ = end.rod_force;
        this->rod_direction_y_ = end.rod_direction_y;
      } else {
        OneStep(step);
        if (step.sample) this->UpdateEnd(step.force[2]);
      }
      if (!step.sample) continue;
      ++sample;
      this->WriteSample(sample);
      if (!this->CheckLanes(sample)) break;  // every lane has diverged
    }
  }

  void OneStep(const ScheduleStep& step) {
    OneStepWeights<S, double>& w = 4 * step.h == job_.adams_step ? part_weights_ : odd_weights_;
    history_.rod_known = false;
    if (w.h != step.h) MakeOneStepWeights(rod_, step.h, w);
    StepOneStep(st_, k_, rod_, w, step.force[0], step.force[1], step.force[2], S(0.0), x_);
    if (step.kind == StepKind::kOneStepRemembered) {
      EvaluateRemainder(st_, k_, rod_, x_, step.force[2], S(0.0), history_.Push());
    }
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

  RodMode<S> rod_;
  AdamsWeights<S> adams_;
  OneStepWeights<S, double> part_weights_{}, odd_weights_{};
  AdamsHistory<S> history_;
  PieceCurves<S, N> curves_;
  S error_[kCoordinates];
};

template <class S, int N>
void RunAdamsJob(const LaneJob& job) {
  AdamsRun<S, N>(job).Run();
}

}  // namespace kingpin::planar
