#include "optimisation/algorithms/nsga2.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"
#include "optimisation/algorithms/evaluator.h"
#include "optimisation/algorithms/random.h"
#include "optimisation/algorithms/search_space.h"

namespace kingpin::optimisation {
namespace {

struct Individual {
  std::vector<double> u;
  FrontPoint point;
  double violation = std::numeric_limits<double>::infinity();
  int rank = 0;
  double crowding = 0;
};

bool ConstraintDominates(const Individual& a, const Individual& b) {
  if (a.violation != b.violation) return a.violation < b.violation;
  if (std::isinf(a.violation)) return false;
  return Dominates(a.point.objectives, b.point.objectives);
}

/// Fast non-dominated sorting; returns the fronts as indices.
std::vector<std::vector<std::size_t>> SortFronts(std::vector<Individual>& all) {
  const std::size_t n = all.size();
  std::vector<std::vector<std::size_t>> beats(n);
  std::vector<int> beaten_by(n, 0);
  std::vector<std::vector<std::size_t>> fronts(1);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      if (ConstraintDominates(all[i], all[j])) beats[i].push_back(j);
      if (ConstraintDominates(all[j], all[i])) ++beaten_by[i];
    }
    if (beaten_by[i] == 0) fronts[0].push_back(i);
  }
  while (!fronts.back().empty()) {
    std::vector<std::size_t> next;
    for (const std::size_t i : fronts.back()) {
      all[i].rank = static_cast<int>(fronts.size()) - 1;
      for (const std::size_t j : beats[i]) {
        if (--beaten_by[j] == 0) next.push_back(j);
      }
    }
    std::sort(next.begin(), next.end());
    fronts.push_back(std::move(next));
  }
  fronts.pop_back();
  return fronts;
}

void AssignCrowding(std::vector<Individual>& all, const std::vector<std::size_t>& front) {
  for (const std::size_t i : front) all[i].crowding = 0;
  const std::size_t objectives = all[front.front()].point.objectives.size();
  std::vector<std::size_t> order(front);
  for (std::size_t k = 0; k < objectives; ++k) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return all[a].point.objectives[k] < all[b].point.objectives[k];
    });
    const double low = all[order.front()].point.objectives[k];
    const double high = all[order.back()].point.objectives[k];
    all[order.front()].crowding = all[order.back()].crowding =
        std::numeric_limits<double>::infinity();
    if (!(high > low) || !std::isfinite(high)) continue;
    for (std::size_t i = 1; i + 1 < order.size(); ++i) {
      all[order[i]].crowding +=
          (all[order[i + 1]].point.objectives[k] - all[order[i - 1]].point.objectives[k]) /
          (high - low);
    }
  }
}

/// The best `count` by rank, then by crowding.
std::vector<Individual> Select(std::vector<Individual> all, std::size_t count) {
  std::vector<Individual> chosen;
  for (std::vector<std::size_t>& front : SortFronts(all)) {
    AssignCrowding(all, front);
    if (chosen.size() + front.size() > count) {
      std::stable_sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
        return all[a].crowding > all[b].crowding;
      });
    }
    for (const std::size_t i : front) {
      if (chosen.size() >= count) return chosen;
      chosen.push_back(std::move(all[i]));
    }
  }
  return chosen;
}

class Nsga2 {
 public:
  Nsga2(const Problem& problem, const Nsga2Options& options, const Control& control)
      : problem_(problem),
        options_(options),
        evaluator_(problem, control),
        space_(problem, problem.GetStart()),
        random_(options.seed),
        population_size_(static_cast<std::size_t>((std::max(8, options.population) + 7) / 8 * 8)) {}

  Front Run() {
    Front front;
    int generation = 0;
    try {
      Begin();
      for (; generation < options_.generations && space_.size() > 0; ++generation) {
        std::vector<Individual> children = MakeChildren();
        Evaluate(children);
        for (Individual& child : children) population_.push_back(std::move(child));
        population_ = Select(std::move(population_), population_size_);
      }
    } catch (const SearchStopped&) {
      // The archive has what was found.
    }
    front.points = Thin();
    front.evaluations = evaluator_.evaluations();
    front.cancelled = evaluator_.cancelled();
    front.status = evaluator_.cancelled()
                       ? "cancelled; the front so far"
                       : fmt::format("{} generations of {}", generation, population_size_);
    if (front.points.empty()) front.status += "; no design that fulfils all constraints was found";
    return front;
  }

 private:
  void Begin() {
    std::vector<std::vector<double>> known = options_.starts;
    known.insert(known.begin(), problem_.GetStart());
    const std::size_t dim = space_.size();
    const std::vector<double> sample = MakeLatinHypercube(population_size_, dim, random_);
    for (std::size_t p = 0; p < population_size_; ++p) {
      Individual individual;
      if (p < known.size()) {
        individual.u = space_.CalcU(known[p]);
      } else {
        individual.u.assign(sample.begin() + static_cast<std::ptrdiff_t>(p * dim),
                            sample.begin() + static_cast<std::ptrdiff_t>((p + 1) * dim));
      }
      population_.push_back(std::move(individual));
    }
    Evaluate(population_);
    population_ = Select(std::move(population_), population_size_);
  }

