#include "core/parallel/parallel_batch.h"

#include <algorithm>

#include <sched.h>

namespace kingpin {
namespace {

// About ten microseconds; longer than the gap between two batches of a search, far shorter than
// anything a user would notice as a busy core.
constexpr int kSpins = 4000;

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
    generation_.fetch_add(1);
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
  busy_.store(static_cast<int>(workers_.size()));
  {
    const std::lock_guard lock(mutex_);
    generation_.fetch_add(1);
  }
  wake_.notify_all();
  TakeBlocks(0);
  for (int spin = 0; busy_.load() > 0; ++spin) {
    if (spin < kSpins) {
      Pause();
    } else {
      std::this_thread::yield();
    }
  }
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void ParallelBatch::Work(int worker) {
  unsigned seen = 0;
  while (true) {
    for (int spin = 0; spin < kSpins && generation_.load() == seen; ++spin) Pause();
    if (generation_.load() == seen) {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return generation_.load() != seen; });
    }
    if (stop_.load()) return;
    // Run() waits for every worker before it starts the next generation, so none is ever missed.
    ++seen;
    TakeBlocks(worker);
    busy_.fetch_sub(1);
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
