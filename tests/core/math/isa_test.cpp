#include "core/math/isa.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace kingpin::isa {
namespace {

TEST(Isa, TheEnvironmentLowersTheLevelButNeverRaisesIt) {
  unsetenv("KINGPIN_ISA");
  const Level best = DetectLevel();
  setenv("KINGPIN_ISA", "portable", 1);
  EXPECT_EQ(DetectLevel(), Level::kPortable);
  setenv("KINGPIN_ISA", "avx512", 1);
  EXPECT_EQ(DetectLevel(), best);
  unsetenv("KINGPIN_ISA");
}

}  // namespace
}  // namespace kingpin::isa
