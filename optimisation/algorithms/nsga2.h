#pragma once

#include <cstdint>
#include <vector>

#include "optimisation/algorithms/pareto.h"
#include "optimisation/algorithms/problem.h"
#include "optimisation/algorithms/result.h"

namespace kingpin::optimisation {

struct Nsga2Options {
  std::uint64_t seed = 1;
  int population = 64;  ///< rounded up to a multiple of 8 (the SIMD lanes)
  int generations = 100;
  double crossover_probability = 0.9;
  double crossover_index = 15;      ///< of simulated binary crossover: larger keeps children nearer
  double mutation_probability = 0;  ///< per variable; 0: one over the number of variables
  double mutation_index = 20;
  /// Known good designs to begin with (optima of single objectives), within the bounds.
  std::vector<std::vector<double>> starts;
};

/// Elitist non-dominated sorting genetic algorithm (Deb, Pratap, Agarwal, Meyarivan 2002) with
/// simulated binary crossover and polynomial mutation, both bounded. A whole generation is one
/// batch. Constraints by constraint domination: feasible before infeasible, then the smaller
/// violation. Points are moved into the linear constraints. Designs without finite objectives come
/// last.
///
/// The front holds the non-dominated of all designs ever evaluated that fulfil the constraints,
/// thinned by crowding to `population`. Throws io::InputError as Minimise() does.
Front RunNsga2(const Problem& problem, const Nsga2Options& options = {},
               const Control& control = {});

}  // namespace kingpin::optimisation
