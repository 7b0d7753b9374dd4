#include "optimisation/algorithms/weighted_sweep.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"
#include "optimisation/algorithms/batch_gatherer.h"
#include "optimisation/algorithms/local_search.h"
#include "optimisation/algorithms/random.h"

namespace kingpin::optimisation {
namespace {

struct Known {
  FrontPoint point;
  double violation = std::numeric_limits<double>::infinity();
};

/// Leaves out points that two searches found alike, to a millionth of the front's extent.
std::vector<FrontPoint> DropRepetitions(std::vector<FrontPoint> front) {
  if (front.empty()) return front;
  // Sorted by the first objective, so the extents stand at the ends.
  const double width = front.back().objectives[0] - front.front().objectives[0];
  const double height = front.front().objectives[1] - front.back().objectives[1];
  std::vector<FrontPoint> kept;
  for (FrontPoint& point : front) {
    const bool repeated = !kept.empty() &&
                          point.objectives[0] - kept.back().objectives[0] <= 1e-6 * width &&
                          kept.back().objectives[1] - point.objectives[1] <= 1e-6 * height;
    if (!repeated) kept.push_back(std::move(point));
  }
  return kept;
}

class Sweep {
 public:
  Sweep(const Problem& problem, const SweepOptions& options, const Control& control)
      : problem_(problem),
        options_(options),
        evaluator_(problem, control),
        space_(problem, problem.GetStart()) {}

  Front Run() {
    try {
      Screen();
      // First the ends of the front, because the scale of all weights hangs on them.
      MakeScalarisations({1e-3, 1 - 1e-3}, false);
      RunRound(0);
      std::vector<double> weights;
      const int count = std::max(2, options_.weights);
      for (int k = 0; k < count; ++k) weights.push_back(static_cast<double>(k) / (count - 1));
      for (int round = 0; round < options_.rounds; ++round) {
        MakeScalarisations(weights, options_.chebyshev);
        RunRound(round);
      }
    } catch (const SearchStopped&) {
      // What is known so far makes the front.
    }
    Front front;
    std::vector<FrontPoint> points;
    for (const Known& known : known_) {
      if (known.violation == 0) points.push_back(known.point);
    }
    front.points = DropRepetitions(FilterFront(std::move(points)));
    front.evaluations = evaluator_.evaluations();
    front.cancelled = evaluator_.cancelled();
    front.status =
        evaluator_.cancelled()
            ? "cancelled; the front so far"
            : fmt::format("{} weights, {} points", scalarisations_.size(), front.points.size());
    if (front.points.empty()) front.status += "; no design that fulfils all constraints was found";
    return front;
  }

 private:
  void Learn(const std::vector<std::vector<double>>& points) {
    if (points.empty()) return;
    Batch batch;
    batch.Resize(problem_, points.size(), false);
    auto to = batch.points.begin();
    for (const auto& x : points) to = std::copy(x.begin(), x.end(), to);
    evaluator_.Evaluate(batch);
    const std::size_t objectives = problem_.objective_names.size();
    for (std::size_t p = 0; p < points.size(); ++p) {
      Known known;
      known.point.x = points[p];
      const auto from = batch.objectives.begin() + static_cast<std::ptrdiff_t>(p * objectives);
      known.point.objectives.assign(from, from + static_cast<std::ptrdiff_t>(objectives));
      known.violation = CalcViolation(problem_, batch, p);
      known_.push_back(std::move(known));
    }
  }

  void Screen() {
    std::vector<std::vector<double>> points = {problem_.GetStart()};
    points.insert(points.end(), options_.starts.begin(), options_.starts.end());
    const std::size_t dim = space_.size();
    const std::size_t count = options_.samples > 0 ? static_cast<std::size_t>(options_.samples)
                                                   : std::clamp<std::size_t>(32 * dim, 128, 1024);
    Random random(options_.seed);
    std::vector<double> u = MakeLatinHypercube(count, dim, random);
    for (std::size_t p = 0; p < count && dim > 0; ++p) {
      const std::span<double> row(u.data() + p * dim, dim);
      space_.Project(row);
      std::vector<double> x(problem_.size());
      space_.CalcX(row, x);
      points.push_back(std::move(x));
    }
    Learn(points);
  }

