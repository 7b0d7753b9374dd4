#include "optimisation/study/stage_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "optimisation/algorithms/evaluator.h"
#include "optimisation/algorithms/minimise.h"
#include "optimisation/algorithms/multipliers.h"
#include "optimisation/algorithms/random.h"

namespace kingpin::study {
namespace {

using optimisation::Problem;
using optimisation::Result;
using Point = std::vector<double>;

/// Steps of a search as part of a variable's range: what lies nearer to a limit is on it.
constexpr double kSmoothTolerance = 1e-6;
constexpr double kRefinedTolerance = 1e-3;

/// How many of the distinct minima found without the switching forces are refined with them.
constexpr std::size_t kRefinedMinima = 2;

/// How many searches with the switching forces start from the best of a sample.
constexpr int kSampled = 4;

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Random points in the bounds of a space, monotone conditions aside (the search repairs those).
std::vector<Point> MakeRandomStarts(const DesignSpace& space, int count, std::uint64_t seed) {
  optimisation::Random random(seed);
  std::vector<Point> starts;
  for (int i = 0; i < count; ++i) {
    Point x;
    for (const DesignVariable& v : space.variables()) {
      x.push_back(v.lower + random.Uniform() * (v.upper - v.lower));
    }
    starts.push_back(std::move(x));
  }
  return starts;
}

/// Effort in proportion to the number of variables. The measures are smooth to about 1e-6 of their
/// value (the simulation's own accuracy), so finer tolerances would follow noise.
optimisation::MinimiseOptions MakeSearchOptions(const StageSearch& search) {
  const int variables = search.space.size();
  optimisation::MinimiseOptions options;
  options.algorithm = search.algorithm;
  options.seed = search.seed;
  options.multistart.samples = std::clamp(32 * variables, 128, 512);
  options.multistart.searches = 16;
  options.multistart.cma_es_evaluations = 80L * variables;
  options.multistart.polished = 2;
  options.polish.step_tolerance = kSmoothTolerance;
  options.polish.value_tolerance = 1e-9;
  options.polish.max_evaluations = 20 * variables;
  return options;
}

optimisation::Control MakeControl(const StageSearch& search, long max_evaluations) {
  optimisation::Control control;
  control.max_evaluations = max_evaluations;
  control.cancelled = search.cancelled;
  return control;
}

/// Downhill from given points in the model as it is, without derivatives.
optimisation::MinimiseOptions MakeRefineOptions(int variables) {
  optimisation::MinimiseOptions options;
  options.algorithm = optimisation::Algorithm::kCobyla;
  options.choose_local = false;
  options.local.algorithm = optimisation::Algorithm::kCobyla;
  options.local.initial_step = 0.1;
  options.local.step_tolerance = kRefinedTolerance;
  options.local.value_tolerance = 1e-6;
  options.local.max_evaluations = 10 * variables;
  options.polish.enabled = false;
  return options;
}

/// The second pass: from the given starts and minima, from the best of a sample, and with an
/// evolution strategy, which sees past the roughness.
optimisation::MinimiseOptions MakeSecondPassOptions(const StageSearch& search) {
  const int variables = search.space.size();
  optimisation::MinimiseOptions options = MakeRefineOptions(variables);
  options.algorithm = optimisation::Algorithm::kMultistart;
  options.seed = search.seed;
  options.multistart.samples = 16 * variables;
  options.multistart.cma_es_evaluations = 30L * variables;
  options.multistart.cma_es = search.algorithm == optimisation::Algorithm::kMultistart;
  return options;
}

/// Values of several points in one batch.
std::vector<double> CalcValues(const Problem& problem, const std::vector<Point>& points) {
  std::vector<double> flat, values(points.size());
  for (const Point& x : points) flat.insert(flat.end(), x.begin(), x.end());
  if (!points.empty()) problem.objective(flat, values);
  return values;
}

double CalcSpread(const Result& result) {
  double lowest = result.value, highest = result.value;
  for (const auto& restart : result.restarts) {
    if (!std::isfinite(restart.value)) continue;
    lowest = std::min(lowest, restart.value);
    highest = std::max(highest, restart.value);
  }
  return (highest - lowest) / std::abs(lowest);
}

void KeepBetter(const Point& x, double value, Result& result) {
  if (value < result.value) {
    result.x = x;
    result.value = value;
  }
}

/// Repeats a search from random starts; one restart for each.
std::vector<optimisation::Restart> Repeat(const StageSearch& search, const Problem& problem,
                                          optimisation::MinimiseOptions options) {
  options.starts.clear();
  std::vector<optimisation::Restart> ends;
  Problem repeated = problem;
  for (const Point& start : MakeRandomStarts(search.space, search.random_starts, search.seed)) {
    for (std::size_t i = 0; i < start.size(); ++i) repeated.variables[i].start = start[i];
    ++options.seed;
    const Result end =
        optimisation::Minimise(repeated, options, MakeControl(search, search.max_evaluations));
    if (end.cancelled) break;
    ends.push_back({start, end.start_value, end.x, end.value, end.evaluations, end.status,
                    end.feasible ? 0 : -1});
  }
  return ends;
}

/// Carries ends of searches without the switching forces over to the model as it is.
class Refinement {
 public:
  Refinement(const StageSearch& search, const Problem& problem)
      : search_(search), problem_(problem) {}

