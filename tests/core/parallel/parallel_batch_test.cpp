#include "core/parallel/parallel_batch.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace kingpin {
namespace {

TEST(ParallelBatch, EveryBlockIsDoneOnceAndResultsDoNotDependOnTheNumberOfThreads) {
  std::vector<double> reference;
  for (const int threads : {1, 2, 5}) {
    ParallelBatch pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (int round = 0; round < 200; ++round) {  // many rounds: the hand-over is what may go wrong
      std::vector<double> values(round % 37 + 1, 0.0);
      std::vector<int> per_worker(threads, 0);
      pool.Run(values.size(), [&](std::size_t block, int worker) {
        values[block] += std::sin(1.0 + static_cast<double>(block));
        ++per_worker[worker];
      });
      int total = 0;
      for (const int count : per_worker) total += count;
      ASSERT_EQ(total, static_cast<int>(values.size()));
      if (round == 199) {
        if (reference.empty()) reference = values;
        EXPECT_EQ(values, reference);
      }
    }
  }
}

TEST(ParallelBatch, AnExceptionComesOutAndThePoolCanBeUsedAgain) {
  ParallelBatch pool(3);
  for (int round = 0; round < 20; ++round) {
    try {
      pool.Run(16, [](std::size_t block, int) {
        if (block % 2 == 0) throw std::runtime_error("block " + std::to_string(block));
      });
      FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()), "block 0");  // taken first, so always the lowest thrown
    }
    int done = 0;
    std::vector<int> marks(8, 0);
    pool.Run(8, [&](std::size_t block, int) { marks[block] = 1; });
    for (const int mark : marks) done += mark;
    EXPECT_EQ(done, 8);
  }
}

TEST(ParallelBatch, NoBlocksIsNoWork) {
  ParallelBatch pool(2);
  pool.Run(0, [](std::size_t, int) { FAIL(); });
}

}  // namespace
}  // namespace kingpin