  /// One for each weight of the second objective, with the scales of the front as known by now.
  void MakeScalarisations(const std::vector<double>& weights, bool chebyshev) {
    scalarisations_.clear();
    std::vector<FrontPoint> points;
    for (const Known& known : known_) {
      if (std::isfinite(known.violation)) points.push_back(known.point);
    }
    points = FilterFront(std::move(points));
    if (points.empty()) return;
    std::vector<double> low = points.front().objectives;
    std::vector<double> high = low;
    for (const FrontPoint& point : points) {
      for (std::size_t k = 0; k < low.size(); ++k) {
        low[k] = std::min(low[k], point.objectives[k]);
        high[k] = std::max(high[k], point.objectives[k]);
      }
    }
    std::vector<double> scale(low.size());
    std::vector<double> ideal(low.size());
    for (std::size_t k = 0; k < low.size(); ++k) {
      scale[k] = high[k] > low[k] ? high[k] - low[k] : std::max(1e-300, std::abs(high[k]));
      // A little below, so that the terms keep their sign when a search goes further.
      ideal[k] = low[k] - 0.01 * scale[k];
    }
    for (const double w : weights) {
      scalarisations_.push_back({{1 - w, w}, ideal, scale, chebyshev});
    }
  }

  Algorithm ChooseWithoutGradient() const {
    if (!problem_.equalities.names.empty() || !problem_.inequalities.names.empty()) {
      return Algorithm::kCobyla;
    }
    return space_.size() <= 8 ? Algorithm::kNelderMead : Algorithm::kSbplx;
  }

  void RunRound(int round) {
    struct Job {
      std::size_t weight;
      Algorithm algorithm;
      std::vector<double> start;
      Known end;
    };
    std::deque<Job> jobs;
    for (std::size_t w = 0; w < scalarisations_.size(); ++w) {
      std::vector<std::pair<Merit, std::size_t>> ranked;
      for (std::size_t i = 0; i < known_.size(); ++i) {
        const double value = scalarisations_[w].Calc(known_[i].point.objectives);
        if (!std::isfinite(value)) continue;
        ranked.push_back({{known_[i].violation, value}, i});
      }
      const auto count = std::min<std::size_t>(
          ranked.size(),
          round == 0 ? static_cast<std::size_t>(std::max(1, options_.searches_per_weight)) : 1);
      std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count),
                        ranked.end(), [](const auto& a, const auto& b) {
                          if (IsBetter(a.first, b.first)) return true;
                          if (IsBetter(b.first, a.first)) return false;
                          return a.second < b.second;
                        });
      for (std::size_t k = 0; k < count; ++k) {
        for (const Algorithm algorithm : {Algorithm::kSlsqp, ChooseWithoutGradient()}) {
          jobs.push_back({w, algorithm, known_[ranked[k].second].point.x, {}});
        }
      }
    }
    BatchGatherer gatherer(problem_, evaluator_);
    for (Job& job : jobs) {
      gatherer.Add([&, round](Evaluator& own) {
        SearchView view(own, space_, scalarisations_[job.weight]);
        LocalOptions local;
        local.algorithm = job.algorithm;
        local.max_evaluations = options_.max_evaluations;
        local.step_tolerance = options_.step_tolerance;
        local.initial_step = round == 0 ? 0.1 : 0.02;
        local.fresh_simplexes = 1;
        try {
          RunLocalSearch(view, local, space_.CalcU(job.start));
        } catch (const SearchStopped&) {
          // What it found so far counts.
        }
        job.end = {{view.best_x(), view.best_objectives()}, view.best().violation};
      });
    }
    gatherer.Run();
    for (Job& job : jobs) {
      if (!job.end.point.x.empty()) known_.push_back(std::move(job.end));
    }
  }

  const Problem& problem_;
  const SweepOptions& options_;
  DirectEvaluator evaluator_;
  SearchSpace space_;
  std::vector<Known> known_;
  std::vector<Scalarisation> scalarisations_;
};

}  // namespace

Front RunWeightedSweep(const Problem& problem, const SweepOptions& options,
                       const Control& control) {
  CheckProblem(problem);
  if (problem.objective_names.size() != 2) {
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = "objective",
                          .found = fmt::format("{} objectives", problem.objective_names.size()),
                          .expected = "two",
                          .suggestion = "use nsga2 for more"});
  }
  for (const auto& start : options.starts) CheckPoint(problem, start, "start");
  return Sweep(problem, options, control).Run();
}

}  // namespace kingpin::optimisation
