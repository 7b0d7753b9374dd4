#pragma once

#include <memory>

#include "core/math/isa.h"
#include "core/mechanism/model.h"

namespace kingpin::mechanism {

/// Constrained accelerations of several states of one mechanism side by side in SIMD lanes (or of
/// one, with the machine's best instruction set). Owns its workspace: one per thread.
///
/// All arrays hold the lanes of one number next to each other: q[i * lanes + lane].
class LaneAccelerations {
 public:
  virtual ~LaneAccelerations();
  virtual int lanes() const = 0;

  /// @param q positions, v velocities, force generalised forces (applied along the coordinates)
  /// @param acceleration out: q̈
  /// @param reaction out: R, per row
  /// @returns whether the pivots were safe in every lane; if not, the result has lost digits, and
  /// SolveAccelerations
  ///     has to be asked for the lanes one by one
  virtual bool Calc(const double* q, const double* v, const double* force, double* acceleration,
                    double* reaction) = 0;
};

/// @param lanes 1, or 8: one register of AVX-512, or one after the other two of AVX2, four of the
/// portable set. `model` must outlive the kernel.
std::unique_ptr<LaneAccelerations> MakeLaneAccelerations(const Model& model, int lanes);

/// The same for a stated instruction set, which the machine must have.
std::unique_ptr<LaneAccelerations> MakeLaneAccelerations(const Model& model, int lanes,
                                                         isa::Portable);
std::unique_ptr<LaneAccelerations> MakeLaneAccelerations(const Model& model, int lanes, isa::Avx2);
std::unique_ptr<LaneAccelerations> MakeLaneAccelerations(const Model& model, int lanes,
                                                         isa::Avx512);

}  // namespace kingpin::mechanism
