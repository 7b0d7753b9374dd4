#pragma once

#include <span>
#include <vector>

#include "optimisation/algorithms/problem.h"
#include "optimisation/study/design_evaluator.h"
#include "optimisation/study/design_space.h"
#include "optimisation/study/study_definition.h"

/// The optimisation problem of one stage.
namespace kingpin::study {

/// Dry friction, torsion-bar stops, free play: forces that switch, so that designs are simulated
/// one by one with located events, and measures are rough on the scale of a search's steps.
bool HasSwitchingForces(const planar::Parameters<double>& design);

/// The same design without them: simulated in SIMD lanes, with exact derivatives.
planar::Parameters<double> MakeSmooth(const planar::Parameters<double>& design);

/// Values of the constrained quantities at a design.
double CalcQuantity(Quantity quantity, const planar::Parameters<double>& design);

/// A constraint with its limits as values of the quantity.
struct QuantityLimit {
  Quantity quantity = Quantity::kRoadFeelGain;
  double initial = 1.0;           ///< value at the case's initial design
  std::optional<double> minimum;  ///< ratio to it
  std::optional<double> maximum;
};

/// `road_feel_gain`, `steering_ratio`: as in study files.
std::string GetName(Quantity quantity);

/// f(x) = Σ ε_k Γ_k(x)/Γ_k^0, paper (3.9), in the space's bounds, with the curves' monotone
/// conditions as linear constraints and the limits as inequalities q(x)/q_initial − maximum ≤ 0,
/// minimum − q(x)/q_initial ≤ 0. All with exact derivatives. Space, evaluator and the arrays must
/// outlive the problem.
optimisation::Problem MakeStageProblem(const DesignSpace& space, DesignEvaluator& evaluator,
                                       const measures::Gammas<double>& reference,
                                       const std::array<double, 5>& weights,
                                       const std::vector<QuantityLimit>& limits);

/// Two objectives for the front: f(x) as above, and −(road-feel gain)/(its value at the initial
/// design).
optimisation::Problem MakeParetoProblem(const DesignSpace& space, DesignEvaluator& evaluator,
                                        const measures::Gammas<double>& reference,
                                        const std::array<double, 5>& weights,
                                        double initial_road_feel);

}  // namespace kingpin::study