  void Evaluate(std::vector<Individual>& individuals) {
    const std::size_t n = problem_.size();
    const std::size_t objectives = problem_.objective_names.size();
    batch_.Resize(problem_, individuals.size(), false);
    for (std::size_t p = 0; p < individuals.size(); ++p) {
      Individual& individual = individuals[p];
      space_.Project(individual.u);
      individual.point.x.resize(n);
      space_.CalcX(individual.u, individual.point.x);
      std::copy(individual.point.x.begin(), individual.point.x.end(),
                batch_.points.begin() + static_cast<std::ptrdiff_t>(p * n));
    }
    evaluator_.Evaluate(batch_);
    for (std::size_t p = 0; p < individuals.size(); ++p) {
      Individual& individual = individuals[p];
      const auto from = batch_.objectives.begin() + static_cast<std::ptrdiff_t>(p * objectives);
      individual.point.objectives.assign(from, from + static_cast<std::ptrdiff_t>(objectives));
      individual.violation = CalcViolation(problem_, batch_, p);
      if (individual.violation == 0) AddToArchive(individual.point);
    }
  }

  void AddToArchive(const FrontPoint& point) {
    for (const FrontPoint& other : archive_) {
      if (Dominates(other.objectives, point.objectives) || other.objectives == point.objectives) {
        return;
      }
    }
    std::erase_if(archive_, [&](const FrontPoint& other) {
      return Dominates(point.objectives, other.objectives);
    });
    archive_.push_back(point);
  }

  /// The archive without its most crowded points, until no more than a population is left.
  std::vector<FrontPoint> Thin() {
    std::vector<Individual> all;
    for (FrontPoint& point : FilterFront(std::move(archive_))) {
      Individual individual;
      individual.point = std::move(point);
      individual.violation = 0;
      all.push_back(std::move(individual));
    }
    while (all.size() > population_size_) {
      std::vector<std::size_t> front(all.size());
      std::iota(front.begin(), front.end(), std::size_t{0});
      AssignCrowding(all, front);
      const auto most = std::min_element(
          all.begin(), all.end(),
          [](const Individual& a, const Individual& b) { return a.crowding < b.crowding; });
      all.erase(most);
    }
    std::vector<FrontPoint> points;
    for (Individual& individual : all) points.push_back(std::move(individual.point));
    return points;
  }

  const Individual& Tournament() {
    const Individual& a = population_[random_.Index(population_.size())];
    const Individual& b = population_[random_.Index(population_.size())];
    if (a.rank != b.rank) return a.rank < b.rank ? a : b;
    return a.crowding >= b.crowding ? a : b;
  }

  std::vector<Individual> MakeChildren() {
    std::vector<Individual> children;
    while (children.size() < population_size_) {
      std::vector<double> a = Tournament().u;
      std::vector<double> b = Tournament().u;
      if (random_.Uniform() < options_.crossover_probability) Cross(a, b);
      for (std::vector<double>* u : {&a, &b}) {
        Mutate(*u);
        Individual child;
        child.u = std::move(*u);
        children.push_back(std::move(child));
      }
    }
    return children;
  }

  void Cross(std::vector<double>& a, std::vector<double>& b) {
    const double exponent = 1 / (options_.crossover_index + 1);
    for (std::size_t k = 0; k < a.size(); ++k) {
      if (random_.Uniform() > 0.5 || std::abs(a[k] - b[k]) < 1e-14) continue;
      const double low = std::min(a[k], b[k]);
      const double high = std::max(a[k], b[k]);
      const double u = random_.Uniform();
      const auto spread = [&](double room) {
        const double beta = 1 + 2 * room / (high - low);
        const double alpha = 2 - std::pow(beta, -(options_.crossover_index + 1));
        return u <= 1 / alpha ? std::pow(u * alpha, exponent)
                              : std::pow(1 / (2 - u * alpha), exponent);
      };
      double first = 0.5 * (low + high - spread(low) * (high - low));
      double second = 0.5 * (low + high + spread(1 - high) * (high - low));
      if (random_.Uniform() < 0.5) std::swap(first, second);
      a[k] = std::clamp(first, 0.0, 1.0);
      b[k] = std::clamp(second, 0.0, 1.0);
    }
  }

  void Mutate(std::vector<double>& u) {
    const double probability = options_.mutation_probability > 0
                                   ? options_.mutation_probability
                                   : 1 / static_cast<double>(u.size());
    const double power = options_.mutation_index + 1;
    for (double& value : u) {
      if (random_.Uniform() >= probability) continue;
      const double r = random_.Uniform();
      if (r < 0.5) {
        value += std::pow(2 * r + (1 - 2 * r) * std::pow(1 - value, power), 1 / power) - 1;
      } else {
        value += 1 - std::pow(2 * (1 - r) + (2 * r - 1) * std::pow(value, power), 1 / power);
      }
      value = std::clamp(value, 0.0, 1.0);
    }
  }

  const Problem& problem_;
  const Nsga2Options& options_;
  DirectEvaluator evaluator_;
  SearchSpace space_;
  Random random_;
  std::size_t population_size_;
  Batch batch_;
  std::vector<Individual> population_;
  std::vector<FrontPoint> archive_;
};

}  // namespace

Front RunNsga2(const Problem& problem, const Nsga2Options& options, const Control& control) {
  CheckProblem(problem);
  if (!problem.equalities.names.empty()) {
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = problem.equalities.names.front(),
                          .found = "a nonlinear equality with nsga2",
                          .expected = "bounds, linear constraints and inequalities",
                          .suggestion = "use a weighted sweep"});
  }
  for (const auto& start : options.starts) CheckPoint(problem, start, "start");
  return Nsga2(problem, options, control).Run();
}

}  // namespace kingpin::optimisation
