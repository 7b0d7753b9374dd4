#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace kingpin::optimisation {

/// What every algorithm is given beside the problem.
struct Control {
  /// Evaluations of the objective in all, differences included; 0 is no limit. When it is reached,
  /// all searches end with the best so far.
  long max_evaluations = 0;
  /// Asked before every batch; true ends the optimisation with the best so far (Ctrl-C).
  std::function<bool()> cancelled;
  /// Called after every batch on the caller's thread.
  std::function<void(long evaluations, double best)> progress;
};

/// The best value after a number of evaluations; one entry for each improvement, and the last one.
struct HistoryPoint {
  long evaluations = 0;
  double value = 0;
};

/// A bound or constraint that the optimum touches.
struct ActiveConstraint {
  std::string name;  ///< the variable's or constraint's name
  std::string kind;  ///< `lower bound`, `upper bound`, `linear`, `inequality`, `equality`
  /// Lagrange multiplier in objective per unit of the variable or constraint: by how much the
  /// objective would fall per unit of loosening, to first order. Positive (or zero) at a minimum
  /// for everything but equalities; empty when the gradient is not finite.
  std::optional<double> multiplier;
};

/// One local search of a global strategy.
struct Restart {
  std::vector<double> start;
  double start_value = 0;
  std::vector<double> end;
  double value = 0;
  long evaluations = 0;
  std::string status;
  int minimum = -1;  ///< index into Result::minima; -1 when it found no design
};

/// A distinct local minimum: ends of searches within Result::cluster_distance of its best one.
struct LocalMinimum {
  std::vector<double> x;
  double value = 0;
  int searches = 0;
};

struct Result {
  std::vector<double> x;
  double value = std::numeric_limits<double>::infinity();
  double start_value = std::numeric_limits<double>::infinity();
  bool feasible = false;          ///< finite value and all constraints fulfilled
  bool cancelled = false;         ///< stopped from outside; x is the best so far
  long evaluations = 0;           ///< of the objective, points of differences included
  long gradient_evaluations = 0;  ///< with exact derivatives
  std::string algorithm;
  std::string status;  ///< in words, why it ended
  std::vector<HistoryPoint> history;
  std::vector<ActiveConstraint> active;
  /// How unique the optimum is.
  std::vector<Restart> restarts;
  std::vector<LocalMinimum> minima;  ///< best first
  double cluster_distance = 0;       ///< largest difference of a variable, as a part of its range
  double spread = 0;  ///< (worst - best) / |best| over the ends of the restarts that found a design
};

}  // namespace kingpin::optimisation
