#include "optimisation/study/run_study.h"

#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "core/io/error.h"
#include "models/planar/linear_road_feel.h"
#include "optimisation/algorithms/nsga2.h"
#include "optimisation/study/model_source.h"
#include "optimisation/study/quantities.h"
#include "optimisation/study/stage_problem.h"
#include "optimisation/study/stage_search.h"

namespace kingpin::study {
namespace {

using measures::Gammas;
using planar::Parameters;

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What the stages of one case share.
struct CaseContext {
  const StudyDefinition& definition;
  const Case& c;
  const RunOptions& options;
  DesignEvaluator& evaluator;
  CaseResult& result;
  std::vector<QuantityLimit> limits;
};

DesignResult MakeDesign(const std::string& name, const Parameters<double>& parameters,
                        DesignEvaluator& evaluator) {
  DesignResult design;
  design.name = name;
  design.parameters = parameters;
  design.gammas = evaluator.Calc(parameters);
  design.road_feel_gain = planar::CalcRoadFeelGain(parameters);
  design.static_road_feel_gain = planar::CalcStaticRoadFeel(parameters);
  design.steering_ratio = CalcSteeringRatio(parameters);
  return design;
}

void Compare(DesignResult& design, const DesignResult& reference,
             const std::array<double, 5>& weights) {
  design.relative_to = reference.name;
  design.sum_of_ratios = measures::CalcObjective(design.gammas, reference.gammas, weights);
}

void NoteBounds(const DesignResult& design, CaseResult& result) {
  std::vector<std::string> names;
  for (const auto& active : design.search->active)
    names.push_back(active.name + " (" + active.kind + ")");
  if (names.empty()) return;
  result.warnings.push_back(fmt::format("{} lies on {} of its limits: {}.", design.name,
                                        names.size(), fmt::join(names, ", ")));
}

StageSearch MakeSearch(const DesignSpace& space, const DesignResult& reference,
                       CaseContext& context) {
  return {.space = space,
          .reference = reference.parameters,
          .weights = context.definition.weights(),
          .limits = context.limits,
          .cancelled = context.options.cancelled};
}

/// A given design that lies well above the optimum found, but is itself the end of a descent, is a
/// local one.
void NoteLocalOptimum(const Stage& given, const DesignResult& optimum, CaseContext& context) {
  const DesignResult& design = context.result.Find(given.name);
  const Gammas<double>& reference = context.result.Find(optimum.relative_to).gammas;
  const double value =
      measures::CalcObjective(design.gammas, reference, context.definition.weights());
  constexpr double kNoticeable = 1e-3;
  if (value <= optimum.sum_of_ratios * (1.0 + kNoticeable)) return;
  // A descent that starts there and ends there: a local minimum.
  const std::vector<double> x = optimum.space->Extract(design.parameters);
  const StageSearch search =
      MakeSearch(*optimum.space, context.result.Find(optimum.relative_to), context);
  const double descended = RefineFrom(search, x, context.evaluator).value;
  const bool is_local = descended > value * (1.0 - kNoticeable);
  context.result.warnings.push_back(
      fmt::format("{} ({:.4g}) is {}: {} found {:.4g}, {:.1f} % lower.", design.name, value,
                  is_local ? "only local" : "not a minimum", optimum.name, optimum.sum_of_ratios,
                  100.0 * (1.0 - optimum.sum_of_ratios / value)));
}

void RunStage(const Stage& stage, std::size_t number, CaseContext& context) {
  CaseResult& result = context.result;
  const DesignResult& start = result.Find(stage.start);
  const DesignResult& reference =
      result.Find(stage.relative_to.empty() ? stage.start : stage.relative_to);
  Parameters<double> base = start.parameters;
  SetScalars(base, stage.design);
  if (stage.free.empty()) {
    DesignResult design = MakeDesign(stage.name, base, context.evaluator);
    Compare(design, reference, context.definition.weights());
    result.designs.push_back(std::move(design));
    return;
  }
  const long before = context.evaluator.simulations();
  const std::string where =
      fmt::format("{}: case '{}', stage '{}'", context.options.file, context.c.name, stage.name);
  const DesignSpace space =
      DesignSpace::Make(base, result.designs.front().parameters, stage.free, context.c.variables,
                        MergeCurves(context.c.curves, stage.curves), where);
  StageSearch request = MakeSearch(space, reference, context);
  request.algorithm = stage.algorithm;
  for (const std::string& name : stage.also_from) {
    request.starts.push_back(space.Extract(result.Find(name).parameters));
  }
  request.random_starts = stage.random_starts;
  request.max_evaluations = stage.max_evaluations;
  request.seed = context.definition.seed + 1000 * number;
  auto [search, seconds] = SearchStage(request, context.evaluator);
  if (!std::isfinite(search.value)) {
    throw io::RunError(where + ": no design with finite measures was found");
  }
  DesignResult design = MakeDesign(stage.name, space.Apply(search.x), context.evaluator);
  Compare(design, reference, context.definition.weights());
  design.space = space;
  design.search = std::move(search);
  design.seconds = seconds;
  design.simulations = context.evaluator.simulations() - before;
  NoteBounds(design, result);
  result.designs.push_back(std::move(design));
  for (const Stage& given : context.c.stages) {
    if (&given == &stage) break;
    // Only designs of the same freedom can be compared: given ones that differ in scalars alone.
    if (given.free.empty() && stage.start == "initial") {
      NoteLocalOptimum(given, result.designs.back(), context);
    }
  }
}

/// All scalars with bounds and all curves with bounds: what sensitivities are taken with respect
/// to.
std::vector<std::string> BoundedNames(const Case& c, const Parameters<double>& design) {
  std::vector<std::string> names;
  const auto fields = ScalarFields<double>();
  for (int i = 0; i < kScalarFieldCount; ++i) {
    if (c.variables[i]) names.emplace_back(fields[i].name);
  }
  if (c.curves.assistance && design.assist_force.count > 0) names.emplace_back("assistance");
  if (c.curves.longitudinal) names.emplace_back("longitudinal");
  return names;
}

void AddSensitivity(const DesignResult& design, CaseContext& context) {
  const Parameters<double>& initial = context.result.designs.front().parameters;
  const std::vector<std::string> names = BoundedNames(context.c, design.parameters);
  if (names.empty()) return;
  // A design given in the file may lie outside the bounds; its derivatives need none.
  VariableTable bounds = context.c.variables;
  for (int i = 0; i < kScalarFieldCount; ++i) {
    if (!bounds[i]) continue;
    const double value = design.parameters.*(ScalarFields<double>()[i].member);
    bounds[i]->lower = std::min(bounds[i]->lower, value);
    bounds[i]->upper = std::max(bounds[i]->upper, value);
  }
  SensitivityResult sensitivity{design.name,
                                DesignSpace::Make(design.parameters, initial, names, bounds,
                                                  context.c.curves, context.options.file),
                                {},
                                {}};
  const DesignSpace& space = sensitivity.space;
  const std::vector<double> x = space.Extract(design.parameters);
  std::vector<Tangent> tangents;
  for (int i = 0; i < space.size(); ++i) tangents.push_back(space.ApplyTangent(x, i));
  sensitivity.derivative.resize(tangents.size());
  context.evaluator.CalcWithDerivatives(tangents, sensitivity.derivative);
  for (const Tangent& tangent : tangents) {
    sensitivity.road_feel_derivative.push_back(planar::CalcRoadFeelGain(tangent).d[0]);
  }
  context.result.sensitivities.push_back(std::move(sensitivity));
}

/// The last search that is not shown on the page beyond the paper: the case's own optimum.
const DesignResult* FindOptimum(const Case& c, const CaseResult& result) {
  const DesignResult* optimum = nullptr;
  for (const Stage& stage : c.stages) {
    if (stage.free.empty() || stage.further) continue;
    const DesignResult& design = result.Find(stage.name);
    optimum = &design;
  }
  return optimum;
}

/// The front is searched in the smooth model, its designs are then evaluated in the model as it is.
void RunPareto(CaseContext& context) {
  const ParetoRequest& request = *context.c.pareto;
  const DesignResult& initial = context.result.designs.front();
  const std::string where =
      fmt::format("{}: case '{}', pareto", context.options.file, context.c.name);
  const DesignSpace space =
      DesignSpace::Make(initial.parameters, initial.parameters, request.free, context.c.variables,
                        MergeCurves(context.c.curves, request.curves), where);
  const DesignSpace smooth_space = space.WithBase(MakeSmooth(initial.parameters));
  const auto& weights = context.definition.weights();
  const optimisation::Problem problem = MakeParetoProblem(
      smooth_space, context.evaluator, context.evaluator.Calc(MakeSmooth(initial.parameters)),
      weights, initial.road_feel_gain);
  optimisation::Nsga2Options options;
  options.population = request.population;
  options.generations = request.generations;
  options.seed = context.definition.seed + 7;
  for (const DesignResult& design : context.result.designs) {
    options.starts.push_back(space.Extract(design.parameters));
  }
  optimisation::Control control;
  control.cancelled = context.options.cancelled;
  const optimisation::Front found = optimisation::RunNsga2(problem, options, control);
  std::vector<std::vector<double>> candidates;
  for (const auto& point : found.points) candidates.push_back(point.x);
  // The designs found before belong to the front's space if they have no more freedom than it.
  for (const DesignResult& design : context.result.designs) {
    if (space.Contains(design.parameters)) candidates.push_back(space.Extract(design.parameters));
  }
  std::vector<Parameters<double>> designs;
  for (const auto& x : candidates) designs.push_back(space.Apply(x));
  std::vector<Gammas<double>> gammas(designs.size());
  context.evaluator.Calc(designs, gammas);
  std::vector<optimisation::FrontPoint> points;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const double sum = measures::CalcObjective(gammas[i], initial.gammas, weights);
    if (std::isfinite(sum)) {
      points.push_back({candidates[i], {sum, -planar::CalcRoadFeelGain(designs[i])}});
    }
  }
  for (const auto& point : optimisation::FilterFront(std::move(points))) {
    context.result.pareto.push_back(
        {-point.objectives[1], point.objectives[0], space.Apply(point.x)});
  }
}

class CaseRun {
 public:
  CaseRun(const StudyDefinition& definition, const Case& c, const RunOptions& options)
      : model_(LoadModel(c.model, c.load_cases)),
        evaluator_(model_.loads, definition.duration, definition.sample_interval,
                   MakeConventions(definition.measures, model_.gamma_3_scale), options.threads),
        context_{definition, c, options, evaluator_, result_, {}} {
    result_.name = c.name;
    result_.paper_set = model_.paper_set;
    result_.derived = model_.derived;
    result_.conventions = evaluator_.plan().conventions();
    result_.loads = model_.loads;
    result_.designs.reserve(c.stages.size() + 1);
    DesignResult initial = MakeDesign("initial", MakeInitialDesign(c, model_), evaluator_);
    for (const double gamma : initial.gammas) {
      if (!std::isfinite(gamma)) {
        throw io::RunError(
            fmt::format("{}: case '{}': the initial design makes no finite "
                        "measures: its simulation diverges",
                        options.file, c.name));
      }
    }
    Compare(initial, initial, definition.weights());
    for (const Constraint& constraint : c.constraints) {
      context_.limits.push_back({constraint.quantity,
                                 CalcQuantity(constraint.quantity, initial.parameters),
                                 constraint.minimum_ratio, constraint.maximum_ratio});
    }
    result_.designs.push_back(std::move(initial));
  }

