#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace kingpin {

/// A small pool of threads that works through numbered blocks.
///
/// Which worker takes which block is decided at run time by an atomic counter; what a block
/// computes and where it writes must depend on its number alone. Results are then the same bit for
/// bit with any number of threads. Each worker has a number in [0, threads), so that a caller can
/// keep one workspace per worker and need no lock. The calling thread is worker 0.
///
/// The hand-over is quick: a worker looks for new work for some microseconds before it sleeps, and
/// one that the operating system does not let run in time is not waited for: the others do its
/// blocks.
class ParallelBatch {
 public:
  using Task = std::function<void(std::size_t block, int worker)>;

  /// `threads` <= 0 means one per core that this process may use.
  explicit ParallelBatch(int threads = 0);
  ~ParallelBatch();
  ParallelBatch(const ParallelBatch&) = delete;
  ParallelBatch& operator=(const ParallelBatch&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Runs `task(block, worker)` for every block in [0, blocks) and returns when all are done.
  /// When tasks throw, the blocks not yet started are dropped and, of the exceptions thrown, the
  /// one of the lowest block is thrown here. Not to be called from a task, nor by two threads at
  /// once.
  void Run(std::size_t blocks, const Task& task);

 private:
  void Work(int worker);
  void TakeBlocks(int worker);

  std::vector<std::jthread> workers_;
  std::mutex mutex_;
  std::condition_variable wake_;
  // One word, so that a worker can join a round only while it is open: number of the round (upper
  // 32 bits), open flag, number of workers in it (lower 16 bits).
  std::atomic<std::uint64_t> round_{0};
  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> next_{0};
  std::size_t blocks_ = 0;
  const Task* task_ = nullptr;
  std::mutex error_mutex_;
  std::size_t error_block_ = 0;
  std::exception_ptr error_;
};

}  // namespace kingpin
