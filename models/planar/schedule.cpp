#include "models/planar/schedule.h"

#include <algorithm>
#include <cmath>

#include "models/planar/simulate.h"

namespace kingpin::planar {
namespace {

class Builder {
 public:
  Builder(const Excitation& excitation, double duration, double sample_interval, double step)
      : excitation_(excitation), duration_(duration) {
    intervals_ = CalcSampleIntervals(duration, sample_interval, step);
    schedule_.samples = intervals_ + 1;
    const double rest = std::min(excitation.start(), duration) / duration * intervals_;
    schedule_.first_sample = std::clamp(static_cast<int>(std::floor(rest + 1e-9)), 0, intervals_);
  }

  double CalcTime(double index) const { return duration_ * index / intervals_; }

  /// Equal steps from t0 to t1.
  void AddSteps(double t0, double t1, int count, StepKind kind) {
    const double h = (t1 - t0) / count;
    for (int i = 0; i < count; ++i) AddStep(t0 + i * h, h, kind);
  }

  void AddStep(double t, double h, StepKind kind) {
    if (t != last_time_) last_force_ = excitation_.CalcForce(t);
    ScheduleStep step{};
    step.t = t;
    step.h = h;
    step.force[0] = last_force_;
    step.force[1] = kind == StepKind::kAdams ? 0.0 : excitation_.CalcForce(t + 0.5 * h);
    last_time_ = t + h;
    last_force_ = excitation_.CalcForce(last_time_);
    step.force[2] = last_force_;
    step.kind = kind;
    schedule_.steps.push_back(step);
  }

  /// Cut at all kinks, equal steps between.
  Schedule MakeUniform(double step, StepKind kind) {
    const std::vector<double> kinks = excitation_.MakeKinks(duration_);
    size_t next = 0;
    for (int i = schedule_.first_sample; i < intervals_; ++i) {
      double t = CalcTime(i);
      const double end = CalcTime(i + 1);
      const auto add = [&](double to) {
        if (to - t < 1e-12) return;
        AddSteps(t, to, std::max(1, static_cast<int>(std::ceil((to - t) / step - 1e-9))), kind);
        t = to;
      };
      while (next < kinks.size() && kinks[next] < end - 1e-12) add(kinks[next++]);
      add(end);
      schedule_.steps.back().sample = true;
    }
    return std::move(schedule_);
  }

  Schedule MakeAdams(double step) {
    const std::vector<double> kinks = excitation_.MakeStrongKinks(duration_);
    const int per_sample =
        std::max(1, static_cast<int>(std::ceil(duration_ / intervals_ / step - 1e-9)));
    const double h = duration_ / intervals_ / per_sample;
    schedule_.adams_step = h;
    constexpr int kOrder = 7;
    constexpr int kParts = 4;
    // Before a later start, zeros are the exact history; a force that acts at once has none.
    int remembered = excitation_.start() > 0 ? kOrder : 0;
    size_t next = 0;
    for (int i = schedule_.first_sample; i < intervals_; ++i) {
      for (int j = 0; j < per_sample; ++j) {
        double t = CalcTime(i + static_cast<double>(j) / per_sample);
        const double end = CalcTime(i + static_cast<double>(j + 1) / per_sample);
        const auto add = [&](double to) {
          if (to - t < 1e-12) return;
          const double part = h / kParts;
          AddSteps(t, to, std::max(1, static_cast<int>(std::ceil((to - t) / part - 1e-9))),
                   StepKind::kOneStep);
          t = to;
        };
        bool kink = false;
        while (next < kinks.size() && kinks[next] < end - 1e-12) {
          kink = true;
          add(kinks[next++]);
        }
        if (kink) remembered = 0;
        if (remembered >= kOrder) {
          AddStep(t, h, StepKind::kAdams);
        } else if (kink) {
          add(end);
          schedule_.steps.back().kind = StepKind::kOneStepRemembered;
          remembered = 1;
        } else {
          for (int part = 0; part < kParts; ++part) {
            AddStep(t + part * (h / kParts), h / kParts,
                    part + 1 < kParts ? StepKind::kOneStep : StepKind::kOneStepRemembered);
          }
          ++remembered;
        }
      }
      schedule_.steps.back().sample = true;
    }
    return std::move(schedule_);
  }

 private:
  const Excitation& excitation_;
  double duration_;
  int intervals_ = 0;
  Schedule schedule_;
  double last_time_ = -1, last_force_ = 0;
};

}  // namespace

Schedule MakeRungeKuttaSchedule(const Excitation& excitation, double duration,
                                double sample_interval, double step) {
  return Builder(excitation, duration, sample_interval, step)
      .MakeUniform(step, StepKind::kRungeKutta4);
}

Schedule MakeAdamsSchedule(const Excitation& excitation, double duration, double sample_interval,
                           double step) {
  return Builder(excitation, duration, sample_interval, step).MakeAdams(step);
}

Schedule MakeOneStepSchedule(const Excitation& excitation, double duration, double sample_interval,
                             double step) {
  return Builder(excitation, duration, sample_interval, step).MakeUniform(step, StepKind::kOneStep);
}

}  // namespace kingpin::planar
