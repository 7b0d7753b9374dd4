#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/parameters/derived_quantity.h"
#include "models/planar/parameters.h"
#include "optimisation/algorithms/result.h"
#include "optimisation/measures/gammas.h"
#include "optimisation/study/design_evaluator.h"
#include "optimisation/study/design_space.h"
#include "optimisation/study/study_definition.h"

/// What a study found. Plain values; the report and the result files are written from them.
namespace kingpin::study {

/// One design: the initial one, a given one, or the end of a search.
struct DesignResult {
  std::string name;  ///< of the stage; `initial` for the first
  planar::Parameters<double> parameters;
  measures::Gammas<double> gammas{};
  double road_feel_gain = 0.0;
  double static_road_feel_gain = 0.0;  ///< its limit at 0 Hz
  double steering_ratio = 0.0;
  std::string relative_to;           ///< the design whose Γ_k divide
  double sum_of_ratios = 0.0;        ///< Σ ε_k Γ_k / Γ_k(relative_to), the paper's I_V
  std::optional<DesignSpace> space;  ///< of a search
  std::optional<optimisation::Result> search;  ///< of a search
  double seconds = 0.0;                        ///< wall time of the search
  long simulations = 0;
};

/// ∂Γ_k/∂x_i at one design, all variables of the case.
struct SensitivityResult {
  std::string design;
  DesignSpace space;
  std::vector<measures::Gammas<double>> derivative;  ///< per variable
  std::vector<double> road_feel_derivative;
};

struct ParetoPointResult {
  double road_feel_gain = 0.0;
  double sum_of_ratios = 0.0;  ///< to the initial design
  planar::Parameters<double> parameters;
};

struct CaseResult {
  std::string name;
  std::string paper_set;                  ///< name of the set in paper mode
  parameters::DerivedQuantities derived;  ///< of car mode
  measures::Conventions conventions;
  std::vector<WeightedLoad> loads;
  std::vector<DesignResult> designs;
  std::vector<SensitivityResult> sensitivities;
  std::vector<ParetoPointResult> pareto;
  std::vector<std::string> warnings;

  /// The design of a stage; must exist.
  const DesignResult& Find(const std::string& name) const;
};

struct StudyResult {
  StudyDefinition definition;
  std::vector<CaseResult> cases;
  double seconds = 0.0;
  long simulations = 0;
  bool cancelled = false;
};

}  // namespace kingpin::study
