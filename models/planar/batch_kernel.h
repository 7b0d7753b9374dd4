#pragma once

#include "core/math/isa.h"
#include "models/planar/planar_model.h"
#include "models/planar/schedule.h"

/// The boundary between the batch and its kernels, which are compiled once per instruction set:
/// plain pointers and numbers only.
namespace kingpin::planar {

/// The signals that a batch records, in this order.
enum BatchSignal { kRimAcceleration, kTorsionTorque, kTieRodForce, kRackForce, kBatchSignals };

/// One pack of designs.
struct LaneJob {
  const Structure* structure;
  /// Per lane: the constants as an array of double, or of (value, derivative) for tangents.
  const double* const* constants;
  const ScheduleStep* steps;
  int step_count;
  int first_sample;
  double adams_step;
  const Excitation* excitation;  ///< for designs whose forces switch
  /// [sample][signal][value, derivative][lane]
  double* samples;
  double* error;       ///< per lane: estimated relative error of the velocities; NaN: none
  int* failed_sample;  ///< per lane: where the state left all bounds; −1
  int* failed_coordinate;
};

struct LaneKernels {
  int lanes;
  void (*run)(const LaneJob&);           ///< `lanes` designs
  void (*run_one)(const LaneJob&);       ///< one design; also with switching forces
  void (*run_tangents)(const LaneJob&);  ///< `lanes` designs with one direction each
  void (*run_one_tangent)(const LaneJob&);
};

LaneKernels GetLaneKernels(isa::Portable);
LaneKernels GetLaneKernels(isa::Avx2);
LaneKernels GetLaneKernels(isa::Avx512);
/// Of the machine's instruction set.
LaneKernels GetLaneKernels();

}  // namespace kingpin::planar
