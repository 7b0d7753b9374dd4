#include "optimisation/study/run_study.h"

#include <chrono>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "core/io/error.h"
#include "models/planar/linear_road_feel.h"
#include "optimisation/algorithms/minimise.h"
#include "optimisation/algorithms/nsga2.h"
#include "optimisation/study/model_source.h"
#include "optimisation/study/quantities.h"
#include "optimisation/study/stage_problem.h"

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

/// Random points in the bounds of a space, monotone conditions aside (the search repairs those).
std::vector<std::vector<double>> MakeRandomStarts(const DesignSpace& space, int count,
                                                  std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::vector<std::vector<double>> starts;
  for (int i = 0; i < count; ++i) {
    std::vector<double> x;
    for (const DesignVariable& v : space.variables()) {
      // 53 random bits: the same number on every platform, which std::uniform_real_distribution is
      // not.
      const double u = static_cast<double>(engine() >> 11) * 0x1p-53;
      x.push_back(v.lower + u * (v.upper - v.lower));
    }
    starts.push_back(std::move(x));
  }
  return starts;
}

/// Repeats the whole search from random starts and records where each ends: how unique is the
/// optimum?
void RepeatFromRandomStarts(const Stage& stage, const DesignSpace& space,
                            const optimisation::Problem& problem,
                            const optimisation::MinimiseOptions& options, std::uint64_t seed,
                            const optimisation::Control& control, optimisation::Result& result) {
  result.restarts.clear();
  double lowest = result.value, highest = result.value;
  std::uint64_t repeat_seed = seed;
  for (const std::vector<double>& start : MakeRandomStarts(space, stage.random_starts, seed)) {
    optimisation::Problem repeated = problem;
    for (std::size_t i = 0; i < start.size(); ++i) repeated.variables[i].start = start[i];
    optimisation::MinimiseOptions repeat_options = options;
    repeat_options.starts.clear();
    repeat_options.seed = ++repeat_seed;
    const optimisation::Result end = optimisation::Minimise(repeated, repeat_options, control);
    if (end.cancelled) break;
    result.restarts.push_back(
        {start, end.start_value, end.x, end.value, end.evaluations, end.status, -1});
    lowest = std::min(lowest, end.value);
    highest = std::max(highest, end.value);
    if (end.value < result.value && end.feasible) {
      result.x = end.x;
      result.value = end.value;
      result.active = end.active;
    }
  }
  result.spread = (highest - lowest) / std::abs(lowest);
}

/// A search works in scaled variables; what it puts on a bound may come back a rounding error
/// beside it.
void SnapToBounds(const DesignSpace& space, std::vector<double>& x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const DesignVariable& v = space.variables()[i];
    const double rounding = 1e-12 * (v.upper - v.lower);
    if (std::abs(x[i] - v.lower) < rounding) x[i] = v.lower;
    if (std::abs(x[i] - v.upper) < rounding) x[i] = v.upper;
  }
}

void NoteBounds(const DesignResult& design, CaseResult& result) {
  std::vector<std::string> names;
  for (const auto& active : design.search->active)
    names.push_back(active.name + " (" + active.kind + ")");
  if (names.empty()) return;
  result.warnings.push_back(fmt::format("{} lies on {} of its limits: {}.", design.name,
                                        names.size(), fmt::join(names, ", ")));
}

/// Effort in proportion to the number of variables. The measures are smooth to about 1e-6 of their
/// value (the simulation's own accuracy), so finer tolerances would follow noise.
optimisation::MinimiseOptions MakeSearchOptions(const Stage& stage, int variables,
                                                std::uint64_t seed) {
  optimisation::MinimiseOptions options;
  options.algorithm = stage.algorithm;
  options.seed = seed;
  options.multistart.samples = std::clamp(32 * variables, 128, 512);
  options.multistart.searches = 16;
  options.multistart.cma_es_evaluations = 80L * variables;
  options.multistart.polished = 2;
  options.polish.step_tolerance = 1e-6;
  options.polish.value_tolerance = 1e-9;
  options.polish.max_evaluations = 20 * variables;
  return options;
}

