#include "models/planar/lane_run.h"
#include "models/planar/runge_kutta.h"

namespace kingpin::planar {
namespace {

template <class S, int N>
class RungeKuttaRun : public LaneRun<S, N> {
 public:
  using LaneRun<S, N>::LaneRun;

  void Run() {
    if constexpr (kParts<S> == 1) {
      if (IsPlain(st_)) {
        if (st_.is_bare) {
          RunPlain(PlainStructure<true>(st_));
        } else {
          RunPlain(PlainStructure<false>(st_));
        }
        return;
      }
    }
    RunSteps([&](const State<S>& at, double force, Dynamics<S>& d) {
      EvaluateStage(st_, k_, at, force, S(0.0), curves_, d);
    });
  }

 private:
  using LaneRun<S, N>::job_;
  using LaneRun<S, N>::st_;
  using LaneRun<S, N>::k_;
  using LaneRun<S, N>::x_;

  template <class St>
  [[gnu::noinline]] void RunPlain(const St& st) {
    RunSteps([&](const State<S>& at, double force, Dynamics<S>& d) __attribute__((always_inline)) {
      Tangent<S> unused;
      CalcDynamics<false>(st, k_, at, force, S(0.0), curves_, d, unused);
    });
  }

  template <class Evaluate>
  KINGPIN_INLINE void RunSteps(const Evaluate& evaluate) {
    int sample = job_.first_sample;
    double h = 0;
    RungeKuttaWeights<S> w;
    State<S> x = x_;
    for (int i = 0; i < job_.step_count; ++i) {
      const ScheduleStep& step = job_.steps[i];
      if (step.h != h) {
        h = step.h;
        MakeRungeKuttaWeights(k_, S(h), w);
      }
      Ledger<S> unused;
      StepRungeKutta4<false>(
          w, st_.has_extra_states(),
          [&](const State<S>& at, int c, Dynamics<S>& d)
              __attribute__((always_inline)) { evaluate(at, step.force[c], d); },
          x, unused);
      if (!step.sample) continue;
      ++sample;
      x_ = x;
      this->UpdateEnd(step.force[2]);
      this->WriteSample(sample);
      if (!this->CheckLanes(sample)) break;  // every lane has diverged
    }
  }

  PieceCurves<S, N> curves_;
};

}  // namespace

template <class S, int N>
void RunRungeKuttaJob(const LaneJob& job) {
  RungeKuttaRun<S, N>(job).Run();
}

template void RunRungeKuttaJob<Lanes<Isa::kLanes>, Isa::kLanes>(const LaneJob&);
template void RunRungeKuttaJob<Lanes<1>, 1>(const LaneJob&);
template void RunRungeKuttaJob<DualLanes<Isa::kLanes>, Isa::kLanes>(const LaneJob&);
template void RunRungeKuttaJob<DualLanes<1>, 1>(const LaneJob&);

}  // namespace kingpin::planar
