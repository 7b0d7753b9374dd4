#include "models/planar/batch.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "models/planar/validate.h"

namespace kingpin::planar {
namespace {

using Dual = math::Dual<double, 1>;

enum class Path { kLanes, kSwitching, kRungeKutta };

Path ChoosePath(const Structure& structure, Method method) {
  if (structure.has_events()) return Path::kSwitching;
  if (method == Method::kRungeKutta4 || structure.friction_law == FrictionLaw::kSmoothed) {
    return Path::kRungeKutta;
  }
  return Path::kLanes;
}

}  // namespace

LaneKernels GetLaneKernels() {
  switch (isa::DetectLevel()) {
    case isa::Level::kAvx512:
      return GetLaneKernels(isa::Avx512{});
    case isa::Level::kAvx2:
      return GetLaneKernels(isa::Avx2{});
    case isa::Level::kPortable:
      break;
  }
  return GetLaneKernels(isa::Portable{});
}

std::span<const double> BatchResult::get(int design, BatchSignal signal) const {
  const size_t n = static_cast<size_t>(samples_);
  const size_t row =
      (static_cast<size_t>(design) * kBatchSignals + signal) * static_cast<size_t>(parts_);
  return {values_.data() + row * n, n};
}

std::span<const double> BatchResult::get_derivative(int design, BatchSignal signal) const {
  if (parts_ < 2) return {};
  const size_t n = static_cast<size_t>(samples_);
  const size_t row = (static_cast<size_t>(design) * kBatchSignals + signal) * 2 + 1;
  return {values_.data() + row * n, n};
}

struct BatchWorkspace::Scratch {
  struct CachedSchedule {
    std::uint64_t excitation = 0;  // its id
    double duration = 0, sample_interval = 0, step = 0;
    StepKind kind{};
    Schedule schedule;
  };
  std::vector<std::unique_ptr<CachedSchedule>> schedules;
  std::vector<Model<double>> models;
  std::vector<Model<Dual>> dual_models;
  std::vector<int> pending, next, pack;
  std::vector<double> steps;
  std::vector<double> lanes;

  std::vector<Model<double>>& GetModels(double) { return models; }
  std::vector<Model<Dual>>& GetModels(const Dual&) { return dual_models; }

