#include "core/math/isa.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace kingpin::isa {

Level DetectLevel() {
  Level best = Level::kPortable;
  // The same sets of extensions as -march=x86-64-v3 and -march=x86-64-v4.
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi2")) {
    best = Level::kAvx2;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512cd")) {
      best = Level::kAvx512;
    }
  }
  const char* wanted = std::getenv("KINGPIN_ISA");
  if (wanted == nullptr) return best;
  for (Level level : {Level::kPortable, Level::kAvx2, Level::kAvx512}) {
    if (ToString(level) == wanted) return std::min(best, level);
  }
  return best;
}

std::string_view ToString(Level level) {
  switch (level) {
    case Level::kPortable:
      return "portable";
    case Level::kAvx2:
      return "avx2";
    case Level::kAvx512:
      return "avx512";
  }
  return "portable";
}

}  // namespace kingpin::isa
