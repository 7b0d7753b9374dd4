#include <cstring>
#include <thread>

#include <gtest/gtest.h>

#include "core/solve/simulate.h"
#include "tests/joints/sample_mechanisms.h"

namespace kingpin::joints {
namespace {

using solve::Method;

// Every number that a run gives, in order.
std::vector<double> Record(const Mechanism& mechanism, Method method) {
  solve::SimulationOptions options;
  options.stepper.method = method;
  options.stepper.step = 1e-3;
  options.duration = 0.5;
  options.sample_interval = 0.01;
  std::vector<double> y = mechanism.start, all;
  const solve::Ledger ledger = Simulate(
      mechanism.system, options, y, [&](double time, auto state, mechanism::Evaluator& evaluator) {
        all.push_back(time);
        all.insert(all.end(), state.begin(), state.end());
        const auto a = evaluator.accelerations(), R = evaluator.reactions();
        all.insert(all.end(), a.begin(), a.end());
        all.insert(all.end(), R.begin(), R.end());
      });
  all.insert(all.end(), {ledger.energy_start, ledger.energy_end, ledger.dissipated, ledger.supplied,
                         ledger.largest_energy_error, ledger.largest_position_residual,
                         ledger.largest_velocity_residual, static_cast<double>(ledger.steps)});
  return all;
}

bool AreSameBits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

constexpr Method kMethods[] = {Method::kRungeKutta4, Method::kRosenbrock, Method::kExplicit8,
                               Method::kBdf};

TEST(Repeats, AreBitIdentical) {
  for (auto make : {MakeSampleTree, MakeSampleLoop, MakeSampleFriction, MakeSampleForces}) {
    const Mechanism first = make(), second = make();  // compiled twice, too
    for (Method method : kMethods) {
      const std::vector<double> once = Record(first, method);
      EXPECT_TRUE(AreSameBits(once, Record(first, method))) << first.system.name;
      EXPECT_TRUE(AreSameBits(once, Record(second, method))) << first.system.name;
      EXPECT_GT(once.size(), 100);
    }
  }
}

TEST(Repeats, ThreadsThatShareAModelGetTheBitsOfOneAlone) {
  const Mechanism mechanisms[] = {MakeSampleTree(), MakeSampleLoop(), MakeSampleFriction(),
                                  MakeSampleForces()};
  constexpr int kThreads = 8;
  for (const Mechanism& mechanism : mechanisms) {
    std::vector<std::vector<double>> alone, together(kThreads);
    for (Method method : kMethods) alone.push_back(Record(mechanism, method));
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] { together[t] = Record(mechanism, kMethods[t % 4]); });
    }
    for (std::thread& thread : threads) thread.join();
    for (int t = 0; t < kThreads; ++t) {
      EXPECT_TRUE(AreSameBits(alone[t % 4], together[t])) << mechanism.system.name << ' ' << t;
    }
  }
}

}  // namespace
}  // namespace kingpin::joints
