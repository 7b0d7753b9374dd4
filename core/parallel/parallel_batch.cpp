#include "core/parallel/parallel_batch.h"

#include <algorithm>
#include <utility>

#include <sched.h>

namespace kingpin {
namespace {

// About ten microseconds; longer than the gap between two batches of a search, far shorter than
// anything a user would notice as a busy core.
constexpr int kSpins = 4000;

constexpr std::uint64_t kOpen = std::uint64_t{1} << 16;
constexpr std::uint64_t kInside = kOpen - 1;

std::uint32_t GetNumber(std::uint64_t round) { return static_cast<std::uint32_t>(round >> 32); }

void Pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

int CountUsableCores() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

ParallelBatch::ParallelBatch(int threads) {
  const int count = threads > 0 ? threads : CountUsableCores();
  for (int worker = 1; worker < count; ++worker) {
    workers_.emplace_back([this, worker] { Work(worker); });
  }
}

ParallelBatch::~ParallelBatch() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
}

void ParallelBatch::Run(std::size_t blocks, const Task& task) {
  if (blocks == 0) return;
  if (workers_.empty() || blocks == 1) {
    for (std::size_t block = 0; block < blocks; ++block) task(block, 0);
    return;
  }
  task_ = &task;
  blocks_ = blocks;
  error_ = nullptr;
  next_.store(0);
  {
    const std::lock_guard lock(mutex_);
    const std::uint64_t number = GetNumber(round_.load()) + std::uint64_t{1};
    round_.store((number << 32) | kOpen);
  }
  wake_.notify_all();
  TakeBlocks(0);
  round_.fetch_and(~kOpen);
  for (int spin = 0; (round_.load() & kInside) != 0; ++spin) {
    if (spin < kSpins) {
      Pause();
    } else {
      std::this_thread::yield();
    }
  }
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void ParallelBatch::Work(int worker) {
  std::uint32_t seen = 0;
  const auto has_news = [&] { return stop_.load() || GetNumber(round_.load()) != seen; };
  while (true) {
    for (int spin = 0; spin < kSpins && !has_news(); ++spin) Pause();
    if (!has_news()) {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, has_news);
    }
    if (stop_.load()) return;
    std::uint64_t round = round_.load();
    bool inside = false;
    while ((round & kOpen) != 0 && !inside) {
      inside = round_.compare_exchange_weak(round, round + 1);
    }
    seen = GetNumber(round);
    if (!inside) continue;  // too late: everything has been taken
    TakeBlocks(worker);
    round_.fetch_sub(1);
  }
}

void ParallelBatch::TakeBlocks(int worker) {
  while (true) {
    const std::size_t block = next_.fetch_add(1);
    if (block >= blocks_) return;
    try {
      (*task_)(block, worker);
    } catch (...) {
      const std::lock_guard lock(error_mutex_);
      if (!error_ || block < error_block_) {
        error_ = std::current_exception();
        error_block_ = block;
      }
      next_.store(blocks_);
    }
  }
}

}  // namespace kingpin
