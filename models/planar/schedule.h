#pragma once

#include <vector>

#include "models/planar/excitation.h"

namespace kingpin::planar {

enum class StepKind : unsigned char {
  kRungeKutta4,
  kAdams,
  kOneStep,            ///< exponential Runge-Kutta, not on the grid of the multistep method
  kOneStepRemembered,  ///< the same, ending on that grid: the remainder at its end joins the
                       ///< history
};

/// One step, the same for all lanes.
struct ScheduleStep {
  double t, h;      ///< begin and length [s]
  double force[3];  ///< road force at its beginning, middle and end [N]
  StepKind kind;
  bool sample;  ///< an output sample lies at its end
};

/// The steps of a run, made once for all designs of a batch. Steps end at every sample and at the
/// excitation's kinks.
struct Schedule {
  std::vector<ScheduleStep> steps;
  int samples = 0;        ///< with both ends
  int first_sample = 0;   ///< the last one before anything moves; everything is zero up to it
  double adams_step = 0;  ///< [s]
};

/// Classical Runge-Kutta steps of at most `step`.
Schedule MakeRungeKuttaSchedule(const Excitation& excitation, double duration,
                                double sample_interval, double step);

/// Multistep with steps of at most `step`; after a kink below the third derivative of the
/// excitation it is started anew by one-step steps of a quarter of that.
Schedule MakeAdamsSchedule(const Excitation& excitation, double duration, double sample_interval,
                           double step);

/// One-step exponential steps of at most `step` throughout.
Schedule MakeOneStepSchedule(const Excitation& excitation, double duration, double sample_interval,
                             double step);

}  // namespace kingpin::planar
