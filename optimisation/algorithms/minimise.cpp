#include "optimisation/algorithms/minimise.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"
#include "optimisation/algorithms/batch_gatherer.h"
#include "optimisation/algorithms/multipliers.h"
#include "optimisation/algorithms/random.h"

namespace kingpin::optimisation {
namespace {

/// One search from one start.
struct Job {
  std::uint64_t index = 0;
  Algorithm algorithm = Algorithm::kNelderMead;
  Design start;
  Design end;
  long evaluations = 0;
  std::string status = "not started";
};

double CalcDistance(const Problem& problem, const std::vector<double>& a,
                    const std::vector<double>& b) {
  double distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double range = problem.variables[i].upper - problem.variables[i].lower;
    if (range > 0) distance = std::max(distance, std::abs(a[i] - b[i]) / range);
  }
  return distance;
}

class Minimiser {
 public:
  Minimiser(const Problem& problem, const MinimiseOptions& options, const Control& control)
      : problem_(problem),
        options_(options),
        evaluator_(problem, control),
        space_(problem, problem.GetStart()) {}

  Result Run() {
    result_.algorithm = GetName(options_.algorithm);
    result_.cluster_distance = options_.cluster_distance;
    best_.x = problem_.GetStart();
    try {
      MakeJobs();
      RunJobs();
      Cluster();
      PolishMinima();
      TightenLinear();
    } catch (const SearchStopped&) {
      for (const Job& job : jobs_) Keep(job.end);
    }
    Finish();
    return std::move(result_);
  }

 private:
  void Keep(const Design& design) {
    if (!design.x.empty() && IsBetter(design.merit, best_.merit)) best_ = design;
  }

  /// Evaluates points exactly as given, in one batch.
  std::vector<Design> EvaluateAt(const std::vector<std::vector<double>>& points) {
    Batch batch;
    batch.Resize(problem_, points.size(), false);
    auto to = batch.points.begin();
    for (const auto& x : points) to = std::copy(x.begin(), x.end(), to);
    evaluator_.Evaluate(batch);
    std::vector<Design> designs;
    for (std::size_t p = 0; p < points.size(); ++p) {
      Design design{points[p], {CalcViolation(problem_, batch, p), batch.objectives[p]}};
      if (!std::isfinite(design.merit.value)) design.merit = Merit{};
      Keep(design);
      designs.push_back(std::move(design));
    }
    return designs;
  }

  std::vector<std::vector<double>> MakeSample(std::size_t count) {
    Random random(options_.seed);
    const std::size_t dim = space_.size();
    std::vector<double> u = MakeLatinHypercube(count, dim, random);
    std::vector<std::vector<double>> points;
    for (std::size_t p = 0; p < count; ++p) {
      const std::span<double> row(u.data() + p * dim, dim);
      space_.Project(row);
      std::vector<double> x(problem_.size());
      space_.CalcX(row, x);
      points.push_back(std::move(x));
    }
    return points;
  }

  Algorithm ChooseLocal() const {
    if (!options_.choose_local) return options_.local.algorithm;
    if (problem_.HasExactGradients()) return Algorithm::kSlsqp;
    if (!problem_.equalities.names.empty()) return Algorithm::kCobyla;
    return space_.size() <= 8 ? Algorithm::kNelderMead : Algorithm::kSbplx;
  }

