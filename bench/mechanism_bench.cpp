#include <chrono>
#include <cmath>
#include <random>

#include <benchmark/benchmark.h>

#include "bench/benchmark_mechanisms.h"
#include "core/mechanism/accelerations.h"
#include "core/mechanism/inverse_dynamics.h"
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

/// Time of one call [s]: the least of many short measurements.
template <class Call>
double Measure(int repeats, const Call& call) {
  using Clock = std::chrono::steady_clock;
  double least = 1;
  for (int measurement = 0; measurement < 300; ++measurement) {
    const auto start = Clock::now();
    for (int k = 0; k < repeats; ++k) call();
    const std::chrono::duration<double> time = Clock::now() - start;
    least = std::min(least, time.count() / repeats);
  }
  return least;
}

/// Time of one evaluation per system [s].
double MeasureEvaluation(LaneAccelerations& kernel, const Model& model,
                         const std::vector<double>& q0) {
  const int lanes = kernel.lanes();
  std::vector<double> q, v(model.velocities * lanes, 0.1), force(model.velocities * lanes),
      acceleration(model.velocities * lanes), reaction(std::max(1, model.rows) * lanes);
  for (double x : q0) q.insert(q.end(), lanes, x);
  const double time = Measure(std::max(1, 1000 / model.velocities), [&] {
    kernel.Calc(q.data(), v.data(), force.data(), acceleration.data(), reaction.data());
  });
  return time / lanes;
}

/// Throughput of eight lanes over that of one, both with the same instruction set.
template <class Isa>
double MeasureGain(const Model& model, const std::vector<double>& q) {
  const auto one = MakeLaneAccelerations(model, 1, Isa{});
  const auto eight = MakeLaneAccelerations(model, 8, Isa{});
  return MeasureEvaluation(*one, model, q) / MeasureEvaluation(*eight, model, q);
}

/// The evaluation on plain numbers, compiled for any x86-64 machine: what simulations of one system
/// use [s].
double MeasurePlain(const Model& model, const std::vector<double>& q) {
  Workspace<double> w(model);
  const std::vector<double> v(model.velocities, 0.1), none(model.rows);
  std::vector<double> acceleration(model.velocities), reaction(model.rows);
  return Measure(30, [&] {
    UpdatePositions(model, q.data(), w);
    UpdateVelocities(model, v.data(), w);
    UpdateClosures(model, w);
    std::fill(w.f.begin(), w.f.end(), Wrench<double>{});
    SolveAccelerations(model, none, w, acceleration, reaction);
  });
}

void BM_LaneGain(benchmark::State& state, Maker make) {
  std::vector<double> q;
  const Model model = make(q);
  const isa::Level level = isa::DetectLevel();
  for (auto _ : state) {
    if (level == isa::Level::kAvx512) state.counters["avx512"] = MeasureGain<isa::Avx512>(model, q);
    if (level != isa::Level::kPortable) state.counters["avx2"] = MeasureGain<isa::Avx2>(model, q);
    state.counters["portable"] = MeasureGain<isa::Portable>(model, q);
    state.counters["best_over_plain"] =
        MeasurePlain(model, q) / MeasureEvaluation(*MakeLaneAccelerations(model, 8), model, q);
  }
}
BENCHMARK_CAPTURE(BM_LaneGain, vehicle, MakeBenchmarkVehicle)->Iterations(1);
BENCHMARK_CAPTURE(BM_LaneGain, humanoid, MakeHumanoid)->Iterations(1);

/// The recursions of a tree on plain numbers.
void BM_TreeRecursions(benchmark::State& state) {
  std::vector<double> q;
  const Model model = MakeHumanoid(q);
  Workspace<double> w(model);
  std::vector<double> v(model.velocities, 0.1), a(model.velocities, 0.2), tau(model.velocities);
  const auto update = [&] {
    UpdatePositions(model, q.data(), w);
    UpdateVelocities(model, v.data(), w);
    std::fill(w.f.begin(), w.f.end(), Wrench<double>{});
    benchmark::ClobberMemory();
  };
  for (auto _ : state) {
    state.counters["ns_inverse_dynamics"] = 1e9 * Measure(30, [&] {
                                              update();
                                              CalcInverseDynamics(model, a.data(), w, tau.data());
                                            });
    state.counters["ns_mass_matrix"] = 1e9 * Measure(30, [&] {
                                         update();
                                         AssembleEquations<double>(model, nullptr, w);
                                       });
  }
}
BENCHMARK(BM_TreeRecursions)->Iterations(1);

/// How the cost of one evaluation grows along a chain of 10 to 1000 bodies: the slope of log(time)
/// over log(bodies), by least squares; 1 is linear.
void BM_GrowthAlongChain(benchmark::State& state, bool loops) {
  for (auto _ : state) {
    double x = 0, y = 0, xx = 0, xy = 0, hundred = 1;
    const int sizes[] = {10, 30, 100, 300, 1000};
    for (int bodies : sizes) {
      std::vector<double> q;
      const Model model = MakeChain(bodies, loops, q);
      const double time = MeasureEvaluation(*MakeLaneAccelerations(model, 1), model, q);
      state.counters["ns_per_body_" + std::to_string(bodies)] = 1e9 * time / bodies;
      if (bodies == 100) hundred = time;
      if (bodies == 1000) state.counters["slope_from_100"] = std::log10(time / hundred);
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
