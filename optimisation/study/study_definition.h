#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "models/planar/car_reduction.h"
#include "models/planar/excitation.h"
#include "optimisation/measures/conventions.h"

/// What a study file says, after reading and checking. SI units.
namespace kingpin::study {

/// One road-force history with its weight in the objective.
struct LoadCase {
  std::string name;
  double weight = 1.0;
  planar::Excitation excitation;
};

/// Where the parameters of the planar model come from: a car (car mode) or an identified set (paper mode).
struct ModelSource {
  std::string car_file;        ///< kind: car
  planar::CarModeOptions car;  ///< options of car mode
  std::string paper_set_file;  ///< an identified parameter set; exactly one of the two files is given
};

/// Bounds of one scalar design variable. Its start is the model's own value unless given.
struct VariableBounds {
  std::string name;  ///< see design_space.h for the names
  double lower = 0.0;
  double upper = 0.0;
  std::optional<double> start;
};

/// Shape conditions and bounds of a characteristic whose node values are design variables.
struct CurveBounds {
  std::string name;       ///< `assistance` or `longitudinal`
  double fraction = 0.1;  ///< each node value may move by this fraction of its start value
  bool odd = false;       ///< one variable for x and −x
  bool monotone = true;   ///< node values never decrease with x
};

/// A quantity that must stay on one side of a limit. Limits are ratios to the case's initial design.
struct Constraint {
  std::string quantity;  ///< e.g. `road_feel_gain`
  std::optional<double> minimum_ratio;
  std::optional<double> maximum_ratio;
};

/// One step of a strategy: free some variables, start somewhere, minimise, or only evaluate a given design.
struct Stage {
  std::string name;
  std::vector<std::string> free;  ///< variables and curves; empty for a design that is only evaluated
  std::string start = "initial";  ///< name of the earlier stage whose design it starts from
  std::vector<std::string> also_from;  ///< further designs that a search starts from
  std::string relative_to;             ///< Γ_k are divided by those of this stage; empty: of `start`
  std::string algorithm = "global";    ///< see optimisation/algorithms
  std::vector<CurveBounds> curves;     ///< replaces the case's curve bounds of the same name
  std::map<std::string, double> design;  ///< values set before the search, by variable name
  int max_evaluations = 0;               ///< 0: the algorithm's own default
  int random_starts = 0;    ///< repeated from so many random starts, to show how unique the optimum is
  bool constrained = true;  ///< false: the case's constraints do not bind this stage
};

/// Values printed in a publication, to be shown beside ours.
struct PrintedDesign {
  std::string stage;
  std::map<std::string, double> design;
  std::array<double, 5> gamma{};  ///< NaN where nothing is printed
  std::optional<double> sum_of_ratios;
};

/// A front of kickback (sum of ratios) against road feel.
struct ParetoRequest {
  std::vector<std::string> free;  ///< empty: no front
  std::vector<CurveBounds> curves;
  int population = 64;
  int generations = 40;
};

struct Case {
  std::string name;
  ModelSource model;
  std::vector<LoadCase> load_cases;
  std::vector<VariableBounds> variables;
  std::vector<CurveBounds> curves;
  std::vector<Constraint> constraints;
  std::vector<Stage> stages;
  std::vector<PrintedDesign> printed;
  ParetoRequest pareto;
};

struct StudyDefinition {
  std::string name;
  std::string description;
  double duration = 1.0;
  double sample_interval = 1e-3;
  measures::Conventions measures;
  std::array<double, 5> weights{1, 1, 1, 1, 1};  ///< ε_k of (3.9)
  std::uint64_t seed = 1;
  std::vector<Case> cases;
};

}  // namespace kingpin::study
