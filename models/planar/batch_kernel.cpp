#include "models/planar/batch_kernel.h"

#include "models/planar/lane_run.h"

namespace kingpin::planar {
namespace {

template <class S, int N>
void RunJob(const LaneJob& job) {
  if constexpr (N == 1) {
    if (job.structure->has_events()) {
      RunEventsJob<S>(job);
      return;
    }
  }
  if (job.adams_step > 0) {
    RunAdamsJob<S, N>(job);
  } else {
    RunRungeKuttaJob<S, N>(job);
  }
}

}  // namespace

LaneKernels GetLaneKernels(Isa) {
  constexpr int N = Isa::kLanes;
  return {N, &RunJob<Lanes<N>, N>, &RunJob<Lanes<1>, 1>, &RunJob<DualLanes<N>, N>,
          &RunJob<DualLanes<1>, 1>};
}

}  // namespace kingpin::planar
