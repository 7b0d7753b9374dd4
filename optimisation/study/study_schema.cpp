#include "optimisation/study/study_schema.h"

#include <map>

#include "core/io/csv.h"
#include "models/parameters/car_schema.h"
#include "models/planar/car_mode_schema.h"
#include "optimisation/study/study_check.h"

namespace kingpin::study {
namespace {

using io::Schema;
using optimisation::Algorithm;

const Schema<ModelSource>& ModelSchema() {
  static const Schema<ModelSource> schema = [] {
    Schema<ModelSource> s("model", "Where the planar model's parameters come from.");
    s.Include("car", &ModelSource::car, parameters::CarSchema(),
              "car mode: everything is computed from this car")
        .Optional();
    s.Section("options", &ModelSource::options, planar::CarModeSchema(), "options of car mode")
        .Optional();
    s.FilePath("paper_set", &ModelSource::paper_set,
               "paper mode: a file with an identified parameter set")
        .Optional();
    s.Check([](const ModelSource& model, io::Check& check) {
      if (model.car.has_value() == !model.paper_set.empty()) {
        check.Fail("", model.car ? "a car and a paper set" : "neither a car nor a paper set",
                   "exactly one of 'car' and 'paper_set'");
      }
    });
    return s;
  }();
  return schema;
}

const Schema<planar::Pulse>& PulseSchema() {
  static const Schema<planar::Pulse> schema = [] {
    using planar::Pulse;
    using planar::PulseKind;
    Schema<Pulse> s("pulse", "One pulse of the road force.");
    s.Choice("shape", &Pulse::kind,
             {{"half_sine", PulseKind::kHalfSine, "half a sine"},
              {"versine", PulseKind::kVersine, "one minus cosine"},
              {"trapezoid", PulseKind::kTrapezoid, "linear rise, plateau, linear fall"},
              {"double_pulse", PulseKind::kDouble, "half sine, then one of opposite sign"},
              {"ring_down", PulseKind::kRingDown, "decaying sine"},
              {"cubed_parabola", PulseKind::kCubedParabola, "the paper sets' smooth pulse"}},
             "shape");
    s.Quantity("peak", &Pulse::amplitude, "N", "amplitude, rearwards positive");
    s.Quantity("start", &Pulse::start, "s", "when it begins").NonNegative();
    const std::vector<std::string> limited{"half_sine", "versine", "trapezoid", "double_pulse",
                                           "cubed_parabola"};
    s.Quantity("duration", &Pulse::duration, "s", "length").Positive().OnlyIf("shape", limited);
    s.Quantity("rise", &Pulse::rise, "", "share of the duration")
        .Positive()
        .Max(1.0)
        .Default(0.25)
        .OnlyIf("shape", {"trapezoid"});
    s.Quantity("fall", &Pulse::fall, "", "share of the duration")
        .Positive()
        .Max(1.0)
        .Default(0.25)
        .OnlyIf("shape", {"trapezoid"});
    s.Quantity("rebound", &Pulse::rebound, "", "amplitude of the second pulse over the first")
        .NonNegative()
        .Default(0.5)
        .OnlyIf("shape", {"double_pulse"});
    s.Quantity("gap", &Pulse::gap, "s", "pause between the two")
        .NonNegative()
        .Default(0.0)
        .OnlyIf("shape", {"double_pulse"});
    s.Quantity("frequency", &Pulse::frequency, "Hz", "of the ring-down")
        .Positive()
        .OnlyIf("shape", {"ring_down"});
    s.Quantity("damping", &Pulse::damping, "", "damping ratio of the ring-down")
        .NonNegative()
        .Below(1.0)
        .OnlyIf("shape", {"ring_down"});
    return s;
  }();
  return schema;
}

const Schema<LoadCase>& LoadCaseSchema() {
  static const Schema<LoadCase> schema = [] {
    Schema<LoadCase> s("load_case", "A road-force history with its weight in the objective.");
    s.Text("name", &LoadCase::name, "shown in tables and plots");
    s.Quantity("weight", &LoadCase::weight, "", "share in the objective").Positive().Default(1.0);
    s.List("pulses", &LoadCase::pulses, PulseSchema(), "longitudinal force F_T, rearwards positive")
        .Optional();
    s.FilePath("history", &LoadCase::history,
               "CSV file with two columns, time and force; added to the pulses")
        .Optional();
    s.Check([](const LoadCase& load_case, io::Check& check) {
      if (load_case.pulses.empty() && load_case.history.empty()) {
        check.Fail("", "no force", "'pulses', 'history' or both");
      }
    });
    return s;
  }();
  return schema;
}

const Schema<VariableBounds>& BoundsSchema(const char* unit) {
  static std::map<std::string, Schema<VariableBounds>> schemas;
  const auto found = schemas.find(unit);
  if (found != schemas.end()) return found->second;
  Schema<VariableBounds> s("bounds", "Bounds of a design variable.");
  s.Quantity("lower", &VariableBounds::lower, unit, "lower bound");
  s.Quantity("upper", &VariableBounds::upper, unit, "upper bound");
  s.Quantity("start", &VariableBounds::start, unit, "start; the model's own value if left out")
      .Optional();
  s.Check([](const VariableBounds& bounds, io::Check& check) {
    if (!(bounds.lower < bounds.upper)) {
      check.Fail("upper", io::FormatNumber(bounds.upper),
                 "more than the lower bound, " + io::FormatNumber(bounds.lower));
    }
    if (bounds.start && !(*bounds.start >= bounds.lower && *bounds.start <= bounds.upper)) {
      check.Fail("start", io::FormatNumber(*bounds.start),
                 "within the bounds, " + io::FormatNumber(bounds.lower) + " .. " +
                     io::FormatNumber(bounds.upper));
    }
  });
  return schemas.emplace(unit, std::move(s)).first->second;
}

const Schema<VariableTable>& VariablesSchema() {
  static const Schema<VariableTable> schema = [] {
    Schema<VariableTable> s("variables", "Bounds of the scalar design variables.");
    const auto fields = ScalarFields<double>();
    for (int i = 0; i < kScalarFieldCount; ++i) {
      s.Section(
           fields[i].name, [i](VariableTable & table) -> auto& { return table[i]; },
           BoundsSchema(fields[i].unit), fields[i].description)
          .Optional();
    }
    return s;
  }();
  return schema;
}

const Schema<DesignValues>& DesignSchema() {
  static const Schema<DesignValues> schema = [] {
    Schema<DesignValues> s("design", "Values of scalar design variables.");
    const auto fields = ScalarFields<double>();
    for (int i = 0; i < kScalarFieldCount; ++i) {
      s.Quantity(
           fields[i].name, [i](DesignValues & values) -> auto& { return values[i]; },
           fields[i].unit, fields[i].description)
          .Optional();
    }
    return s;
  }();
  return schema;
}

const Schema<CurveTable>& CurvesSchema() {
  static const Schema<CurveTable> schema = [] {
    Schema<CurveBounds> bounds("curve_bounds", "How far a characteristic may change.");
    bounds
        .Quantity("fraction", &CurveBounds::fraction, "",
                  "each node value may move by this fraction of its start value")
        .Positive()
        .Max(10.0);
    bounds.Boolean("odd", &CurveBounds::odd, "keep f(-x) = -f(x)").Default(false);
    bounds
        .Boolean("monotone", &CurveBounds::monotone,
                 "the curve never falls, at its nodes and between them")
        .Default(true);
    Schema<CurveTable> s("curves", "Characteristics whose node values are design variables.");
    s.Section("assistance", &CurveTable::assistance, bounds,
              "power assistance force over torsion torque")
        .Optional();
    s.Section("longitudinal", &CurveTable::longitudinal, bounds,
              "longitudinal support force over elongation")
        .Optional();
    return s;
  }();
  return schema;
}

const Schema<Constraint>& ConstraintSchema() {
  static const Schema<Constraint> schema = [] {
    Schema<Constraint> s("constraint", "Limits of a quantity, as ratios to the initial design.");
    s.Choice(
        "quantity", &Constraint::quantity,
        {{"road_feel_gain", Quantity::kRoadFeelGain,
          "torsion torque per kingpin moment, 0 to 10 Hz, wheel held"},
         {"steering_ratio", Quantity::kSteeringRatio, "steering wheel angle per road wheel angle"}},
        "what is limited");
    s.Quantity("minimum_ratio", &Constraint::minimum_ratio, "", "at least").Positive().Optional();
    s.Quantity("maximum_ratio", &Constraint::maximum_ratio, "", "at most").Positive().Optional();
    s.Check([](const Constraint& constraint, io::Check& check) {
      if (!constraint.minimum_ratio && !constraint.maximum_ratio) {
        check.Fail("", "no limit", "'minimum_ratio', 'maximum_ratio' or both");
      }
      if (constraint.minimum_ratio && constraint.maximum_ratio &&
          *constraint.minimum_ratio >= *constraint.maximum_ratio) {
        check.Fail("maximum_ratio", io::FormatNumber(*constraint.maximum_ratio),
                   "more than minimum_ratio, " + io::FormatNumber(*constraint.minimum_ratio));
      }
    });
    return s;
  }();
  return schema;
}

const Schema<Stage>& StageSchema() {
  static const Schema<Stage> schema = [] {
    Schema<Stage> s("stage", "One step of the strategy.");
    s.Text("name", &Stage::name, "unique within the case");
    s.Texts("free", &Stage::free,
            "variables and curves to optimise; none: the design is only evaluated")
        .Optional();
    s.Text("start", &Stage::start, "the stage whose design it starts from").Default("initial");
    s.Texts("also_from", &Stage::also_from, "stages whose designs the search starts from besides")
        .Optional();
    s.Text("relative_to", &Stage::relative_to,
           "the measures are divided by those of this stage's design; that of `start` if left out")
        .Optional();
    s.Choice("algorithm", &Stage::algorithm,
             {{"multistart", Algorithm::kMultistart, "multistart of local searches, then a polish"},
              {"nelder_mead", Algorithm::kNelderMead, "the paper's simplex method"},
              {"sbplx", Algorithm::kSbplx, "simplex method on subspaces"},
              {"bobyqa", Algorithm::kBobyqa, "quadratic models, no derivatives"},
              {"cobyla", Algorithm::kCobyla, "linear models, constraints, no derivatives"},
              {"slsqp", Algorithm::kSlsqp, "sequential quadratic programming, exact derivatives"},
              {"cma_es", Algorithm::kCmaEs, "evolution strategy"}},
             "search method")
        .Default("multistart");
    s.Section("curves", &Stage::curves, CurvesSchema(), "bounds that replace the case's")
        .Optional();
    s.Section("design", &Stage::design, DesignSchema(), "values set before the search").Optional();
    s.Integer("max_evaluations", &Stage::max_evaluations, "0: the algorithm's own limit")
        .Min(0)
        .Default(0);
    s.Integer("random_starts", &Stage::random_starts,
              "repeat the search from so many random starts")
        .Min(0)
        .Max(1000)
        .Default(0);
    s.Boolean("further", &Stage::further, "show it on the page that goes beyond the paper")
        .Default(false);
    return s;
  }();
  return schema;
}

const Schema<PrintedDesign>& PrintedSchema() {
  static const Schema<PrintedDesign> schema = [] {
    Schema<PrintedDesign> s("printed", "Printed values, shown beside ours.");
    s.Text("stage", &PrintedDesign::stage, "the stage (or `initial`) they belong to");
    s.Text("table", &PrintedDesign::table, "where they are printed");
    s.Text("figure", &PrintedDesign::figure,
           "printed figure with history (a) and spectrum (b) of the rim acceleration")
        .Optional();
    for (int k = 0; k < 5; ++k) {
      s.Quantity(
           "gamma_" + std::to_string(k + 1),
           [k](PrintedDesign & printed) -> auto& { return printed.gamma[k]; }, "",
           "as printed (mm/s^2, gamma_4 in s)")
          .Positive()
          .Optional();
    }
    s.Quantity("sum_of_ratios", &PrintedDesign::sum_of_ratios, "",
               "sum of the ratios to the stage's reference")
        .Positive()
        .Optional();
    s.Section("design", &PrintedDesign::design, DesignSchema(), "printed design").Optional();
    s.Quantity("seconds", &PrintedDesign::seconds, "s", "printed computing time")
        .Positive()
        .Optional();
    return s;
  }();
  return schema;
}

const Schema<ParetoRequest>& ParetoSchema() {
  static const Schema<ParetoRequest> schema = [] {
    Schema<ParetoRequest> s("pareto", "A front of kickback against road feel.");
    s.Texts("free", &ParetoRequest::free, "variables and curves");
    s.Section("curves", &ParetoRequest::curves, CurvesSchema(), "bounds that replace the case's")
        .Optional();
    s.Integer("population", &ParetoRequest::population, "designs in a generation")
        .Min(8)
        .Max(4096)
        .Default(64);
    s.Integer("generations", &ParetoRequest::generations, "generations")
        .Min(1)
        .Max(10000)
        .Default(60);
    return s;
  }();
  return schema;
}

const Schema<MeasureOptions>& MeasuresSchema() {
  static const Schema<MeasureOptions> schema = [] {
    Schema<MeasureOptions> s("measures", "Conventions of the vibration measures.");
    s.Choice("preset", &MeasureOptions::preset,
             {{"default", MeasureOptions::Preset::kDefault, "the project's conventions"},
              {"paper_set", MeasureOptions::Preset::kPaperSet,
               "those the paper sets were identified with"}},
             "starting point")
        .Default("default");
    s.Text("weighting", &MeasureOptions::weighting, "frequency weighting of gamma_3")
        .OneOf([] {
          std::vector<std::string> names;
          for (const auto name : signal::Weighting::names()) names.emplace_back(name);
          return names;
        }())
        .Optional();
    s.FilePath("weighting_file", &MeasureOptions::weighting_file,
               "a table of frequency and factor (CSV) instead")
        .Optional();
    s.Quantity("window", &MeasureOptions::window, "s", "moving window of gamma_2 and gamma_4")
        .Positive()
        .Optional();
    s.Quantity("decay_level", &MeasureOptions::decay_level, "", "level of gamma_4")
        .Above(0.0)
        .Below(1.0)
        .Optional();
    s.Quantity("f1", &MeasureOptions::f1, "Hz", "lower limit of gamma_3").NonNegative().Optional();
    s.Quantity("f2", &MeasureOptions::f2, "Hz", "upper limit of gamma_3").Positive().Optional();
    s.Boolean("gamma_3_root", &MeasureOptions::gamma_3_root, "take the square root of (3.12)")
        .Optional();
    s.Point("weights", &MeasureOptions::weights, "", "weights epsilon_1 to epsilon_5 of (3.9)")
        .NonNegative()
        .Optional();
    return s;
  }();
  return schema;
}

/// What both the study and each of its cases may say.
template <class T, class GetCase>
void AddCaseFields(Schema<T>& s, GetCase get) {
  s.List(
       "load_cases", [get](T & t) -> auto& { return get(t).load_cases; }, LoadCaseSchema(),
       "road forces; paper mode brings its own")
      .Optional();
  s.Section(
       "variables", [get](T & t) -> auto& { return get(t).variables; }, VariablesSchema(),
       "bounds of the scalar design variables")
      .Optional();
  s.Section(
       "curves", [get](T & t) -> auto& { return get(t).curves; }, CurvesSchema(),
       "bounds of the characteristics")
      .Optional();
  s.List(
       "constraints", [get](T & t) -> auto& { return get(t).constraints; }, ConstraintSchema(),
       "what an optimum must respect")
      .Optional();
  s.List(
       "stages", [get](T & t) -> auto& { return get(t).stages; }, StageSchema(), "the strategy")
      .Optional();
  s.Section(
       "pareto", [get](T & t) -> auto& { return get(t).pareto; }, ParetoSchema(),
       "a front of kickback against road feel")
      .Optional();
}

const Schema<Case>& CaseSchema() {
  static const Schema<Case> schema = [] {
    Schema<Case> s("case", "One model with its strategy. What is left out stands in the study.");
    s.Text("name", &Case::name, "unique within the study");
    s.Section("model", &Case::model, ModelSchema(), "the planar model");
    AddCaseFields(s, [](Case& c) -> Case& { return c; });
    s.List("printed", &Case::printed, PrintedSchema(), "printed values to compare with").Optional();
    return s;
  }();
  return schema;
}

template <class T, class Get>
void AddSimulationFields(Schema<T>& s, Get get) {
  s.Quantity(
       "duration", [get](T & t) -> auto& { return get(t).duration; }, "s", "simulated time T")
      .Positive()
      .Max(1000.0)
      .Default(1.0);
  s.Quantity(
       "sample_interval", [get](T & t) -> auto& { return get(t).sample_interval; }, "s",
       "distance of the samples that the measures see")
      .Min(1e-5)
      .Max(0.1)
      .Default(1e-3);
  s.Section(
       "measures", [get](T & t) -> auto& { return get(t).measures; }, MeasuresSchema(),
       "conventions of the vibration measures")
      .Optional();
}

std::filesystem::path FileIn(const std::filesystem::path& path, const char* name) {
  return std::filesystem::is_directory(path) ? path / name : path;
}

}  // namespace

measures::Conventions MakeConventions(const MeasureOptions& options, double gamma_3_scale) {
  measures::Conventions conventions = options.preset == MeasureOptions::Preset::kPaperSet
                                          ? measures::MakePaperSetConventions(gamma_3_scale)
                                          : measures::MakeDefaultConventions();
  if (options.weighting) conventions.weighting = signal::Weighting::Named(*options.weighting);
  if (!options.weighting_file.empty()) {
    conventions.weighting = signal::Weighting::FromFile(options.weighting_file);
  }
  if (options.window) conventions.window = *options.window;
  if (options.decay_level) conventions.decay_level = *options.decay_level;
  if (options.f1) conventions.f1 = *options.f1;
  if (options.f2) conventions.f2 = *options.f2;
  if (options.gamma_3_root) conventions.gamma_3_root = *options.gamma_3_root;
  measures::CheckConventions(conventions);
  return conventions;
}

const Schema<StudyFile>& StudySchema() {
  static const Schema<StudyFile> schema = [] {
    Schema<StudyFile> s("study", "Excite, optimise, report.");
    const auto definition = [](StudyFile& file) -> StudyDefinition& { return file.definition; };
    s.Text(
        "name", [](StudyFile & file) -> auto& { return file.definition.name; },
        "title of the report");
    s.Text(
         "description", [](StudyFile & file) -> auto& { return file.definition.description; },
         "what it is about")
        .Optional();
    AddSimulationFields(s, definition);
    s.Integer(
         "seed", [](StudyFile & file) -> auto& { return file.definition.seed; },
         "seed of every random choice")
        .Min(0)
        .Default(1);
    AddCaseFields(s, [](StudyFile& file) -> Case& { return file.defaults; });
    s.List(
         "cases", [](StudyFile & file) -> auto& { return file.definition.cases; }, CaseSchema(),
         "the models to study")
        .Count(1);
    s.Check(CheckStudy);
    return s;
  }();
  return schema;
}

const Schema<Scenario>& ScenarioSchema() {
  static const Schema<Scenario> schema = [] {
    Schema<Scenario> s("scenario", "One simulation of the planar model.");
    s.Text("name", &Scenario::name, "title");
    s.Text("description", &Scenario::description, "what it is about").Optional();
    s.Section("model", &Scenario::model, ModelSchema(), "the planar model");
    s.Section("design", &Scenario::design, DesignSchema(), "changes of the model").Optional();
    s.List("load_cases", &Scenario::load_cases, LoadCaseSchema(),
           "the road force (one); paper mode brings its own")
        .Count(0, 1)
        .Optional();
    AddSimulationFields(s, [](Scenario& scenario) -> Scenario& { return scenario; });
    s.Choice("method", &Scenario::method,
             {{"fast", ScenarioMethod::kFast, "the default: same measures to 1e-6"},
              {"rk4", ScenarioMethod::kRungeKutta4, "classical Runge-Kutta, the paper's"},
              {"cvode", ScenarioMethod::kCvode, "adaptive reference with event location"}},
             "time integration")
        .Default("fast");
    s.Quantity("step", &Scenario::step, "s",
               "largest step; at most 10 us with dry friction, stops or free play")
        .Positive()
        .Max(1e-2)
        .OnlyIf("method", {"fast", "rk4"})
        .Optional();
    s.Check(CheckScenario);
    return s;
  }();
  return schema;
}

StudyDefinition ReadStudy(const std::filesystem::path& path, const io::ReadOptions& options,
                          io::InputRecord* record) {
  const std::filesystem::path file = FileIn(path, "study.yaml");
  return MakeDefinition(io::ReadFile(StudySchema(), file, options, record));
}

Scenario ReadScenario(const std::filesystem::path& path, const io::ReadOptions& options,
                      io::InputRecord* record) {
  return io::ReadFile(ScenarioSchema(), FileIn(path, "scenario.yaml"), options, record);
}

void AddInputKinds(io::InputKinds* kinds) {
  kinds->Add<StudyFile>(StudySchema());
  kinds->Add<Scenario>(ScenarioSchema());
}

}  // namespace kingpin::study