  /// Refines the best of the distinct points among `ends` and the given starts.
  Result Run(const std::vector<Point>& ends, std::vector<Point> starts) {
    const std::vector<double> values = CalcValues(problem_, ends);
    std::vector<std::size_t> order(ends.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    const std::size_t given = starts.size();
    for (const std::size_t i : order) {
      if (starts.size() >= given + kRefinedMinima) break;
      const auto same = [&](const Point& other) { return IsSame(ends[i], other); };
      if (std::isfinite(values[i]) && std::none_of(starts.begin(), starts.end(), same)) {
        starts.push_back(ends[i]);
      }
    }
    optimisation::MinimiseOptions options = MakeSecondPassOptions(search_);
    options.multistart.searches = 1 + static_cast<int>(starts.size());
    // A study that asks for one algorithm wants no sample.
    if (search_.algorithm == optimisation::Algorithm::kMultistart) {
      options.multistart.searches += kSampled;
    }
    options.starts = starts;
    Result result =
        optimisation::Minimise(problem_, options, MakeControl(search_, search_.max_evaluations));
    for (std::size_t i = 0; i < starts.size() && i + 1 < result.restarts.size(); ++i) {
      const auto& restart = result.restarts[i + 1];
      if (restart.minimum >= 0) refined_.push_back({starts[i], restart.end, restart.value});
    }
    return result;
  }

  /// The same restarts with the values of the model as it is, and with the refined end where the
  /// point they came to was refined.
  std::vector<optimisation::Restart> Carry(std::vector<optimisation::Restart> restarts) const {
    std::vector<Point> starts, ends;
    for (const auto& restart : restarts) {
      starts.push_back(restart.start);
      ends.push_back(restart.end);
    }
    const std::vector<double> start_values = CalcValues(problem_, starts);
    const std::vector<double> end_values = CalcValues(problem_, ends);
    for (std::size_t i = 0; i < restarts.size(); ++i) {
      optimisation::Restart& restart = restarts[i];
      restart.start_value = start_values[i];
      restart.value = end_values[i];
      if (restart.minimum < 0) {
        restart.value = std::numeric_limits<double>::infinity();
        continue;
      }
      for (const Refined& refined : refined_) {
        if (!IsSame(restart.end, refined.from) || refined.value > restart.value) continue;
        restart.end = refined.x;
        restart.value = refined.value;
        break;
      }
    }
    return restarts;
  }

 private:
  struct Refined {
    Point from;
    Point x;
    double value;
  };

  bool IsSame(const Point& a, const Point& b) const {
    constexpr double kCluster = 0.02;  // of a range, as optimisation::MinimiseOptions
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto& v = problem_.variables[i];
      if (std::abs(a[i] - b[i]) > kCluster * (v.upper - v.lower)) return false;
    }
    return true;
  }

  const StageSearch& search_;
  const Problem& problem_;
  std::vector<Refined> refined_;
};

/// Distinct ends, best first, with how many searches came there.
std::vector<optimisation::LocalMinimum> ListMinima(const Problem& problem, Result& result) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < result.restarts.size(); ++i) {
    if (std::isfinite(result.restarts[i].value)) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return result.restarts[a].value < result.restarts[b].value;
  });
  std::vector<optimisation::LocalMinimum> minima;
  for (const std::size_t i : order) {
    optimisation::Restart& restart = result.restarts[i];
    const auto found = std::find_if(minima.begin(), minima.end(), [&](const auto& minimum) {
      for (std::size_t k = 0; k < minimum.x.size(); ++k) {
        const auto& v = problem.variables[k];
        if (std::abs(minimum.x[k] - restart.end[k]) >
            result.cluster_distance * (v.upper - v.lower)) {
          return false;
        }
      }
      return true;
    });
    restart.minimum = static_cast<int>(found - minima.begin());
    if (found == minima.end()) {
      minima.push_back({restart.end, restart.value, 1});
    } else {
      ++found->searches;
    }
  }
  return minima;
}

StageSearchResult SearchSmooth(const StageSearch& search, const Problem& problem) {
  const auto clock = std::chrono::steady_clock::now();
  optimisation::MinimiseOptions options = MakeSearchOptions(search);
  options.starts = search.starts;
  StageSearchResult found;
  Result& result = found.result;
  result = optimisation::Minimise(problem, options, MakeControl(search, search.max_evaluations));
  found.seconds = SecondsSince(clock);
  if (search.random_starts == 0 || result.cancelled) return found;
  result.restarts = Repeat(search, problem, options);
  for (const auto& restart : result.restarts) {
    if (restart.minimum >= 0) KeepBetter(restart.end, restart.value, result);
  }
  result.minima = ListMinima(problem, result);
  result.spread = CalcSpread(result);
  return found;
}

