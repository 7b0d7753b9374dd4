#include <random>

#include <benchmark/benchmark.h>

#include "bench/benchmark_mechanisms.h"
#include "core/mechanism/lane_accelerations.h"

namespace kingpin::mechanism {
namespace {

using Maker = Model (*)(std::vector<double>& q);

Model MakeSpatial10(std::vector<double>& q) { return MakeSpatialFourBars(10, q); }
Model MakeSpatial40(std::vector<double>& q) { return MakeSpatialFourBars(40, q); }
Model MakePlanar10(std::vector<double>& q) { return MakePlanarFourBars(10, q); }

/// One constrained acceleration evaluation with reactions, per system; sixteen velocity states in
/// turn.
void BM_Accelerations(benchmark::State& state, Maker make) {
  constexpr int kStates = 16;
  const int lanes = static_cast<int>(state.range(0));
  std::vector<double> q0;
  const Model model = make(q0);
  const auto kernel = MakeLaneAccelerations(model, lanes);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> q(model.positions * lanes), force(model.velocities * lanes);
  std::vector<std::vector<double>> v(kStates, std::vector<double>(model.velocities * lanes));
  for (int i = 0; i < model.positions; ++i) {
    for (int lane = 0; lane < lanes; ++lane) q[i * lanes + lane] = q0[i];
  }
  for (auto& x : v) {
    for (double& value : x) value = normal(random);
  }
  std::vector<double> acceleration(model.velocities * lanes),
      reaction(std::max(1, model.rows) * lanes);
  bool safe = true;
  int k = 0;
  for (auto _ : state) {
    safe &= kernel->Calc(q.data(), v[k].data(), force.data(), acceleration.data(), reaction.data());
    k = (k + 1) % kStates;
    benchmark::DoNotOptimize(acceleration.data());
  }
  if (!safe) state.SkipWithError("a pivot was not safe");
  state.counters["us_per_system"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * lanes * 1e-6,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["flops_factor"] = 2.0 * static_cast<double>(model.pattern.operations());
}
BENCHMARK_CAPTURE(BM_Accelerations, vehicle, MakeBenchmarkVehicle)->Arg(1)->Arg(8);
BENCHMARK_CAPTURE(BM_Accelerations, spatial_four_bars_10, MakeSpatial10)->Arg(1)->Arg(8);
BENCHMARK_CAPTURE(BM_Accelerations, spatial_four_bars_40, MakeSpatial40)->Arg(1)->Arg(8);
BENCHMARK_CAPTURE(BM_Accelerations, planar_four_bars_10, MakePlanar10)->Arg(1)->Arg(8);
BENCHMARK_CAPTURE(BM_Accelerations, humanoid, MakeHumanoid)->Arg(1)->Arg(8);

}  // namespace
}  // namespace kingpin::mechanism

BENCHMARK_MAIN();
