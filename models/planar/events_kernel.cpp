#include "models/planar/events.h"
#include "models/planar/exponential_runge_kutta.h"
#include "models/planar/lane_run.h"
#include "models/planar/runge_kutta.h"

namespace kingpin::planar {
namespace {

/// One design whose forces switch.
template <class S>
class EventsRun : public LaneRun<S, 1> {
 public:
  using LaneRun<S, 1>::LaneRun;

  void Run() {
    rod_ = MakeRodMode(st_, k_, false);
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
            Lanes<1>((excitation.CalcForce(at + e) - excitation.CalcForce(at - e)) / (2 * e));
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
      this->UpdateEnd(step.force[2]);
      this->WriteSample(sample);
      if (!this->CheckLanes(sample)) break;
    }
  }

 private:
  using LaneRun<S, 1>::job_;
  using LaneRun<S, 1>::st_;
  using LaneRun<S, 1>::k_;
  using LaneRun<S, 1>::x_;

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

  RodMode<S> rod_, held_rod_;
  OneStepWeights<S, S> event_weights_{}, held_weights_{};
  bool event_known_ = false, held_known_ = false;
};

}  // namespace

template <class S>
void RunEventsJob(const LaneJob& job) {
  EventsRun<S>(job).Run();
}

template void RunEventsJob<Lanes<1>>(const LaneJob&);
template void RunEventsJob<DualLanes<1>>(const LaneJob&);

}  // namespace kingpin::planar