  CaseContext& context() { return context_; }
  CaseResult& result() { return result_; }
  long simulations() const { return evaluator_.simulations(); }

 private:
  LoadedModel model_;
  DesignEvaluator evaluator_;
  CaseResult result_;
  CaseContext context_;
};

bool IsCancelled(const RunOptions& options) { return options.cancelled && options.cancelled(); }

}  // namespace

const DesignResult& CaseResult::Find(const std::string& name) const {
  for (const DesignResult& design : designs) {
    if (design.name == name) return design;
  }
  throw io::RunError("no design named '" + name + "' in case '" + this->name + "'");
}

CaseResult RunStages(const StudyDefinition& definition, const Case& c, const std::string& last,
                     const RunOptions& options) {
  CaseRun run(definition, c, options);
  for (std::size_t i = 0; i < c.stages.size(); ++i) {
    if (IsCancelled(options)) break;
    if (options.progress) {
      options.progress(c.name + ": " + c.stages[i].name,
                       static_cast<double>(i) / static_cast<double>(c.stages.size()));
    }
    RunStage(c.stages[i], i, run.context());
    if (c.stages[i].name == last) break;
  }
  return std::move(run.result());
}

StudyResult RunStudy(const StudyDefinition& definition, const RunOptions& options) {
  StudyResult study;
  study.definition = definition;
  const auto clock = std::chrono::steady_clock::now();
  std::size_t steps = 0, done = 0;
  for (const Case& c : definition.cases) steps += c.stages.size() + 1;
  const auto report = [&](const std::string& what) {
    if (options.progress)
      options.progress(what, static_cast<double>(done) / static_cast<double>(steps));
    ++done;
  };
  for (const Case& c : definition.cases) {
    if (IsCancelled(options)) break;
    CaseRun run(definition, c, options);
    for (std::size_t i = 0; i < c.stages.size() && !IsCancelled(options); ++i) {
      report(c.name + ": " + c.stages[i].name);
      RunStage(c.stages[i], i, run.context());
    }
    report(c.name + ": sensitivities and Pareto front");
    if (!IsCancelled(options)) {
      AddSensitivity(run.result().designs.front(), run.context());
      if (const DesignResult* optimum = FindOptimum(c, run.result())) {
        AddSensitivity(*optimum, run.context());
      }
    }
    if (c.pareto && !IsCancelled(options)) RunPareto(run.context());
    study.simulations += run.simulations();
    study.cases.push_back(std::move(run.result()));
  }
  study.cancelled = IsCancelled(options);
  study.seconds = SecondsSince(clock);
  return study;
}

}  // namespace kingpin::study
