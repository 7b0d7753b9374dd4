#pragma once

#include <complex>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// What the report of a study shows, as plain values. The report computes ratios, percentages and
/// axis ranges; it runs no model, reads no file and knows no algorithm. Fill what there is: an
/// empty vector, an empty string or a NaN leaves its part out, so a report of one simulation and a
/// report of a whole optimisation study come from the same structs.
///
/// Numbers are SI; a DisplayUnit says what a reader sees. Every text is escaped when it is written.
/// A `symbol` may hold one underscore, which starts a subscript: `r_L`, `x_tr`, `Γ_1`. Units are
/// written in ASCII (`N*m/rad`, `mm/s^2`) and set with · and superscripts.
namespace kingpin::report {

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// The shown number is `per_si` times the stored one: {"kN", 1e-3} for a force in newtons.
struct DisplayUnit {
  // A constructor, so that nested braces in long lists do not set off a false warning of GCC 12.
  DisplayUnit(std::string unit_text = {}, double shown_per_si = 1.0)
      : text(std::move(unit_text)), per_si(shown_per_si) {}

  std::string text;  ///< empty for a dimensionless number
  double per_si;     ///< 1 when the stored number already has this unit
};

/// A line of a two-column list.
struct NamedText {
  std::string name{};
  std::string text{};
};

/// A curve y(x); both of one length. A NaN in y interrupts the line.
struct Curve {
  std::vector<double> x{};
  std::vector<double> y{};
};

// ---------------------------------------------------------------------------------------------
// What is measured

enum class Preference {
  kLower,   ///< less is better: a vibration measure
  kHigher,  ///< more is better, or at least a loss has to be justified: road feel
  kNeutral  ///< shown without judgement
};

/// One row of the kickback card. Values stand in Design::measures, in the same order.
struct Measure {
  std::string symbol{};  ///< `Γ_1`; may be empty
  std::string name{};    ///< `Peak-to-peak rim acceleration`
  DisplayUnit unit{};    ///< Γ_1, Γ_2, Γ_5: mm/s^2
  std::string
      definition{};     ///< one sentence with the convention in force; listed under Conventions
  double weight = 0.0;  ///< ε_k of I_V = Σ ε_k Γ_k / Γ_k(initial); 0: not part of the sum
  Preference preference = Preference::kLower;
  bool headline = false;  ///< named in the verdict sentence and in the summary table
  double good =
      kMissing;  ///< orientation targets in SI: at least as good as this is marked "good" ...
  double poor = kMissing;  ///< ... and at least as bad as this "poor"; NaN: no target
};

/// One signal of the history plots. Values stand in Design::histories, in the same order.
struct Channel {
  std::string name{};    ///< `Torsion-bar torque`
  std::string symbol{};  ///< `M_sw`; may be empty
  DisplayUnit unit{};
  bool common = false;  ///< the same for all designs (the excitation): drawn once, from the first
                        ///< design that has it
};

/// One frequency response. Values stand in Design::frequency_responses, in the same order.
struct Response {
  std::string name{};  ///< `Road force F_T to tie-rod force F_R`
  DisplayUnit unit{};  ///< of the gain: `N/N`, `deg/kN`
};

/// One characteristic that may be optimised (assistance, longitudinal stiffness), with the band its
/// node values may move in. Curves stand in Design::characteristics, in the same order.
struct Characteristic {
  std::string name{};    ///< `Power assistance`
  std::string x_name{};  ///< `Torsion-bar torque`
  DisplayUnit x_unit{};
  std::string y_name{};  ///< `Assistance force on the rack`
  DisplayUnit y_unit{};
  Curve lower{};  ///< bound of the node values; empty: no band drawn
  Curve upper{};
};

/// A design variable. Values stand in Design::variables, in the same order.
struct Variable {
  std::string symbol{};  ///< `r_L`
  std::string name{};    ///< `Half length of the rack`
  DisplayUnit unit{};
  double lower = kMissing;  ///< bounds, SI; the widest of all stages
  double upper = kMissing;
  bool locked = false;  ///< held at its start value in this study
};

// ---------------------------------------------------------------------------------------------
// One design

struct Mode {
  double frequency_hz = kMissing;   ///< undamped frequency
  double damping_ratio = kMissing;  ///< 1 = critical
  std::string shape{};              ///< dominant coordinates in words: `carrier x 71 %, rack 20 %`
};

/// A curve of a design; its nodes are drawn as dots.
struct CharacteristicCurve {
  Curve curve{};
  Curve nodes{};
};

struct Point2 {
  double x = kMissing;  ///< forward [m]
  double y = kMissing;  ///< left [m]
};

/// One corner of the front axle seen from above, at rest; ISO 8855 axes, lengths in m. Points that
/// move with the carrier are marked (c). A point left at NaN is not drawn. The origin is free (the
/// paper's sets use the carrier's centre of mass); all designs of a case must share it.
struct CornerGeometry {
  Point2 wheel_centre{};      ///< (c)
  double wheel_radius = 0.0;  ///< of the outline; 0: no wheel drawn
  double wheel_width = 0.0;
  Point2 centre_of_mass{};         ///< (c) of the carrier; it turns about this point
  Point2 kingpin{};                ///< (c) kingpin axis K at hub height
  Point2 force_point{};            ///< (c) where the road force acts
  Point2 rod_outer{};              ///< (c) tie-rod ball joint on the carrier
  Point2 rod_inner{};              ///< tie-rod ball joint on the rack; moves with the rack along y
  double rack_half_length = 0.0;   ///< r_L: the rack is drawn from rod_inner this far inwards
  Point2 lateral_support{};        ///< (c) L
  double lateral_direction = 0.0;  ///< β [rad] from x towards y
  Point2 longitudinal_support{};   ///< (c) N
  double longitudinal_direction = 0.0;  ///< α [rad]
  std::string name{};                   ///< of the corner: `front left`
};

/// Sampled motion for the animation; all of one length. About 200 to 600 samples are plenty: the
/// report thins longer ones evenly. Coordinates as in the planar model: displacement of the
/// carrier's centre of mass, its rotation (counter-clockwise from above), rack travel along +y,
/// steering wheel angle.
struct CornerMotion {
  std::vector<double> time{};         ///< [s]
  std::vector<double> x{};            ///< [m]
  std::vector<double> y{};            ///< [m]
  std::vector<double> psi{};          ///< [rad]
  std::vector<double> rack{};         ///< [m]
  std::vector<double> wheel_angle{};  ///< [rad]
  std::vector<double> road_force{};   ///< [N], rearwards positive; may be empty
};

struct Design {
  std::string name{};               ///< `initial`, `step 1`, `step 2`, `OPT2`, `printed optimum`
  std::vector<double> measures{};   ///< parallel to StudyReportData::measures
  std::vector<double> variables{};  ///< parallel to Case::variables
  std::vector<double> lower{};      ///< bounds of its own search, likewise; NaN: was not free;
  std::vector<double> upper{};      ///< empty: those of Case::variables
  double objective = kMissing;      ///< what the search minimised; may have another reference
  bool plotted = true;              ///< drawn in the figures (it stands in the tables anyway)
  std::vector<double> time{};       ///< [s] of the histories; need not be uniform
  std::vector<std::vector<double>> histories{};  ///< parallel to Case::channels, each like `time`
  Curve spectrum{};                              ///< [Hz] -> amplitude, see Case::spectrum_unit
  std::vector<double> response_frequency{};      ///< [Hz], positive
  std::vector<std::vector<std::complex<double>>>
      frequency_responses;  ///< parallel to Case::responses
  std::vector<Mode> modes{};
  std::vector<CharacteristicCurve> characteristics{};  ///< parallel to Case::characteristics
  CornerGeometry geometry{};
  CornerMotion motion{};  ///< empty: no animation of this design
  std::string note{};     ///< shown under the card, e.g. where it comes from
};

// ---------------------------------------------------------------------------------------------
// The search

/// One stage of the optimisation, for the table of stages.
struct Stage {
  std::string name{};       ///< `OPT1 step 1`
  std::string algorithm{};  ///< `Nelder-Mead, 20 starts`
  std::string free{};       ///< what was free: `r_L, r_X, x_tr; ±5 cm`
  long evaluations = -1;    ///< simulations; -1: unknown
  long iterations = -1;
  double seconds = kMissing;        ///< wall time
  double start = kMissing;          ///< objective at the start
  double end = kMissing;            ///< objective at the end
  std::string status{};             ///< why it stopped
  double paper_seconds = kMissing;  ///< printed time, when there is one
};

/// How the best value fell. Steps: a value holds until the next evaluation number.
struct Convergence {
  std::string name{};                 ///< stage, algorithm
  std::vector<double> evaluations{};  ///< increasing
  std::vector<double> best{};         ///< objective
};

/// Ends of independent runs of one stage from different starts.
struct Restarts {
  std::string name{};                              ///< stage, algorithm
  std::vector<double> start_values{};              ///< objective at the starts; may be empty
  std::vector<double> end_values{};                ///< objective at the ends
  std::vector<std::vector<double>> end_designs{};  ///< parallel to Case::variables; may be empty
  std::string note{};                              ///< how the runs were made
};

/// A bound or constraint that holds the optimum back.
struct ActiveConstraint {
  std::string design{};     ///< `step 1`
  std::string name{};       ///< `r_L at its lower bound`, `assistance monotone at node 3`
  double value = kMissing;  ///< SI
  double limit = kMissing;  ///< SI
  DisplayUnit unit{};
  std::string effect{};  ///< what it costs, in words; may be empty
};

/// Change of measures with variables at one design.
struct Sensitivity {
  std::string design{};                       ///< `initial`, `OPT2`
  std::vector<std::string> variables{};       ///< symbols, rows
  std::vector<std::string> measures{};        ///< symbols, columns
  std::vector<std::vector<double>> values{};  ///< [variable][measure]
  std::string unit = "% per 1 % of the variable's range";
  std::string meaning{};  ///< one sentence: step, method
};

struct ParetoPoint {
  double x = kMissing;  ///< SI
  double y = kMissing;
  std::string name{};  ///< of a marked point; empty on the front itself
};

struct ParetoFront {
  std::string name{};    ///< `set B, all characteristics free within ±30 %`
  std::string x_name{};  ///< `Road-feel gain`
  DisplayUnit x_unit{};
  std::string y_name{};  ///< `Kickback I_V`
  DisplayUnit y_unit{};
  std::vector<ParetoPoint> front{};      ///< drawn as a staircase of non-dominated designs
  std::vector<ParetoPoint> dominated{};  ///< other designs that were tried; drawn pale
  std::vector<ParetoPoint> marked{};     ///< named designs
  std::string note{};
};

// ---------------------------------------------------------------------------------------------
// Printed values

/// One printed number and ours. The difference is (ours - paper) / paper.
struct ComparisonRow {
  std::string symbol{};  ///< `Γ_1`, `r_L`
  std::string name{};
  DisplayUnit unit{};          ///< of both numbers
  double paper = kMissing;     ///< NaN: not printed
  std::vector<double> ours{};  ///< parallel to Comparison::columns
  std::string note{};
};

/// A printed table beside ours, e.g. Table 2 with columns {"set A", "set B", "set C"}.
struct Comparison {
  std::string title{};                 ///< `Table 3: case (2), optimal design`
  std::vector<std::string> columns{};  ///< our columns
  std::vector<ComparisonRow> rows{};
  std::string note{};  ///< what the difference means
};

// ---------------------------------------------------------------------------------------------
// A case and the study

/// One car variant (hydraulic, electric), parameter set or printed case.
struct Case {
  std::string name{};
  std::string description{};      ///< a sentence or two
  std::string verdict{};          ///< empty: the report writes one from the numbers
  int chosen = -1;                ///< the design the verdict is about; -1: lowest I_V
  std::vector<Design> designs{};  ///< the first is the reference of all ratios
  std::vector<Channel> channels{};
  std::string spectrum_name = "Spectrum of the rim acceleration";
  DisplayUnit spectrum_unit = {"m/s^2", 1.0};
  double spectrum_max_hz = kMissing;  ///< right end of the plot
  std::string weighting_name{};       ///< `W_h (ISO 5349-1)`
  Curve weighting{};                  ///< [Hz] -> factor
  std::vector<Response> responses{};
  std::vector<Characteristic> characteristics{};
  std::vector<Variable> variables{};
  std::vector<Stage> stages{};
  std::vector<Convergence> convergence{};
  std::vector<Restarts> restarts{};
  std::vector<ActiveConstraint> active{};
  std::vector<Sensitivity> sensitivities{};
  std::vector<ParetoFront> pareto{};
  std::vector<Comparison> comparisons{};
  std::vector<std::string>
      warnings;  ///< `step 1 ends on 3 bounds`, `the printed optimum is only local`
};

/// How low the measures go with more freedom: one row per parameter set or case.
struct FurtherRow {
  std::string name{};                  ///< `set B, case 2`
  std::string freedom{};               ///< `geometry and all characteristics ±30 %`
  double objective_start = kMissing;   ///< I_V of the start
  std::string before{};                ///< the last design with the case's own freedom: `OPT2`
  double objective_before = kMissing;  ///< its I_V
  double objective = kMissing;         ///< I_V reached
  std::vector<double> ratios{};        ///< Γ_k / Γ_k(initial), parallel to Further::ratio_symbols
  double road_feel_ratio = kMissing;   ///< road-feel gain / initial
  std::string note{};
};

struct Further {
  std::string text{};                        ///< what was freed and what is found
  std::vector<std::string> ratio_symbols{};  ///< `Γ_1` ...
  std::vector<FurtherRow> rows{};
  std::vector<ParetoFront> pareto{};  ///< one figure each
};

struct Parameter {
  std::string name{};   ///< path of the key: `steering.rack.mass`
  std::string value{};  ///< set in the unit below; a number, a list or a word
  std::string unit{};
  std::string origin{};  ///< provenance: source, estimate, derived, `--set`
  bool changed = false;  ///< differs from the shipped value
};

struct ParameterGroup {
  std::string title{};   ///< `Steering`
  std::string source{};  ///< file
  std::vector<Parameter> parameters{};
};

struct InputFile {
  std::string path{};
  std::string hash{};  ///< `sha256:...`, `fnv1a64:...`
  long bytes = -1;
};

struct StudyReportData {
  std::string title{};     ///< `Steering kickback: C-segment car`
  std::string subtitle{};  ///< `One-sided obstacle pulse at 35 km/h, planar model`
  std::string created{};   ///< date and time; empty keeps the file reproducible
  std::string program{};   ///< `kingpin 0.1.0`
  std::string command{};   ///< as the user typed it
  double run_seconds = kMissing;
  std::vector<std::string> summary{};   ///< plain sentences put on top, after the generated ones
  std::vector<std::string> warnings{};  ///< of the whole study
  std::vector<Measure> measures{};      ///< rows of the kickback card, for all cases
  std::vector<Case> cases{};
  std::vector<Comparison> comparisons{};  ///< over all cases (Table 5, times)
  Further further{};
  std::vector<ParameterGroup> parameters{};
  std::vector<NamedText> options{};      ///< options in force
  std::vector<NamedText> conventions{};  ///< beside the definitions of the measures
  std::vector<NamedText> solver{};       ///< statistics of the integrator and of the search
  std::vector<NamedText> versions{};     ///< program, compiler, libraries, instruction set
  std::vector<InputFile> inputs{};
};

}  // namespace kingpin::report
