#include "optimisation/algorithms/polish.h"

#include <cmath>
#include <deque>
#include <utility>

#include "optimisation/algorithms/batch_gatherer.h"
#include "optimisation/algorithms/local_search.h"

namespace kingpin::optimisation {
namespace {

struct Job {
  std::size_t design;  ///< which of the designs it works on
  std::vector<double> x;
  std::vector<bool> fixed;
  Algorithm algorithm;
  Design found;
};

Algorithm ChooseModelSearch(const Problem& problem) {
  return problem.HasConstraints() ? Algorithm::kCobyla : Algorithm::kBobyqa;
}

void RunJobs(Evaluator& evaluator, const Problem& problem, std::deque<Job>& jobs,
             const PolishOptions& options, const Scalarisation& scalarisation) {
  BatchGatherer gatherer(problem, evaluator);
  for (Job& job : jobs) {
    gatherer.Add([&](Evaluator& own) {
      const SearchSpace space(problem, job.x, job.fixed);
      SearchView view(own, space, scalarisation);
      LocalOptions local;
      local.algorithm = job.algorithm;
      local.max_evaluations = options.max_evaluations;
      local.step_tolerance = options.step_tolerance;
      local.value_tolerance = options.value_tolerance;
      local.initial_step = options.initial_step;
      try {
        RunLocalSearch(view, local, space.CalcU(job.x));
      } catch (const SearchStopped&) {
        // What has been found so far counts.
      }
      job.found = {view.best_x(), view.best()};
    });
  }
  gatherer.Run();
}

bool IsNear(const Variable& variable, double x, double distance) {
  const double range = variable.upper - variable.lower;
  const double to_bound = std::min(x - variable.lower, variable.upper - x);
  return range > 0 && to_bound > 0 && to_bound <= distance * range;
}

double GetNearBound(const Variable& variable, double x) {
  return x - variable.lower < variable.upper - x ? variable.lower : variable.upper;
}

}  // namespace

std::vector<Design> Polish(Evaluator& evaluator, const Problem& problem,
                           std::vector<Design> designs, const PolishOptions& options,
                           const Scalarisation& scalarisation) {
  std::deque<Job> jobs;
  for (std::size_t d = 0; d < designs.size(); ++d) {
    for (const Algorithm algorithm : {Algorithm::kSlsqp, ChooseModelSearch(problem)}) {
      jobs.push_back({d, designs[d].x, {}, algorithm, {}});
    }
  }
  RunJobs(evaluator, problem, jobs, options, scalarisation);
  for (Job& job : jobs) {
    if (IsBetter(job.found.merit, designs[job.design].merit)) {
      designs[job.design] = std::move(job.found);
    }
  }

  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    jobs.clear();
    for (std::size_t d = 0; d < designs.size(); ++d) {
      const std::vector<double>& x = designs[d].x;
      std::vector<std::size_t> near;
      for (std::size_t i = 0; i < problem.size(); ++i) {
        if (IsNear(problem.variables[i], x[i], options.snap_distance)) near.push_back(i);
      }
      const auto add = [&](const std::vector<std::size_t>& snapped) {
        Job job{d, x, std::vector<bool>(problem.size(), false), Algorithm::kSlsqp, {}};
        for (const std::size_t i : snapped) {
          job.x[i] = GetNearBound(problem.variables[i], x[i]);
          job.fixed[i] = true;
        }
        jobs.push_back(job);
        job.algorithm = ChooseModelSearch(problem);
        jobs.push_back(std::move(job));
      };
      if (!near.empty()) add(near);
      if (near.size() > 1) {
        for (const std::size_t i : near) add({i});
      }
    }
    if (jobs.empty()) break;
    RunJobs(evaluator, problem, jobs, options, scalarisation);
    std::vector<const Job*> chosen(designs.size(), nullptr);
    for (const Job& job : jobs) {
      const Merit& now = designs[job.design].merit;
      // The refinements end within rounding of each other: that much is not a rise.
      const double slack = 1e-13 * std::abs(now.value);
      const bool no_rise =
          job.found.merit.violation <= now.violation && job.found.merit.value <= now.value + slack;
      if (!no_rise) continue;
      const Job*& best = chosen[job.design];
      // The first one has all variables on their bounds; another must be better by more than
      // rounding.
      if (best == nullptr || job.found.merit.value < best->found.merit.value - slack) best = &job;
    }
    bool any = false;
    for (std::size_t d = 0; d < designs.size(); ++d) {
      if (chosen[d] == nullptr) continue;
      designs[d] = chosen[d]->found;
      any = true;
    }
    if (!any) break;
  }
  return designs;
}

}  // namespace kingpin::optimisation
