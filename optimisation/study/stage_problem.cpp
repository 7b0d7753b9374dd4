#include "optimisation/study/stage_problem.h"

#include <limits>

#include "models/planar/linear_road_feel.h"
#include "models/planar/planar_model.h"
#include "optimisation/study/quantities.h"

namespace kingpin::study {
namespace {

using Dual1 = math::Dual<double, 1>;
using measures::Gammas;
using planar::Parameters;

template <class S>
S CalcQuantityOf(Quantity quantity, const Parameters<S>& design) {
  switch (quantity) {
    case Quantity::kRoadFeelGain:
      return planar::CalcRoadFeelGain(design);
    case Quantity::kSteeringRatio:
      return CalcSteeringRatio(design);
  }
  return S(0.0);
}

/// Design number i of n rows of variables.
std::span<const double> Row(std::span<const double> points, std::size_t i, std::size_t size) {
  return points.subspan(i * size, size);
}

std::vector<Parameters<double>> ApplyAll(const DesignSpace& space, std::span<const double> points) {
  const auto size = static_cast<std::size_t>(space.size());
  std::vector<Parameters<double>> designs;
  designs.reserve(points.size() / size);
  for (std::size_t i = 0; i * size < points.size(); ++i) {
    designs.push_back(space.Apply(Row(points, i, size)));
  }
  return designs;
}

void AddVariables(const DesignSpace& space, optimisation::Problem& problem) {
  for (const DesignVariable& v : space.variables()) {
    problem.variables.push_back({v.name, v.unit, v.lower, v.upper, v.start});
  }
  for (const MonotoneCondition& condition : space.monotone()) {
    problem.linear.push_back({condition.name, condition.coefficients, condition.bound, false});
  }
}

/// One inequality c(x) = sign (q(x)/q_initial − limit) ≤ 0.
struct Bound {
  Quantity quantity;
  double initial;
  double sign;
  double limit;
};

void AddLimits(const DesignSpace& space, const std::vector<QuantityLimit>& limits,
               optimisation::Problem& problem) {
  std::vector<Bound> bounds;
  for (const QuantityLimit& limit : limits) {
    if (limit.minimum) {
      bounds.push_back({limit.quantity, limit.initial, -1.0, *limit.minimum});
      problem.inequalities.names.push_back(GetName(limit.quantity) + " at its minimum");
    }
    if (limit.maximum) {
      bounds.push_back({limit.quantity, limit.initial, 1.0, *limit.maximum});
      problem.inequalities.names.push_back(GetName(limit.quantity) + " at its maximum");
    }
  }
  if (bounds.empty()) return;
  problem.inequalities.values = [&space, bounds](std::span<const double> points,
                                                 std::span<double> values) {
    const auto size = static_cast<std::size_t>(space.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i * size < points.size(); ++i) {
      const Parameters<double> design = space.Apply(Row(points, i, size));
      for (const Bound& b : bounds) {
        values[next++] = b.sign * (CalcQuantityOf(b.quantity, design) / b.initial - b.limit);
      }
    }
  };
  problem.inequalities.gradients = [&space, bounds](std::span<const double> points,
                                                    std::span<double> values,
                                                    std::span<double> gradients) {
    const auto size = static_cast<std::size_t>(space.size());
    for (std::size_t i = 0; i * size < points.size(); ++i) {
      for (std::size_t direction = 0; direction < size; ++direction) {
        const Tangent design =
            space.ApplyTangent(Row(points, i, size), static_cast<int>(direction));
        for (std::size_t j = 0; j < bounds.size(); ++j) {
          const Bound& b = bounds[j];
          const Dual1 q = CalcQuantityOf(b.quantity, design);
          values[i * bounds.size() + j] = b.sign * (q.v / b.initial - b.limit);
          gradients[(i * bounds.size() + j) * size + direction] = b.sign * q.d[0] / b.initial;
        }
      }
    }
  };
}

}  // namespace

double CalcQuantity(Quantity quantity, const Parameters<double>& design) {
  return CalcQuantityOf(quantity, design);
}

bool HasSwitchingForces(const Parameters<double>& design) {
  return planar::MakeModel(design).structure.has_events();
}

Parameters<double> MakeSmooth(const Parameters<double>& design) {
  Parameters<double> smooth = design;
  if (smooth.friction_law == planar::FrictionLaw::kCoulomb) {
    smooth.friction_law = planar::FrictionLaw::kNone;
  }
  smooth.stop_angle = 0.0;
  smooth.rod_free_play = 0.0;
  return smooth;
}

std::string GetName(Quantity quantity) {
  return quantity == Quantity::kRoadFeelGain ? "road_feel_gain" : "steering_ratio";
}

optimisation::Problem MakeStageProblem(const DesignSpace& space, DesignEvaluator& evaluator,
                                       const Gammas<double>& reference,
                                       const std::array<double, 5>& weights,
                                       const std::vector<QuantityLimit>& limits) {
  optimisation::Problem problem;
  problem.objective_names = {"sum of ratios"};
  AddVariables(space, problem);
  AddLimits(space, limits, problem);
  problem.objective = [&space, &evaluator, reference, weights](std::span<const double> points,
                                                               std::span<double> values) {
    const std::vector<Parameters<double>> designs = ApplyAll(space, points);
    std::vector<Gammas<double>> gammas(designs.size());
    evaluator.Calc(designs, gammas);
    for (std::size_t i = 0; i < designs.size(); ++i) {
      values[i] = measures::CalcObjective(gammas[i], reference, weights);
    }
  };
  // Switching forces (dry friction, stops, play) make the measures rough on the scale of a search's
  // steps: derivatives would lead it astray, and cost most there.
  if (HasSwitchingForces(space.base())) return problem;
  problem.gradient = [&space, &evaluator, reference, weights](std::span<const double> points,
                                                              std::span<double> values,
                                                              std::span<double> gradients) {
    const auto size = static_cast<std::size_t>(space.size());
    std::vector<Tangent> tangents(size);
    std::vector<Gammas<double>> derivatives(size);
    for (std::size_t i = 0; i * size < points.size(); ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        tangents[j] = space.ApplyTangent(Row(points, i, size), static_cast<int>(j));
      }
      const Gammas<double> gammas = evaluator.CalcWithDerivatives(tangents, derivatives);
      values[i] = measures::CalcObjective(gammas, reference, weights);
      for (std::size_t j = 0; j < size; ++j) {
        gradients[i * size + j] = measures::CalcObjective(derivatives[j], reference, weights);
      }
    }
  };
  return problem;
}

optimisation::Problem MakeParetoProblem(const DesignSpace& space, DesignEvaluator& evaluator,
                                        const Gammas<double>& reference,
                                        const std::array<double, 5>& weights,
                                        double initial_road_feel) {
  optimisation::Problem problem;
  problem.objective_names = {"sum of ratios", "loss of road feel"};
  AddVariables(space, problem);
  problem.objective = [&space, &evaluator, reference, weights, initial_road_feel](
                          std::span<const double> points, std::span<double> values) {
    const std::vector<Parameters<double>> designs = ApplyAll(space, points);
    std::vector<Gammas<double>> gammas(designs.size());
    evaluator.Calc(designs, gammas);
    for (std::size_t i = 0; i < designs.size(); ++i) {
      values[2 * i] = measures::CalcObjective(gammas[i], reference, weights);
      values[2 * i + 1] = -planar::CalcRoadFeelGain(designs[i]) / initial_road_feel;
    }
  };
  return problem;
}

}  // namespace kingpin::study
