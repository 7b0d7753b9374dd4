#include <chrono>
#include <cmath>
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

/// Time of one scalar evaluation [s]: the least of many short measurements.
double MeasureEvaluation(const Model& model, const std::vector<double>& q) {
  using Clock = std::chrono::steady_clock;
  const auto kernel = MakeLaneAccelerations(model, 1);
  std::vector<double> v(model.velocities, 0.1), force(model.velocities),
      acceleration(model.velocities), reaction(std::max(1, model.rows));
  const int repeats = std::max(1, 2000 / model.velocities);
  double least = 1;
  for (int measurement = 0; measurement < 200; ++measurement) {
    const auto start = Clock::now();
    for (int k = 0; k < repeats; ++k) {
      kernel->Calc(q.data(), v.data(), force.data(), acceleration.data(), reaction.data());
    }
    const std::chrono::duration<double> time = Clock::now() - start;
    least = std::min(least, time.count() / repeats);
  }
  return least;
}

/// How the cost of one evaluation grows along a chain of 10 to 1000 bodies: the slope of log(time)
/// over log(bodies), by least squares; 1 is linear.
void BM_GrowthAlongChain(benchmark::State& state, bool loops) {
  for (auto _ : state) {
    double x = 0, y = 0, xx = 0, xy = 0;
    const int sizes[] = {10, 30, 100, 300, 1000};
    for (int bodies : sizes) {
      std::vector<double> q;
      const double time = MeasureEvaluation(MakeChain(bodies, loops, q), q);
      state.counters["ns_per_body_" + std::to_string(bodies)] = 1e9 * time / bodies;
      const double lx = std::log(bodies), ly = std::log(time);
      x += lx / 5, y += ly / 5, xx += lx * lx / 5, xy += lx * ly / 5;
    }
    state.counters["slope"] = (xy - x * y) / (xx - x * x);
  }
}
BENCHMARK_CAPTURE(BM_GrowthAlongChain, open, false)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_GrowthAlongChain, loop_every_tenth_body, true)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kingpin::mechanism

BENCHMARK_MAIN();
