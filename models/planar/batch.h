#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math/dual.h"
#include "models/planar/batch_kernel.h"
#include "models/planar/excitation.h"
#include "models/planar/parameters.h"
#include "models/planar/schedule.h"
#include "models/planar/simulate.h"

/// Many designs under one excitation, side by side in SIMD lanes. The instruction set is chosen at
/// run time.
///
/// - A design's result is bit-identical whatever designs it is computed with, however many, and on
/// whichever thread.
/// - A design that diverges or meets NaN does not disturb the others; it is flagged.
/// - With the fast method every design carries an error estimate; where that exceeds `tolerance`
/// the design is repeated with half the step, up to six times, and fails when that is not enough.
/// Nothing becomes unstable unnoticed.
/// - Designs whose forces switch (set-valued friction, stops, free play) are run one by one, with
/// located events; the smoothed
///   friction of the paper sets, which is stiffer than any useful step, by RK4. Neither they nor
///   RK4 have an error estimate.
///
/// Thread use: inputs are immutable; each thread has its own BatchWorkspace and result.
namespace kingpin::planar {

struct BatchOptions {
  double duration = 1.0;          ///< [s]
  double sample_interval = 1e-3;  ///< [s]
  Method method = Method::kFast;
  double step = 0;  ///< largest step [s]; 0: 0.25 ms (fast), 0.2 ms (switching forces), 10 µs (RK4)
  /// Bound of the estimated relative error of the velocities (fast method). The estimate adds
  /// absolute local errors, so it lies well above the true error; see bench/README.md.
  double tolerance = 1.5e-4;
  /// One design after the other in scalar code instead of lanes (the same to rounding, not to the
  /// last bit).
  bool scalar = false;
};

/// What became of one design.
struct BatchOutcome {
  bool failed = false;
  double failure_time = 0;  ///< [s]; the duration when the error estimate stayed above its bound
  /// Index into kCoordinateNames; −1 when nothing diverged: no failure, or the error estimate's.
  int failure_coordinate = -1;
  /// Relative, of the velocities; NaN for designs that the fast method does not simulate.
  double error_estimate = 0;
  double step = 0;  ///< that was used [s]
};

/// Samples of a batch, both ends included. Memory is reused by the next batch of the same or a
/// smaller size.
class BatchResult {
 public:
  int designs() const { return static_cast<int>(outcomes_.size()); }
  int samples() const { return samples_; }
  /// One signal of one design, `samples()` long.
  std::span<const double> get(int design, BatchSignal signal) const;
  /// d(signal)/dx along the design's direction (SimulateTangents only).
  std::span<const double> get_derivative(int design, BatchSignal signal) const;
  const BatchOutcome& outcome(int design) const { return outcomes_[static_cast<size_t>(design)]; }

 private:
  friend class BatchWorkspace;
  int samples_ = 0;
  int parts_ = 1;
  std::vector<double> values_;  // [design][signal][part][sample]
  std::vector<BatchOutcome> outcomes_;
};

/// Scratch memory of one thread. Keeps the schedules of the last excitations (told apart by their
/// ids) and options, so that repeated batches under one excitation do not pay for it again.
class BatchWorkspace {
 public:
  BatchWorkspace();
  ~BatchWorkspace();
  BatchWorkspace(const BatchWorkspace&) = delete;
  BatchWorkspace& operator=(const BatchWorkspace&) = delete;

 private:
  friend void SimulateBatch(std::span<const Parameters<double>>, const Excitation&,
                            const BatchOptions&, BatchWorkspace&, BatchResult&);
  friend void SimulateTangents(std::span<const Parameters<math::Dual<double, 1>>>,
                               const Excitation&, const BatchOptions&, BatchWorkspace&,
                               BatchResult&);
  template <class T>
  void Run(std::span<const Parameters<T>> designs, const Excitation& excitation,
           const BatchOptions& options, BatchResult& result);

  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

/// Simulates every design. Throws io::InputError for options or parameters that make no run;
/// divergence is an outcome, not an exception.
void SimulateBatch(std::span<const Parameters<double>> designs, const Excitation& excitation,
                   const BatchOptions& options, BatchWorkspace& workspace, BatchResult& result);

/// Simulates designs together with the exact derivative of every sample along one direction each:
/// the derivative parts of the parameters. The gradient of n variables is n designs with equal
/// values and unit directions; 16 variables are two packs with AVX-512.
void SimulateTangents(std::span<const Parameters<math::Dual<double, 1>>> designs,
                      const Excitation& excitation, const BatchOptions& options,
                      BatchWorkspace& workspace, BatchResult& result);

}  // namespace kingpin::planar