  void MakeJobs() {
    std::vector<std::vector<double>> given = {problem_.GetStart()};
    given.insert(given.end(), options_.starts.begin(), options_.starts.end());
    const bool multistart = options_.algorithm == Algorithm::kMultistart && space_.size() > 0;
    const std::size_t fixed_starts = given.size();
    std::size_t samples = 0;
    if (multistart) {
      samples = options_.multistart.samples > 0
                    ? static_cast<std::size_t>(options_.multistart.samples)
                    : std::clamp<std::size_t>(32 * space_.size(), 128, 1024);
    } else if (space_.size() > 0) {
      samples = static_cast<std::size_t>(std::max(0, options_.random_starts));
    }
    if (samples > 0) {
      auto sample = MakeSample(samples);
      given.insert(given.end(), sample.begin(), sample.end());
    }
    const std::vector<Design> designs = EvaluateAt(given);
    result_.start_value = designs.front().merit.value;
    const Algorithm algorithm = multistart ? ChooseLocal() : options_.algorithm;
    const auto add = [&](Algorithm which, const Design& start) {
      Job job;
      job.index = jobs_.size();
      job.algorithm = which;
      job.start = start;
      job.end = start;
      jobs_.push_back(std::move(job));
    };
    if (options_.algorithm == Algorithm::kMultistart && !multistart) {
      add(Algorithm::kNelderMead, designs.front());  // all locked: one evaluation
      return;
    }
    if (!multistart) {
      for (const Design& design : designs) add(algorithm, design);
      return;
    }
    for (std::size_t d = 0; d < fixed_starts; ++d) add(algorithm, designs[d]);
    for (const std::size_t d : ChooseDiverse(designs, fixed_starts)) add(algorithm, designs[d]);
    if (options_.multistart.cma_es && problem_.equalities.names.empty()) {
      add(Algorithm::kCmaEs, best_);
    }
  }

