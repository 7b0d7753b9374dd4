#pragma once

#include <string_view>

/// Instruction sets that the lane-parallel kernels are compiled for, and the run-time choice
/// between them.
///
/// A kernel source (`*_kernel.cpp`) is compiled once per instruction set. Every template it
/// instantiates carries the tag type of that set (through `Pack<T, N, Isa>`), so that the linker
/// can never replace code for one machine by code for another.
namespace kingpin::isa {

struct Portable {
  static constexpr int kLanes = 2;  ///< doubles in one register
};
struct Avx2 {
  static constexpr int kLanes = 4;
};
struct Avx512 {
  static constexpr int kLanes = 8;
};

enum class Level { kPortable, kAvx2, kAvx512 };

/// The best level that this machine has. The environment variable KINGPIN_ISA (portable, avx2,
/// avx512) lowers it, for tests and for comparing machines; a level that the machine lacks is never
/// chosen.
Level DetectLevel();

std::string_view ToString(Level level);

}  // namespace kingpin::isa
