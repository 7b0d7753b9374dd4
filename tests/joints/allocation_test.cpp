#include <cerrno>
#include <cstdlib>

#include <gtest/gtest.h>
#include <malloc.h>

#include "core/mechanism/jacobian.h"
#include "core/solve/simulate.h"
#include "tests/joints/sample_mechanisms.h"

// The heap is watched where it begins, below operator new: Eigen takes memory from malloc directly.
// The sanitizers bring a malloc of their own, and there nothing is counted.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define KINGPIN_COUNTS_ALLOCATIONS
namespace {
thread_local long allocations = 0;
}
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* p, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void* malloc(size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) noexcept {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* p, size_t size) noexcept {
  ++allocations;
  return __libc_realloc(p, size);
}
void* memalign(size_t alignment, size_t size) noexcept {
  ++allocations;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** p, size_t alignment, size_t size) noexcept {
  ++allocations;
  *p = __libc_memalign(alignment, size);
  return *p == nullptr ? ENOMEM : 0;
}
}  // extern "C"
#else
namespace {
long allocations = 0;
}
#endif

namespace kingpin::joints {
namespace {

#ifdef KINGPIN_COUNTS_ALLOCATIONS
constexpr bool kCounts = true;
#else
constexpr bool kCounts = false;
#endif

struct Counted {
  long steps = 0, switches = 0, allocations = -1;
};

// From the second sample of a run to its last.
Counted CountInTimeLoop(const Mechanism& mechanism, solve::Method method, double step) {
  solve::SimulationOptions options;
  options.stepper.method = method;
  options.stepper.step = step;
  options.duration = 2;
  options.sample_interval = 0.01;
  options.kinks = {0.505, 1.0};
  std::vector<double> y = mechanism.start;
  long samples = 0, first = 0, last = 0;
  const solve::Ledger ledger =
      Simulate(mechanism.system, options, y, [&](double, auto, mechanism::Evaluator& evaluator) {
        evaluator.CalcJointWrenches();
        if (++samples == 2) first = allocations;
        last = allocations;
      });
  return {ledger.steps, ledger.switches, last - first};
}

TEST(Allocation, TheCountersCount) {
  if (!kCounts) GTEST_SKIP() << "the heap belongs to the sanitizer";
  const long before = allocations;
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(9, 9);
  const std::vector<double> numbers(9);
  EXPECT_EQ(allocations - before, 2) << matrix(0, 0) << numbers[0];
}

TEST(Allocation, NoneInTheTimeLoop) {
  if (!kCounts) GTEST_SKIP() << "the heap belongs to the sanitizer";
  const Mechanism mechanisms[] = {MakeSampleTree(), MakeSampleLoop(), MakeSampleFriction(),
                                  MakeSampleForces()};
  for (const Mechanism& mechanism : mechanisms) {
    for (solve::Method method : {solve::Method::kRungeKutta4, solve::Method::kRosenbrock}) {
      const Counted counted = CountInTimeLoop(mechanism, method, 1e-3);
      EXPECT_EQ(counted.allocations, 0)
          << mechanism.system.name << ", method " << static_cast<int>(method);
      EXPECT_GE(counted.steps, 2000);
      if (!mechanism.system.friction.empty()) {
        EXPECT_GT(counted.switches, 0);
      }
    }
  }
}

// The adaptive libraries take their memory when they begin.
TEST(Allocation, NoneInTheTimeLoopOfAdaptiveMethods) {
  if (!kCounts) GTEST_SKIP() << "the heap belongs to the sanitizer";
  const Mechanism mechanisms[] = {MakeSampleTree(), MakeSampleLoop(), MakeSampleForces()};
  for (const Mechanism& mechanism : mechanisms) {
    for (solve::Method method : {solve::Method::kExplicit8, solve::Method::kBdf}) {
      const Counted counted = CountInTimeLoop(mechanism, method, 0);
      EXPECT_EQ(counted.allocations, 0)
          << mechanism.system.name << ", method " << static_cast<int>(method);
      EXPECT_GT(counted.steps, 100);
    }
  }
}

TEST(Allocation, NoneInAnyEvaluation) {
  if (!kCounts) GTEST_SKIP() << "the heap belongs to the sanitizer";
  const Mechanism mechanisms[] = {MakeSampleTree(), MakeSampleLoop(), MakeSampleFriction(),
                                  MakeSampleForces()};
  for (const Mechanism& mechanism : mechanisms) {
    mechanism::Evaluator evaluator(mechanism.system);
    mechanism::JacobianEvaluator derivatives(mechanism.system);
    Eigen::MatrixXd jacobian(derivatives.rows(), derivatives.columns());
    std::vector<double> y = mechanism.start, rate(mechanism.system.size());
    const long before = allocations;
    evaluator.UpdateModes(0, y, 1e-9);
    evaluator.CalcRates(0, y, rate);
    evaluator.CalcEnergy(0, y);
    evaluator.CalcResiduals(0, y);
    evaluator.CalcJointWrenches();
    evaluator.Project(0, y, 1e-12, 0);
    derivatives.Calc(0, y, evaluator.workspace().active, jacobian);
    EXPECT_EQ(allocations - before, 0) << mechanism.system.name;
  }
}

}  // namespace
}  // namespace kingpin::joints