  const Schedule& GetSchedule(const Excitation& excitation, const BatchOptions& options,
                              StepKind kind, double step) {
    for (const auto& entry : schedules) {
      if (entry->excitation == excitation.id() && entry->duration == options.duration &&
          entry->sample_interval == options.sample_interval && entry->step == step &&
          entry->kind == kind) {
        return entry->schedule;
      }
    }
    if (schedules.size() > 16) schedules.clear();
    auto entry = std::make_unique<CachedSchedule>();
    entry->excitation = excitation.id();
    entry->duration = options.duration;
    entry->sample_interval = options.sample_interval;
    entry->step = step;
    entry->kind = kind;
    const auto make = kind == StepKind::kAdams         ? MakeAdamsSchedule
                      : kind == StepKind::kRungeKutta4 ? MakeRungeKuttaSchedule
                                                       : MakeOneStepSchedule;
    entry->schedule = make(excitation, options.duration, options.sample_interval, step);
    schedules.push_back(std::move(entry));
    return schedules.back()->schedule;
  }
};

BatchWorkspace::BatchWorkspace() : scratch_(std::make_unique<Scratch>()) {}
BatchWorkspace::~BatchWorkspace() = default;

template <class T>
void BatchWorkspace::Run(std::span<const Parameters<T>> designs, const Excitation& excitation,
                         const BatchOptions& options, BatchResult& result) {
  constexpr bool kTangent = !std::is_same_v<T, double>;
  constexpr int kPartCount = kTangent ? 2 : 1;
  Scratch& s = *scratch_;
  const int count = static_cast<int>(designs.size());
  const int samples = CalcSampleIntervals(options.duration, options.sample_interval,
                                          options.step > 0 ? options.step : 1.0) +
                      1;
  const LaneKernels kernels = GetLaneKernels();

  result.samples_ = samples;
  result.parts_ = kPartCount;
  result.values_.resize(static_cast<size_t>(count) * kBatchSignals * kPartCount *
                        static_cast<size_t>(samples));
  result.outcomes_.assign(static_cast<size_t>(count), {});

  auto& models = s.GetModels(T{});
  models.clear();
  for (const Parameters<T>& design : designs) {
    if constexpr (kTangent) {
      ValidateParameters(ConvertParameters<double>(design, [](const Dual& x) { return x.v; }));
    } else {
      ValidateParameters(design);
    }
    models.push_back(MakeModel(design));
  }
  s.steps.assign(static_cast<size_t>(count), 0.0);
  s.pending.clear();
  for (std::vector<int>* list : {&s.pending, &s.next, &s.pack}) {
    list->reserve(static_cast<size_t>(count));
  }
  for (int i = 0; i < count; ++i) {
    const Path path = ChoosePath(models[static_cast<size_t>(i)].structure, options.method);
    double step = options.step;
    if (path == Path::kRungeKutta && options.method == Method::kFast) step = 0;
    if (step <= 0) {
      step = path == Path::kLanes ? 2.5e-4 : path == Path::kSwitching ? 2e-4 : 1e-5;
      if (path == Path::kSwitching && options.method == Method::kRungeKutta4) step = 1e-5;
    }
    s.steps[static_cast<size_t>(i)] = step;
    s.pending.push_back(i);
  }

  const auto run_pack = [&](std::span<const int> pack, Path path, double step, bool one) {
    const Structure& structure = models[static_cast<size_t>(pack[0])].structure;
    const StepKind kind = path == Path::kLanes ? StepKind::kAdams
                          : options.method == Method::kRungeKutta4 || path == Path::kRungeKutta
                              ? StepKind::kRungeKutta4
                              : StepKind::kOneStep;
    const Schedule& schedule = s.GetSchedule(excitation, options, kind, step);
    const int lanes = one ? 1 : kernels.lanes;
    const double* constants[8];
    double error[8] = {};
    int failed_sample[8], failed_coordinate[8] = {};
    for (int lane = 0; lane < lanes; ++lane) {
      // Lanes without a design repeat the first.
      const size_t index = static_cast<size_t>(
          pack[lane < static_cast<int>(pack.size()) ? static_cast<size_t>(lane) : 0]);
      constants[lane] = reinterpret_cast<const double*>(&models[index].constants);
    }
    s.lanes.resize(static_cast<size_t>(samples) * kBatchSignals * kPartCount *
                   static_cast<size_t>(lanes));
    LaneJob job{};
    job.structure = &structure;
    job.constants = constants;
    job.steps = schedule.steps.data();
    job.step_count = static_cast<int>(schedule.steps.size());
    job.first_sample = schedule.first_sample;
    job.adams_step = schedule.adams_step;
    job.excitation = &excitation;
    job.samples = s.lanes.data();
    job.error = error;
    job.failed_sample = failed_sample;
    job.failed_coordinate = failed_coordinate;
    if constexpr (kTangent) {
      (one ? kernels.run_one_tangent : kernels.run_tangents)(job);
    } else {
      (one ? kernels.run_one : kernels.run)(job);
    }
    int valid[8];
    for (size_t lane = 0; lane < pack.size(); ++lane) {
      const size_t design = static_cast<size_t>(pack[lane]);
      BatchOutcome& outcome = result.outcomes_[design];
      outcome = {};
      outcome.step = step;
      outcome.error_estimate =
          path == Path::kLanes ? error[lane] : std::numeric_limits<double>::quiet_NaN();
      outcome.failed = failed_sample[lane] >= 0;
      if (outcome.failed) {
        outcome.failure_time = options.duration * failed_sample[lane] / (samples - 1);
        outcome.failure_coordinate = failed_coordinate[lane];
      }
      valid[lane] = outcome.failed ? failed_sample[lane] : samples;
    }
    // From sample by sample to design by design, in blocks that stay in the first-level cache.
    const size_t rows = static_cast<size_t>(kBatchSignals) * kPartCount;
    const size_t stride = rows * static_cast<size_t>(lanes);
    constexpr int kBlock = 16;
    for (int begin = 0; begin < samples; begin += kBlock) {
      for (size_t lane = 0; lane < pack.size(); ++lane) {
        const int end = std::min(begin + kBlock, valid[lane]);
        double* to = result.values_.data() +
                     static_cast<size_t>(pack[lane]) * rows * static_cast<size_t>(samples);
        for (size_t row = 0; row < rows; ++row, to += samples) {
          const double* from = s.lanes.data() + row * static_cast<size_t>(lanes) + lane;
          for (int i = begin; i < end; ++i) to[i] = from[static_cast<size_t>(i) * stride];
        }
      }
    }
    for (size_t lane = 0; lane < pack.size(); ++lane) {
      double* to = result.values_.data() +
                   static_cast<size_t>(pack[lane]) * rows * static_cast<size_t>(samples);
      for (size_t row = 0; row < rows; ++row, to += samples) {
        std::fill(to + valid[lane], to + samples, 0.0);
      }
    }
  };

  // Rounds: all designs, then those again that need a smaller step.
  for (int round = 0; !s.pending.empty(); ++round) {
    s.next.clear();
    std::vector<int>& todo = s.pending;
    while (!todo.empty()) {
      const int first = todo[0];
      const Structure structure = models[static_cast<size_t>(first)].structure;
      const double step = s.steps[static_cast<size_t>(first)];
      const Path path = ChoosePath(structure, options.method);
      const bool one = path == Path::kSwitching || options.scalar;
      const size_t most = one ? 1 : static_cast<size_t>(kernels.lanes);
      s.pack.clear();
      size_t kept = 0;
      for (size_t i = 0; i < todo.size(); ++i) {
        const size_t design = static_cast<size_t>(todo[i]);
        if (s.pack.size() < most && s.steps[design] == step &&
            models[design].structure == structure) {
          s.pack.push_back(todo[i]);
        } else {
          todo[kept++] = todo[i];
        }
      }
      todo.resize(kept);
      run_pack(s.pack, path, step, one);
      if (path != Path::kLanes) continue;
      for (int design : s.pack) {
        BatchOutcome& outcome = result.outcomes_[static_cast<size_t>(design)];
        if (!outcome.failed && outcome.error_estimate <= options.tolerance) continue;
        if (round >= 6) {
          if (!outcome.failed) outcome.failure_time = options.duration;
          outcome.failed = true;
          continue;
        }
        s.steps[static_cast<size_t>(design)] = 0.5 * step;
        s.next.push_back(design);
      }
    }
    std::swap(s.pending, s.next);
  }
}

void SimulateBatch(std::span<const Parameters<double>> designs, const Excitation& excitation,
                   const BatchOptions& options, BatchWorkspace& workspace, BatchResult& result) {
  workspace.Run(designs, excitation, options, result);
}

void SimulateTangents(std::span<const Parameters<Dual>> designs, const Excitation& excitation,
                      const BatchOptions& options, BatchWorkspace& workspace, BatchResult& result) {
  workspace.Run(designs, excitation, options, result);
}

}  // namespace kingpin::planar