StageSearchResult SearchInTwoPasses(const StageSearch& search, const Problem& problem,
                                    const Problem& smooth_problem) {
  const auto clock = std::chrono::steady_clock::now();
  optimisation::MinimiseOptions options = MakeSearchOptions(search);
  options.starts = search.starts;
  // All but one in twenty of these end in the same minimum (docs/decisions.md).
  options.multistart.searches = 4;
  options.multistart.cma_es = false;
  options.multistart.polished = 1;
  const Result smooth =
      optimisation::Minimise(smooth_problem, options, MakeControl(search, search.max_evaluations));
  std::vector<Point> ends;
  for (const auto& minimum : smooth.minima) ends.push_back(minimum.x);
  Refinement refinement(search, problem);
  StageSearchResult found;
  Result& result = found.result;
  result = refinement.Run(ends, search.starts);
  result.algorithm = smooth.algorithm + " without switching forces, then " + result.algorithm;
  result.evaluations += smooth.evaluations;
  result.gradient_evaluations += smooth.gradient_evaluations;
  found.seconds = SecondsSince(clock);
  if (result.cancelled) return found;
  if (search.random_starts == 0) return found;
  const auto repeats = Repeat(search, smooth_problem, options);
  ends.clear();
  for (const auto& repeat : repeats) {
    if (repeat.minimum >= 0) ends.push_back(repeat.end);
  }
  const Result refined = refinement.Run(ends, {});
  if (refined.feasible) KeepBetter(refined.x, refined.value, result);
  result.restarts = refinement.Carry(repeats);
  result.minima = ListMinima(problem, result);
  result.spread = CalcSpread(result);
  return found;
}

/// Moves what is within the search's tolerance of a bound onto it: for sure what is there but for
/// the rounding of scaled variables, the rest unless the objective rises.
void SnapToBounds(const Problem& problem, double tolerance, Result& result) {
  constexpr double kRounding = 1e-12;
  const auto snap = [&](double within) {
    Point x = result.x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto& v = problem.variables[i];
      const double near = within * (v.upper - v.lower);
      if (x[i] - v.lower <= near) x[i] = v.lower;
      if (v.upper - x[i] <= near) x[i] = v.upper;
    }
    return x;
  };
  result.x = snap(kRounding);
  const Point x = snap(tolerance);
  if (x == result.x) return;
  optimisation::Batch batch;
  batch.Resize(problem, 1, false);
  batch.points = x;
  optimisation::DirectEvaluator evaluator(problem, {});
  evaluator.Evaluate(batch);
  if (batch.objectives[0] <= result.value &&
      optimisation::CalcViolation(problem, batch, 0) <= 0.0) {
    result.x = x;
    result.value = batch.objectives[0];
  }
}

}  // namespace

StageSearchResult SearchStage(const StageSearch& search, DesignEvaluator& evaluator) {
  const Problem problem = MakeStageProblem(
      search.space, evaluator, evaluator.Calc(search.reference), search.weights, search.limits);
  StageSearchResult found;
  if (!HasSwitchingForces(search.space.base())) {
    found = SearchSmooth(search, problem);
    if (!std::isfinite(found.result.value)) return found;
    SnapToBounds(problem, kSmoothTolerance, found.result);
    optimisation::DirectEvaluator direct(problem, {});
    found.result.active =
        optimisation::FindActiveConstraints(direct, problem, found.result.x, kSmoothTolerance);
    return found;
  }
  const DesignSpace smooth_space = search.space.WithBase(MakeSmooth(search.space.base()));
  const Problem smooth_problem =
      MakeStageProblem(smooth_space, evaluator, evaluator.Calc(MakeSmooth(search.reference)),
                       search.weights, search.limits);
  found = SearchInTwoPasses(search, problem, smooth_problem);
  if (!std::isfinite(found.result.value)) return found;
  SnapToBounds(problem, kRefinedTolerance, found.result);
  // The constraints are the same in both; the derivatives of the rough measures mean nothing.
  optimisation::DirectEvaluator direct(smooth_problem, {});
  found.result.active = optimisation::FindActiveConstraints(direct, smooth_problem, found.result.x,
                                                            kRefinedTolerance);
  return found;
}

Result RefineFrom(const StageSearch& search, const std::vector<double>& x,
                  DesignEvaluator& evaluator) {
  Problem problem = MakeStageProblem(search.space, evaluator, evaluator.Calc(search.reference),
                                     search.weights, search.limits);
  for (std::size_t i = 0; i < x.size(); ++i) problem.variables[i].start = x[i];
  optimisation::MinimiseOptions options = MakeRefineOptions(search.space.size());
  options.local.initial_step = 0.03;  // small, to stay in the basin
  return optimisation::Minimise(problem, options, MakeControl(search, 0));
}

}  // namespace kingpin::study