  /// Best first, but apart from each other and from the fixed starts while there are others.
  std::vector<std::size_t> ChooseDiverse(const std::vector<Design>& designs,
                                         std::size_t fixed_starts) const {
    std::vector<std::size_t> order(designs.size() - fixed_starts);
    std::iota(order.begin(), order.end(), fixed_starts);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return IsBetter(designs[a].merit, designs[b].merit);
    });
    const int wanted_searches =
        options_.multistart.searches > 0 ? options_.multistart.searches : 16;
    const auto wanted =
        static_cast<std::size_t>(std::max(0, wanted_searches - static_cast<int>(fixed_starts)));
    std::vector<std::size_t> chosen;
    std::vector<std::vector<double>> places;
    for (std::size_t d = 0; d < fixed_starts; ++d) places.push_back(space_.CalcU(designs[d].x));
    std::vector<bool> taken(designs.size(), false);
    for (double distance = options_.multistart.least_distance; chosen.size() < wanted;
         distance = 0) {
      for (const std::size_t d : order) {
        if (chosen.size() >= wanted) break;
        if (taken[d]) continue;
        const std::vector<double> u = space_.CalcU(designs[d].x);
        const bool apart = std::all_of(places.begin(), places.end(), [&](const auto& place) {
          double sum = 0;
          for (std::size_t k = 0; k < u.size(); ++k) {
            sum += (u[k] - place[k]) * (u[k] - place[k]);
          }
          return sum >= distance * distance * static_cast<double>(u.size());
        });
        if (!apart) continue;
        taken[d] = true;
        chosen.push_back(d);
        places.push_back(u);
      }
      if (distance == 0) break;
    }
    return chosen;
  }

  LocalOptions MakeLocalOptions(Algorithm algorithm) const {
    LocalOptions local = options_.local;
    if (options_.algorithm == Algorithm::kMultistart && options_.choose_local) {
      local = LocalOptions{};
      local.step_tolerance = 1e-4;
      local.value_tolerance = 1e-8;
      local.fresh_simplexes = 1;
      local.max_evaluations = 200 + 100 * static_cast<int>(space_.size());
    }
    local.algorithm = algorithm;
    return local;
  }

  void RunJobs() {
    BatchGatherer gatherer(problem_, evaluator_, options_.concurrency);
    for (Job& job : jobs_) {
      gatherer.Add([&](Evaluator& own) {
        SearchView view(own, space_);
        try {
          const std::vector<double> u = space_.CalcU(job.start.x);
          if (job.algorithm == Algorithm::kCmaEs) {
            CmaEsOptions cma = options_.cma_es;
            cma.seed = options_.seed + job.index;
            if (options_.algorithm == Algorithm::kMultistart) {
              cma.restarts = CmaEsOptions::Restarts::kNone;
              cma.max_evaluations = options_.multistart.cma_es_evaluations;
              cma.step_tolerance = 1e-5;
              cma.value_tolerance = 1e-8;
            }
            job.status = RunCmaEs(view, cma, u);
          } else {
            job.status = RunLocalSearch(view, MakeLocalOptions(job.algorithm), u);
          }
        } catch (const SearchStopped&) {
          job.status = "stopped from outside";
        }
        job.evaluations = view.evaluations();
        // The start was evaluated at its own digits; the search may have moved it by a rounding.
        if (!view.best_x().empty() && IsBetter(view.best(), job.start.merit)) {
          job.end = {view.best_x(), view.best()};
        }
      });
    }
    gatherer.Run();
    for (const Job& job : jobs_) Keep(job.end);
  }

  void Cluster() {
    std::vector<std::size_t> order(jobs_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return IsBetter(jobs_[a].end.merit, jobs_[b].end.merit);
    });
    minimum_of_job_.assign(jobs_.size(), -1);
    for (const std::size_t j : order) {
      if (!jobs_[j].end.merit.feasible()) continue;
      minimum_of_job_[j] = Assign(jobs_[j].end);
    }
  }

  /// Index of the minimum the design belongs to; makes a new one when there is none.
  int Assign(const Design& design) {
    for (std::size_t m = 0; m < minima_.size(); ++m) {
      if (CalcDistance(problem_, minima_[m].x, design.x) <= options_.cluster_distance) {
        return static_cast<int>(m);
      }
    }
    minima_.push_back(design);
    return static_cast<int>(minima_.size()) - 1;
  }

  void PolishMinima() {
    if (!options_.polish.enabled || space_.size() == 0) return;
    const std::size_t count = std::min<std::size_t>(
        minima_.size(), static_cast<std::size_t>(std::max(1, options_.multistart.polished)));
    if (count == 0) return;
    const std::vector<Design> polished = Polish(
        evaluator_, problem_,
        {minima_.begin(), minima_.begin() + static_cast<std::ptrdiff_t>(count)}, options_.polish);
    std::copy(polished.begin(), polished.end(), minima_.begin());
    // The polished design may be a rounding above one not quite on its bound; it is still the one
    // wanted.
    const Design* polished_best = &polished.front();
    for (const Design& design : polished) {
      if (IsBetter(design.merit, polished_best->merit)) polished_best = &design;
    }
    const double slack = 1e-12 * std::abs(best_.merit.value);
    if (polished_best->merit.violation <= best_.merit.violation &&
        polished_best->merit.value <= best_.merit.value + slack) {
      best_ = *polished_best;
    }
    // Two may have turned out to be one.
    std::vector<std::size_t> order(minima_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return IsBetter(minima_[a].merit, minima_[b].merit);
    });
    const std::vector<Design> old = std::exchange(minima_, {});
    std::vector<int> renamed(old.size());
    for (const std::size_t m : order) renamed[m] = Assign(old[m]);
    for (int& minimum : minimum_of_job_) {
      if (minimum >= 0) minimum = renamed[static_cast<std::size_t>(minimum)];
    }
  }

  /// Shape conditions are checked without tolerance by those who use the result (a curve either is
  /// monotone or is not), so the last rounding is removed from linear inequalities.
  void TightenLinear() {
    if (problem_.linear.empty() || !best_.merit.feasible()) return;
    const auto excess = [&](const LinearConstraint& row, const std::vector<double>& x) {
      double sum = 0;
      for (std::size_t i = 0; i < x.size(); ++i) sum += row.coefficients[i] * x[i];
      return sum - row.bound;
    };
    std::vector<double> x = best_.x;
    bool changed = false;
    for (int sweep = 0; sweep < 100; ++sweep) {
      bool good = true;
      for (const LinearConstraint& row : problem_.linear) {
        double e = excess(row, x);
        if (row.equality) continue;
        if (e <= 0) continue;
        good = false;
        changed = true;
        double norm = 0;
        for (const double a : row.coefficients) norm += a * a;
        e *= 1 + 1e-3 * sweep;  // go a little further each time, should rounding hold it back
        for (std::size_t i = 0; i < x.size(); ++i) {
          const Variable& variable = problem_.variables[i];
          x[i] = std::clamp(x[i] - e * row.coefficients[i] / norm, variable.lower, variable.upper);
        }
      }
      if (good) break;
    }
    if (!changed) return;
    const Design tightened = EvaluateAt({x}).front();
    const double slack = 1e-6 * std::max(1e-300, std::abs(best_.merit.value));
    if (tightened.merit.feasible() && tightened.merit.value <= best_.merit.value + slack) {
      best_ = tightened;
    }
  }

  void Finish() {
    result_.x = best_.x;
    result_.value = best_.merit.value;
    result_.feasible = best_.merit.feasible();
    for (std::size_t j = 0; j < jobs_.size(); ++j) {
      const Job& job = jobs_[j];
      Restart restart{job.start.x,
                      job.start.merit.value,
                      job.end.x,
                      job.end.merit.value,
                      job.evaluations,
                      job.status,
                      -1};
      if (j < minimum_of_job_.size()) restart.minimum = minimum_of_job_[j];
      result_.restarts.push_back(std::move(restart));
    }
    for (const Design& design : minima_)
      result_.minima.push_back({design.x, design.merit.value, 0});
    double worst = -std::numeric_limits<double>::infinity();
    for (const Restart& restart : result_.restarts) {
      if (restart.minimum < 0) continue;
      ++result_.minima[static_cast<std::size_t>(restart.minimum)].searches;
      worst = std::max(worst, restart.value);
    }
    if (std::isfinite(worst)) {
      result_.spread = (worst - result_.value) / std::max(std::abs(result_.value), 1e-300);
    }
    if (result_.feasible) {
      result_.active = FindActiveConstraints(evaluator_, problem_, result_.x);
    }
    result_.evaluations = evaluator_.evaluations();
    result_.gradient_evaluations = evaluator_.gradient_evaluations();
    result_.cancelled = evaluator_.cancelled();
    result_.history = evaluator_.history();
    if (result_.feasible) result_.history.push_back({result_.evaluations, result_.value});
    result_.status = Describe();
  }

  std::string Describe() const {
    std::string status;
    if (evaluator_.cancelled()) {
      status = "cancelled";
    } else if (evaluator_.exhausted()) {
      status = fmt::format("stopped at the limit of {} evaluations", evaluator_.evaluations());
    } else if (jobs_.size() == 1) {
      status = jobs_.front().status;
    } else {
      int same = 0;
      for (const int minimum : minimum_of_job_) same += minimum == 0 ? 1 : 0;
      status = fmt::format("{} of {} searches ended in the best of {} distinct minima", same,
                           jobs_.size(), minima_.size());
    }
    if (!result_.feasible) {
      return status + (std::isfinite(best_.merit.value)
                           ? "; no design that fulfils all constraints was found"
                           : "; no design with a finite value was found");
    }
    if (evaluator_.cancelled() || evaluator_.exhausted()) status += "; the best so far";
    return status;
  }

  const Problem& problem_;
  const MinimiseOptions& options_;
  DirectEvaluator evaluator_;
  SearchSpace space_;
  Result result_;
  Design best_;
  std::deque<Job> jobs_;
  std::vector<Design> minima_;
  std::vector<int> minimum_of_job_;
};

}  // namespace

Result Minimise(const Problem& problem, const MinimiseOptions& options, const Control& control) {
  CheckProblem(problem);
  if (problem.objective_names.size() != 1) {
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = "objective",
                          .found = fmt::format("{} objectives", problem.objective_names.size()),
                          .expected = "one",
                          .suggestion = "use nsga2 or a weighted sweep for a Pareto front"});
  }
  CheckSuitable(options.algorithm, problem);
  for (const auto& start : options.starts) CheckPoint(problem, start, "start");
  return Minimiser(problem, options, control).Run();
}

}  // namespace kingpin::optimisation
