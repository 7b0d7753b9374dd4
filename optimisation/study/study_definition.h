#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "models/parameters/car.h"
#include "models/planar/car_reduction.h"
#include "models/planar/excitation.h"
#include "optimisation/algorithms/algorithm.h"
#include "optimisation/measures/conventions.h"
#include "optimisation/study/scalar_fields.h"

/// What a study file says, after reading and checking. SI units.
namespace kingpin::study {

/// Where the parameters of the planar model come from: a car (car mode) or an identified set (paper
/// mode).
struct ModelSource {
  std::optional<parameters::Car> car;
  planar::CarModeOptions options;  ///< of car mode
  std::filesystem::path paper_set;
};

/// One road-force history with its weight in the objective.
struct LoadCase {
  std::string name;
  double weight = 1.0;
  std::vector<planar::Pulse> pulses;
  std::filesystem::path history;  ///< CSV with time and force, added to the pulses
};

/// Reads the history if there is one. Throws io::InputError.
planar::Excitation MakeExcitation(const LoadCase& load_case);

/// Bounds of one scalar design variable. It starts from the model's own value unless a start is
/// given.
struct VariableBounds {
  double lower = 0.0;
  double upper = 0.0;
  std::optional<double> start;
};

/// By index in ScalarFields().
using VariableTable = std::array<std::optional<VariableBounds>, kScalarFieldCount>;

/// Values of some scalars, by index in ScalarFields().
using DesignValues = std::array<std::optional<double>, kScalarFieldCount>;

/// Shape conditions and bounds of a characteristic whose node values are design variables.
struct CurveBounds {
  double fraction = 0.1;  ///< each node value may move by this fraction of its start value
  bool odd = false;       ///< one variable for x and −x
  bool monotone = true;   ///< never falls with x, at the nodes and between them
};

struct CurveTable {
  std::optional<CurveBounds> assistance;
  std::optional<CurveBounds> longitudinal;
};

enum class Quantity { kRoadFeelGain, kSteeringRatio };

/// A quantity that must stay within limits, which are ratios to its value at the case's initial
/// design.
struct Constraint {
  Quantity quantity = Quantity::kRoadFeelGain;
  std::optional<double> minimum_ratio;
  std::optional<double> maximum_ratio;
};

/// One step of a strategy: free some variables, start somewhere, minimise; or only evaluate a given
/// design.
struct Stage {
  std::string name;
  std::vector<std::string> free;  ///< variables and curves; empty: the design is only evaluated
  std::string start = "initial";  ///< the stage whose design it starts from
  std::vector<std::string> also_from;  ///< stages whose designs the search starts from besides
  std::string relative_to;  ///< Γ_k are divided by those of this stage; empty: of `start`
  optimisation::Algorithm algorithm = optimisation::Algorithm::kMultistart;
  CurveTable curves;         ///< replaces the case's bounds of the same curve
  DesignValues design{};     ///< set before the search
  long max_evaluations = 0;  ///< 0: the algorithm's own default
  int random_starts = 0;     ///< repeated from so many random starts: how unique is the optimum?
  bool further = false;      ///< goes beyond the paper: shown on that page of the report
};

/// Values printed in a publication, to be shown beside ours.
struct PrintedDesign {
  std::string stage;
  std::string table;
  std::string figure;  ///< `Fig. 7`: printed history (a) and spectrum (b) of the rim acceleration
  std::array<std::optional<double>, 5> gamma{};
  std::optional<double> sum_of_ratios;
  DesignValues design{};
  std::optional<double> seconds;  ///< computing time
};

/// A front of kickback (sum of ratios to the initial design) against road feel.
struct ParetoRequest {
  std::vector<std::string> free;
  CurveTable curves;
  int population = 64;
  int generations = 60;
};

struct Case {
  std::string name;
  ModelSource model;
  std::vector<LoadCase> load_cases;  ///< none in paper mode: the set brings its own
  VariableTable variables{};
  CurveTable curves;
  std::vector<Constraint> constraints;
  std::vector<Stage> stages;
  std::vector<PrintedDesign> printed;
  std::optional<ParetoRequest> pareto;
};

struct MeasureOptions {
  enum class Preset { kDefault, kPaperSet };
  Preset preset = Preset::kDefault;
  std::optional<std::string> weighting;
  std::filesystem::path weighting_file;
  std::optional<double> window;
  std::optional<double> decay_level;
  std::optional<double> f1;
  std::optional<double> f2;
  std::optional<bool> gamma_3_root;
  std::array<double, 5> weights{1, 1, 1, 1, 1};  ///< ε_k of (3.9)
};

/// The conventions in force; `gamma_3_scale` is the paper set's c_3.
measures::Conventions MakeConventions(const MeasureOptions& options, double gamma_3_scale);

struct StudyDefinition {
  std::string name;
  std::string description;
  double duration = 1.0;
  double sample_interval = 1e-3;
  std::uint64_t seed = 1;
  MeasureOptions measures;
  std::vector<Case> cases;

  const std::array<double, 5>& weights() const { return measures.weights; }
};

}  // namespace kingpin::study
