#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math/dual.h"
#include "core/parallel/parallel_batch.h"
#include "models/planar/excitation.h"
#include "models/planar/parameters.h"
#include "optimisation/measures/gammas.h"

/// Vibration measures of many designs at once: simulations in SIMD lanes, spread over threads.
namespace kingpin::study {

struct WeightedLoad {
  std::string name;
  double weight = 1.0;
  planar::Excitation excitation;
};

using Tangent = planar::Parameters<math::Dual<double, 1>>;

/// Γ_k of a design are the means over the load cases, weighted with their weights:
/// Γ_k = Σ_c w_c Γ_k,c / Σ_c w_c.
///
/// The measures of a design do not depend on the other designs of the batch nor on the number of
/// threads. Not to be used by two threads at once.
class DesignEvaluator {
 public:
  /// Throws io::InputError for options that make no simulation or no measure.
  DesignEvaluator(std::vector<WeightedLoad> loads, double duration, double sample_interval,
                  measures::Conventions conventions, int threads);
  ~DesignEvaluator();

  const std::vector<WeightedLoad>& loads() const { return loads_; }
  const measures::GammaPlan& plan() const { return plan_; }
  double duration() const { return duration_; }
  double sample_interval() const { return sample_interval_; }
  int threads() const { return pool_.threads(); }

  /// Measures of every design; NaN for a design that makes no model or diverges.
  void Calc(std::span<const planar::Parameters<double>> designs,
            std::span<measures::Gammas<double>> gammas);

  measures::Gammas<double> Calc(const planar::Parameters<double>& design);

  /// Measures of one design and their exact derivatives along each direction. All tangents have the
  /// same value and differ in direction.
  measures::Gammas<double> CalcWithDerivatives(std::span<const Tangent> tangents,
                                               std::span<measures::Gammas<double>> derivatives);

  long simulations() const { return simulations_; }

 private:
  struct Worker;

  /// As Calc, for designs that all make a model.
  void CalcModels(std::span<const planar::Parameters<double>> designs,
                  std::span<measures::Gammas<double>> gammas);

  std::vector<WeightedLoad> loads_;
  double total_weight_ = 0.0;
  double duration_;
  double sample_interval_;
  measures::GammaPlan plan_;
  ParallelBatch pool_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<measures::Gammas<double>> parts_;  // per block and design, before the mean
  long simulations_ = 0;
};

}  // namespace kingpin::study