/// Searches from good starts in the model as it is, without derivatives.
optimisation::Result Refine(const optimisation::Problem& problem,
                            std::vector<std::vector<double>> starts,
                            const optimisation::Control& control) {
  optimisation::MinimiseOptions options;
  options.algorithm = optimisation::Algorithm::kNelderMead;
  options.local.initial_step = 0.03;
  options.local.step_tolerance = 1e-3;
  options.local.fresh_simplexes = 0;
  options.local.max_evaluations = 15 * static_cast<int>(problem.size());
  options.polish.enabled = false;
  options.starts = std::move(starts);
  return optimisation::Minimise(problem, options, control);
}

/// One search. A model with switching forces is searched in two passes: globally without them (in
/// SIMD lanes, with exact derivatives), then locally as it is from the minima found and from all
/// given starts.
optimisation::Result Search(const Stage& stage, const DesignSpace& space,
                            const DesignResult& reference, std::uint64_t seed, CaseContext& context,
                            double& seconds) {
  const auto clock = std::chrono::steady_clock::now();
  const auto& weights = context.definition.weights();
  optimisation::MinimiseOptions options = MakeSearchOptions(stage, space.size(), seed);
  for (const std::string& name : stage.also_from) {
    options.starts.push_back(space.Extract(context.result.Find(name).parameters));
  }
  optimisation::Control control;
  control.max_evaluations = stage.max_evaluations;
  control.cancelled = context.options.cancelled;
  const optimisation::Problem problem =
      MakeStageProblem(space, context.evaluator, reference.gammas, weights, context.limits);
  if (!HasSwitchingForces(space.base())) {
    optimisation::Result result = optimisation::Minimise(problem, options, control);
    seconds = SecondsSince(clock);
    if (stage.random_starts > 0 && !result.cancelled) {
      RepeatFromRandomStarts(stage, space, problem, options, seed, control, result);
    }
    return result;
  }
  const DesignSpace smooth_space = space.WithBase(MakeSmooth(space.base()));
  const Gammas<double> smooth_reference = context.evaluator.Calc(MakeSmooth(reference.parameters));
  const optimisation::Problem smooth_problem =
      MakeStageProblem(smooth_space, context.evaluator, smooth_reference, weights, context.limits);
  const optimisation::Result smooth = optimisation::Minimise(smooth_problem, options, control);
  std::vector<std::vector<double>> starts = options.starts;
  if (smooth.feasible) starts.push_back(smooth.x);
  constexpr std::size_t kFurtherMinima = 1;
  for (std::size_t i = 1; i < std::min(smooth.minima.size(), 1 + kFurtherMinima); ++i) {
    starts.push_back(smooth.minima[i].x);
  }
  optimisation::Result result = Refine(problem, std::move(starts), control);
  result.algorithm = smooth.algorithm + " without switching forces, then " + result.algorithm;
  result.evaluations += smooth.evaluations;
  result.gradient_evaluations += smooth.gradient_evaluations;
  result.restarts = smooth.restarts;
  result.minima = smooth.minima;
  result.spread = smooth.spread;
  seconds = SecondsSince(clock);
  return result;
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
  optimisation::Problem problem = MakeStageProblem(*optimum.space, context.evaluator, reference,
                                                   context.definition.weights(), context.limits);
  for (std::size_t i = 0; i < x.size(); ++i) problem.variables[i].start = x[i];
  optimisation::Control control;
  control.cancelled = context.options.cancelled;
  const double descended = Refine(problem, {}, control).value;
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
  double seconds = 0.0;  // of the search itself, without the repeats from random starts
  const std::string where =
      fmt::format("{}: case '{}', stage '{}'", context.options.file, context.c.name, stage.name);
  const DesignSpace space =
      DesignSpace::Make(base, result.designs.front().parameters, stage.free, context.c.variables,
                        MergeCurves(context.c.curves, stage.curves), where);
  optimisation::Result search =
      Search(stage, space, reference, context.definition.seed + 1000 * number, context, seconds);
  if (!std::isfinite(search.value)) {
    throw io::RunError(where + ": no design with finite measures was found");
  }
  SnapToBounds(space, search.x);
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
  std::vector<Parameters<double>> designs;
  for (const auto& point : found.points) designs.push_back(space.Apply(point.x));
  std::vector<Gammas<double>> gammas(designs.size());
  context.evaluator.Calc(designs, gammas);
  std::vector<optimisation::FrontPoint> points;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const double sum = measures::CalcObjective(gammas[i], initial.gammas, weights);
    if (std::isfinite(sum)) {
      points.push_back({found.points[i].x, {sum, -planar::CalcRoadFeelGain(designs[i])}});
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
