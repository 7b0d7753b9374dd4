#include "optimisation/study/design_evaluator.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/io/error.h"
#include "models/planar/batch.h"
#include "models/planar/simulate.h"
#include "models/planar/validate.h"

namespace kingpin::study {
namespace {

using measures::Gammas;
using planar::BatchSignal;

/// Designs of one simulation call: two packs of the widest registers, so that a block keeps the
/// lanes full.
constexpr std::size_t kBlock = 16;

std::size_t CountSamples(double duration, double sample_interval) {
  return static_cast<std::size_t>(
             planar::CalcSampleIntervals(duration, sample_interval, sample_interval)) +
         1;
}

Gammas<double> MakeFailed() {
  Gammas<double> failed;
  failed.fill(std::numeric_limits<double>::quiet_NaN());
  return failed;
}

bool MakesModel(const planar::Parameters<double>& design) {
  try {
    planar::ValidateParameters(design);
    return true;
  } catch (const io::InputError&) {
    return false;
  }
}

}  // namespace

/// Scratch of one thread. One batch workspace per load case: each keeps the schedule of its
/// excitation.
struct DesignEvaluator::Worker {
  Worker(const measures::GammaPlan& plan, std::size_t loads) : gammas(plan), batch(loads) {}

  measures::GammaWorkspace gammas;
  std::vector<planar::BatchWorkspace> batch;
  planar::BatchResult result;
};

DesignEvaluator::DesignEvaluator(std::vector<WeightedLoad> loads, double duration,
                                 double sample_interval, measures::Conventions conventions,
                                 int threads)
    : loads_(std::move(loads)),
      duration_(duration),
      sample_interval_(sample_interval),
      plan_(CountSamples(duration, sample_interval), sample_interval, std::move(conventions)),
      pool_(threads) {
  for (const WeightedLoad& load : loads_) total_weight_ += load.weight;
  for (int i = 0; i < pool_.threads(); ++i) {
    workers_.push_back(std::make_unique<Worker>(plan_, loads_.size()));
  }
}

DesignEvaluator::~DesignEvaluator() = default;

void DesignEvaluator::Calc(std::span<const planar::Parameters<double>> designs,
                           std::span<Gammas<double>> gammas) {
  if (std::all_of(designs.begin(), designs.end(), MakesModel)) {
    CalcModels(designs, gammas);
    return;
  }
  std::vector<planar::Parameters<double>> models;
  std::copy_if(designs.begin(), designs.end(), std::back_inserter(models), MakesModel);
  std::vector<Gammas<double>> found(models.size());
  CalcModels(models, found);
  auto next = found.begin();
  for (std::size_t i = 0; i < designs.size(); ++i) {
    gammas[i] = MakesModel(designs[i]) ? *next++ : MakeFailed();
  }
}

void DesignEvaluator::CalcModels(std::span<const planar::Parameters<double>> designs,
                                 std::span<Gammas<double>> gammas) {
  planar::BatchOptions options;
  options.duration = duration_;
  options.sample_interval = sample_interval_;
  // Few designs are split finer, so that every thread has some; a design's result does not depend
  // on that.
  const auto threads = static_cast<std::size_t>(pool_.threads());
  const std::size_t block =
      std::clamp<std::size_t>((designs.size() * loads_.size() + threads - 1) / threads, 1, kBlock);
  const std::size_t blocks = (designs.size() + block - 1) / block;
  parts_.resize(designs.size() * loads_.size());
  pool_.Run(blocks * loads_.size(), [&](std::size_t task, int number) {
    Worker& worker = *workers_[static_cast<std::size_t>(number)];
    const std::size_t load = task / blocks;
    const std::size_t first = (task % blocks) * block;
    const std::size_t count = std::min(block, designs.size() - first);
    planar::SimulateBatch(designs.subspan(first, count), loads_[load].excitation, options,
                          worker.batch[load], worker.result);
    for (std::size_t i = 0; i < count; ++i) {
      const int design = static_cast<int>(i);
      parts_[load * designs.size() + first + i] =
          worker.result.outcome(design).failed
              ? MakeFailed()
              : worker.gammas.Update(worker.result.get(design, BatchSignal::kRimAcceleration));
    }
  });
  for (std::size_t i = 0; i < designs.size(); ++i) {
    gammas[i].fill(0.0);
    for (std::size_t load = 0; load < loads_.size(); ++load) {
      const double share = loads_[load].weight / total_weight_;
      for (int k = 0; k < measures::kMeasureCount; ++k) {
        gammas[i][k] += share * parts_[load * designs.size() + i][k];
      }
    }
  }
  simulations_ += static_cast<long>(designs.size() * loads_.size());
}

Gammas<double> DesignEvaluator::Calc(const planar::Parameters<double>& design) {
  Gammas<double> gammas;
  Calc({&design, 1}, {&gammas, 1});
  return gammas;
}

Gammas<double> DesignEvaluator::CalcWithDerivatives(std::span<const Tangent> tangents,
                                                    std::span<Gammas<double>> derivatives) {
  planar::BatchOptions options;
  options.duration = duration_;
  options.sample_interval = sample_interval_;
  const std::size_t block = kBlock / 2;
  const std::size_t blocks = (tangents.size() + block - 1) / block;
  std::vector<Gammas<double>> values(loads_.size());
  std::vector<Gammas<double>> slopes(loads_.size() * tangents.size());
  pool_.Run(blocks * loads_.size(), [&](std::size_t task, int number) {
    Worker& worker = *workers_[static_cast<std::size_t>(number)];
    const std::size_t load = task / blocks;
    const std::size_t first = (task % blocks) * block;
    const std::size_t count = std::min(block, tangents.size() - first);
    planar::SimulateTangents(tangents.subspan(first, count), loads_[load].excitation, options,
                             worker.batch[load], worker.result);
    if (worker.result.outcome(0).failed) {
      if (first == 0) values[load] = MakeFailed();
      std::fill_n(slopes.begin() + static_cast<std::ptrdiff_t>(load * tangents.size() + first),
                  count, MakeFailed());
      return;
    }
    // The record is the same for all directions; its adjoint serves them all.
    const Gammas<double> value =
        worker.gammas.UpdateWithGradient(worker.result.get(0, BatchSignal::kRimAcceleration));
    if (first == 0) values[load] = value;
    for (std::size_t i = 0; i < count; ++i) {
      const auto record =
          worker.result.get_derivative(static_cast<int>(i), BatchSignal::kRimAcceleration);
      for (int k = 0; k < measures::kMeasureCount; ++k) {
        const auto adjoint = worker.gammas.gradient(k);
        double sum = 0.0;
        for (std::size_t t = 0; t < record.size(); ++t) sum += adjoint[t] * record[t];
        slopes[load * tangents.size() + first + i][k] = sum;
      }
    }
  });
  Gammas<double> mean{};
  for (auto& derivative : derivatives) derivative.fill(0.0);
  for (std::size_t load = 0; load < loads_.size(); ++load) {
    const double share = loads_[load].weight / total_weight_;
    for (int k = 0; k < measures::kMeasureCount; ++k) {
      mean[k] += share * values[load][k];
      for (std::size_t i = 0; i < tangents.size(); ++i) {
        derivatives[i][k] += share * slopes[load * tangents.size() + i][k];
      }
    }
  }
  simulations_ += static_cast<long>(tangents.size() * loads_.size());
  return mean;
}

}  // namespace kingpin::study
