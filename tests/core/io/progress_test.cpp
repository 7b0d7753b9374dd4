#include "core/io/progress.h"

#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace kingpin::io {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

// What was written into a pipe.
std::string Drain(int descriptor) {
  std::string text;
  char buffer[4096];
  ::fcntl(descriptor, F_SETFL, O_NONBLOCK);
  for (ssize_t count; (count = ::read(descriptor, buffer, sizeof(buffer))) > 0;) {
    text.append(buffer, static_cast<std::size_t>(count));
  }
  return text;
}

TEST(Progress, IsSilentWhenNotShown) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  {
    Progress progress(false, ends[1]);
    progress.Start("step 1", 10);
    progress.Advance();
    progress.Print("a line");
  }
  EXPECT_EQ(Drain(ends[0]), "");
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(Progress, ErasesItsLineAtTheEnd) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  {
    Progress progress(true, ends[1]);
    progress.Start("step 1", 10);
    progress.Print("an optimum");
  }
  const std::string text = Drain(ends[0]);
  EXPECT_THAT(text, HasSubstr("step 1: 0/10, 0 %"));
  EXPECT_THAT(text, HasSubstr("\r\x1b[Kan optimum\n"));
  EXPECT_THAT(text, EndsWith("\r\x1b[K"));
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(Progress, MayBeAdvancedFromManyThreads) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  {
    Progress progress(true, ends[1]);
    progress.Start("batch", 4000);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&progress] {
        for (int k = 0; k < 1000; ++k) progress.Advance();
      });
    }
    for (std::thread& thread : threads) thread.join();
    progress.Print("done");
    EXPECT_THAT(Drain(ends[0]), HasSubstr("batch: 4000/4000, 100 %"));
  }
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(Progress, IsNotWantedInAPipeOrWhenQuiet) {
  EXPECT_FALSE(IsProgressWanted(true));
  const int saved = ::dup(STDERR_FILENO);
  const int null = ::open("/dev/null", O_WRONLY);
  ::dup2(null, STDERR_FILENO);
  EXPECT_FALSE(IsProgressWanted(false));
  ::dup2(saved, STDERR_FILENO);
  ::close(saved);
  ::close(null);
}

TEST(Progress, DurationsAreReadable) {
  EXPECT_EQ(FormatDuration(2.06), "2.1 s");
  EXPECT_EQ(FormatDuration(59.96), "1 min 00 s");
  EXPECT_EQ(FormatDuration(185), "3 min 05 s");
  EXPECT_EQ(FormatDuration(3720), "1 h 02 min");
}

}  // namespace
}  // namespace kingpin::io
