#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <time.h>

#include "models/planar/batch.h"
#include "models/planar/paper_set.h"

// One simulated second of the planar model, all four recorded signals at 1 ms. Counters:
//   ms_per_design   CPU time per simulated second and design
//   versus_rk4      how many times faster than scalar RK4 at h = 10 µs, measured before it in the
//   same run versus_paper    how many times faster than the paper's 55 ms
namespace kingpin::planar {
namespace {

double GetCpuTime() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Fixture {
  PaperSet set;
  Excitation excitation;
  std::vector<Parameters<double>> designs;  // eight, around the paper's four

  explicit Fixture(const std::string& name)
      : set(ReadPaperSet(std::string(KINGPIN_SOURCE_DIR) + "/examples/paper/set_" + name +
                         ".json")),
        excitation(set.pulses) {
    for (double by : {0.0, 0.003}) {
      for (const char* design :
           {"case1_initial", "case1_printed_opt", "case2_initial", "case2_printed_opt"}) {
        designs.push_back(set.designs.at(design).parameters);
        designs.back().rack_position += by;
      }
    }
  }
};

const Fixture& GetFixture(int index) {
  static const Fixture fixtures[] = {Fixture("A"), Fixture("B"), Fixture("C")};
  return fixtures[index];
}

double RunOnce(const Fixture& f, const BatchOptions& options, int count, BatchWorkspace& workspace,
               BatchResult& result) {
  const double begin = GetCpuTime();
  SimulateBatch(std::span(f.designs).first(static_cast<size_t>(count)), f.excitation, options,
                workspace, result);
  return (GetCpuTime() - begin) * 1e3 / count;
}

/// Scalar RK4 of this run, best of three.
double GetScalarRungeKutta() {
  static const double best = [] {
    BatchWorkspace workspace;
    BatchResult result;
    BatchOptions options;
    options.method = Method::kRungeKutta4;
    options.scalar = true;
    double least = 1e9;
    for (int i = 0; i < 3; ++i) {
      least = std::min(least, RunOnce(GetFixture(0), options, 1, workspace, result));
    }
    return least;
  }();
  return best;
}

void Report(benchmark::State& state, double ms) {
  state.counters["ms_per_design"] = ms;
  state.counters["versus_rk4"] = GetScalarRungeKutta() / ms;
  state.counters["versus_paper"] = 55.0 / ms;
}

void Run(benchmark::State& state, Method method, bool scalar) {
  const Fixture& f = GetFixture(static_cast<int>(state.range(0)));
  BatchWorkspace workspace;
  BatchResult result;
  BatchOptions options;
  options.method = method;
  options.scalar = scalar;
  double best = 1e9;
  for (auto _ : state) {
    best = std::min(best, RunOnce(f, options, scalar ? 1 : 8, workspace, result));
  }
  Report(state, best);
}

void FastLanes(benchmark::State& state) { Run(state, Method::kFast, false); }
void FastScalar(benchmark::State& state) { Run(state, Method::kFast, true); }
void RungeKuttaLanes(benchmark::State& state) { Run(state, Method::kRungeKutta4, false); }
void RungeKuttaScalar(benchmark::State& state) { Run(state, Method::kRungeKutta4, true); }

void FastTangents(benchmark::State& state) {
  using Dual = math::Dual<double, 1>;
  const Fixture& f = GetFixture(static_cast<int>(state.range(0)));
  std::vector<Parameters<Dual>> directions;
  for (int i = 0; i < 8; ++i) {
    directions.push_back(ConvertParameters<Dual>(f.designs[0], [](double x) { return Dual(x); }));
    directions.back().rack_position.d[0] = 1;
  }
  BatchWorkspace workspace;
  BatchResult result;
  double best = 1e9;
  for (auto _ : state) {
    const double begin = GetCpuTime();
    SimulateTangents(directions, f.excitation, {}, workspace, result);
    best = std::min(best, (GetCpuTime() - begin) * 1e3 / 8);
  }
  Report(state, best);
}

void CoulombScalar(benchmark::State& state) {
  const Fixture& f = GetFixture(static_cast<int>(state.range(0)));
  Parameters<double> p = f.designs[0];
  p.friction_law = FrictionLaw::kCoulomb;
  p.friction_coefficient = 0.08;
  p.friction_constant = 20;
  BatchWorkspace workspace;
  BatchResult result;
  double best = 1e9;
  for (auto _ : state) {
    const double begin = GetCpuTime();
    SimulateBatch(std::span(&p, 1), f.excitation, {}, workspace, result);
    best = std::min(best, (GetCpuTime() - begin) * 1e3);
  }
  Report(state, best);
}

// The argument is the paper set: 0 = A, 1 = B, 2 = C.
BENCHMARK(RungeKuttaScalar)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(RungeKuttaLanes)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(FastScalar)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(FastLanes)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(FastTangents)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(CoulombScalar)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kingpin::planar

BENCHMARK_MAIN();
