#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "optimisation/report/study_report_data.h"

/// A study as a report sees it, with invented but plausible numbers (decaying oscillations), so
/// that every section has data. Nothing here is a result.
namespace kingpin::report::sample {

inline constexpr double kPi = std::numbers::pi;

inline std::vector<Measure> MakeMeasures() {
  const auto lower = Preference::kLower;
  return {
      {"Γ_1",
       "Peak-to-peak rim acceleration",
       {"mm/s^2", 1e3},
       "Largest minus smallest rim acceleration of the 1 ms samples, each refined by a parabola.",
       1.0,
       lower,
       false,
       20.0,
       40.0},
      {"Γ_2",
       "Windowed vibration dose",
       {"mm/s^2*s", 1e3},
       "Integral of the running r.m.s. in a window of 0.6 s, centred, truncated at the record's "
       "ends.",
       1.0,
       lower,
       false,
       kMissing,
       kMissing},
      {"Γ_3",
       "Weighted r.m.s. spectrum",
       {"mm/s^2", 1e3},
       "Amplitude spectrum weighted with W_h, 1 to 100 Hz, with the square root of (3.12).",
       1.0,
       lower,
       false,
       kMissing,
       kMissing},
      {"Γ_4",
       "Dissipation time",
       {"s", 1.0},
       "First to last crossing of a quarter of the largest window energy.",
       1.0,
       lower,
       false,
       kMissing,
       kMissing},
      {"Γ_5",
       "R.m.s. rim acceleration",
       {"mm/s^2", 1e3},
       "Root mean square from 0 to 1 s.",
       1.0,
       lower,
       false,
       kMissing,
       kMissing},
      {"", "Torsion-bar torque, peak to peak", {"N*m", 1.0}, "", 0.0, lower, true, 3.0, 5.0},
      {"", "Torsion-bar torque, peak", {"N*m", 1.0}, "", 0.0, lower, false, kMissing, kMissing},
      {"", "Rack force, peak", {"kN", 1e-3}, "", 0.0, lower, false, 3000.0, 6000.0},
      {"", "Tie-rod force, peak", {"kN", 1e-3}, "", 0.0, lower, false, kMissing, kMissing},
      {"", "Weighted r.m.q.", {"m/s^2", 1.0}, "", 0.0, lower, false, kMissing, kMissing},
      {"", "Vibration dose value", {"m/s^1.75", 1.0}, "", 0.0, lower, false, kMissing, kMissing},
      {"", "Decay time, 50 ms window", {"s", 1.0}, "", 0.0, lower, false, 0.3, kMissing},
      {"",
       "Road-feel gain, 0 to 10 Hz",
       {"N*m/kN", 1e3},
       "Mean gain from rack force to torsion-bar torque between 0 and 10 Hz.",
       0.0,
       Preference::kHigher,
       true,
       kMissing,
       kMissing},
  };
}

inline CornerGeometry MakeGeometry(double r_l, double r_x, double x_tr) {
  CornerGeometry g;
  g.name = "front left";
  g.wheel_centre = {0.0, 0.060};
  g.wheel_radius = 0.297;
  g.wheel_width = 0.205;
  g.centre_of_mass = {0.0, 0.0};
  g.kingpin = {0.004, -0.012};
  g.force_point = {-0.005, 0.077};
  g.rod_outer = {x_tr, -0.025};
  g.rod_inner = {r_x - 0.18, -(0.788 - r_l)};
  g.rack_half_length = r_l;
  g.lateral_support = {0.111, 0.0146};
  g.lateral_direction = 1.668;
  g.longitudinal_support = {0.1113, -0.0252};
  g.longitudinal_direction = 0.1648;
  return g;
}

inline Design MakeDesign(const std::string& name, double size, double frequency, double decay,
                         const std::vector<double>& ratios) {
  Design d;
  d.name = name;
  const std::vector<double> start = {19.2,   1.19,   0.0143, 0.702, 1.374, 5.31,   3.02,
                                     2140.0, 2390.0, 1.84,   1.91,  0.412, 1.73e-3};
  for (size_t i = 0; i < start.size(); ++i) d.measures.push_back(start[i] * ratios[i]);
  d.histories.resize(6);
  for (int i = 0; i <= 1000; ++i) {
    const double t = 1e-3 * i;
    const double u = std::max(0.0, t - 0.14);
    const double ring =
        std::exp(-decay * u) * std::sin(2.0 * kPi * frequency * u) * (u > 0 ? 1 : 0);
    const double slow = std::exp(-0.6 * decay * u) * std::sin(2.0 * kPi * 5.2 * u);
    const double s = (t - 0.14) / 0.051;
    const double pulse = s > 0.0 && s < 1.0 ? std::pow(4.0 * s * (1.0 - s), 3) : 0.0;
    d.time.push_back(t);
    d.histories[0].push_back(4900.0 * pulse);
    d.histories[1].push_back(size * (10.5 * ring + 1.2 * slow));
    d.histories[2].push_back(size * (2.6 * ring - 0.5 * slow));
    d.histories[3].push_back(size * (1900.0 * pulse + 700.0 * ring));
    d.histories[4].push_back(size * (2100.0 * pulse - 640.0 * ring));
    d.histories[5].push_back(size * (0.021 * slow + 0.004 * ring));
    if (i % 2 == 0) {
      d.motion.time.push_back(t);
      d.motion.x.push_back(-0.008 * size * (pulse + 0.6 * ring));
      d.motion.y.push_back(0.0012 * size * ring);
      d.motion.psi.push_back(0.012 * size * (pulse - 0.5 * ring));
      d.motion.rack.push_back(0.0002 * size * (pulse + slow));
      d.motion.wheel_angle.push_back(size * (0.021 * slow + 0.004 * ring));
      d.motion.road_force.push_back(4900.0 * pulse);
    }
  }
  for (int k = 1; k <= 200; ++k) {
    const double f = 0.5 * k;
    const double r = f / frequency;
    d.spectrum.x.push_back(f);
    d.spectrum.y.push_back(0.5 * size * r * r / std::hypot(1.0 - r * r, 0.12 * r) /
                           (1.0 + r * r * r));
  }
  d.frequency_responses.resize(2);
  for (int k = 0; k <= 300; ++k) {
    const double f = 0.5 * std::pow(400.0, k / 300.0);
    const std::complex<double> s(0.0, 2.0 * kPi * f);
    const double w1 = 2.0 * kPi * frequency;
    const double w2 = 2.0 * kPi * 6.4;
    const std::complex<double> h1 = w1 * w1 / (s * s + 2.0 * 0.05 * w1 * s + w1 * w1);
    const std::complex<double> h2 = w2 * w2 / (s * s + 2.0 * 0.15 * w2 * s + w2 * w2);
    d.response_frequency.push_back(f);
    d.frequency_responses[0].push_back(0.48 * size * h1);
    d.frequency_responses[1].push_back(2.1e-5 * size * h1 * h2);
  }
  d.modes = {{0.0, kMissing, "steering turns freely: wheel 96 %, rack 4 %"},
             {6.4, 0.15, "steering wheel 88 %"},
             {frequency, 0.021, "carrier x 71 %, rack 18 %"},
             {61.3, 0.081, "carrier ψ 64 %, carrier y 29 %"},
             {213.0, 0.34, "rack 92 %"}};
  return d;
}

inline CharacteristicCurve MakeAssistance(double factor, double bend) {
  CharacteristicCurve c;
  for (int i = 0; i <= 60; ++i) {
    const double m = 0.1 * i;
    c.curve.x.push_back(m);
    c.curve.y.push_back(factor * (820.0 * m + bend * 36.0 * m * m * m));
    if (i % 10 == 0) {
      c.nodes.x.push_back(m);
      c.nodes.y.push_back(c.curve.y.back());
    }
  }
  return c;
}

inline CharacteristicCurve MakeLongitudinal(double factor) {
  CharacteristicCurve c;
  for (int i = -45; i <= 45; ++i) {
    const double s = 2e-4 * i;
    c.curve.x.push_back(s);
    c.curve.y.push_back(factor * (4.1e5 * s + 1.75e10 * s * s * s));
    if (i % 15 == 0) {
      c.nodes.x.push_back(s);
      c.nodes.y.push_back(c.curve.y.back());
    }
  }
  return c;
}

inline ParetoFront MakeFront(const std::string& name, double floor) {
  ParetoFront f;
  f.name = name;
  f.x_name = "Loss of road feel";
  f.x_unit = {"%", 100.0};
  f.y_name = "Kickback index I_V";
  for (int i = 0; i <= 22; ++i) {
    const double x = 0.015 * i;
    f.front.push_back({x, floor + (4.9 - floor) * std::exp(-11.0 * x), ""});
    f.dominated.push_back({x + 0.01 * ((7 * i) % 5),
                           floor + (5.2 - floor) * std::exp(-6.0 * x) + 0.07 * ((3 * i) % 7), ""});
  }
  f.marked = {{0.0, 5.0, "initial"}, {0.06, 3.66, "step 1"}, {0.11, 3.05, "OPT2"}};
  return f;
}

inline Case MakeCase(const std::string& name, double level) {
  Case c;
  c.name = name;
  c.description = "The C-segment car with " + name +
                  " power assistance crosses a one-sided obstacle at 35 km/h with free hands; "
                  "planar model, left corner.";
  c.channels = {{"Road force", "F_T", {"kN", 1e-3}, true},
                {"Rim acceleration", "A_tan", {"m/s^2", 1.0}, false},
                {"Torsion-bar torque", "M_sw", {"N*m", 1.0}, false},
                {"Rack force", "", {"kN", 1e-3}, false},
                {"Tie-rod force", "F_R", {"kN", 1e-3}, false},
                {"Steering wheel angle", "φ", {"deg", 180.0 / kPi}, false}};
  c.spectrum_max_hz = 100.0;
  c.weighting_name = "W_h (ISO 5349-1)";
  for (int k = 1; k <= 200; ++k) {
    const double f = 0.5 * k;
    c.weighting.x.push_back(f);
    c.weighting.y.push_back(f < 8 ? f / 8 : f < 16 ? 1.0 : 16 / f);
  }
  c.responses = {{"Road force F_T to tie-rod force F_R", {"N/N", 1.0}},
                 {"Road force F_T to wheel angle φ", {"deg/kN", 1e3 * 180.0 / kPi}}};
  c.variables = {{"r_L", "Half length of the rack", {"mm", 1e3}, 0.20, 0.40, false},
                 {"r_X", "Rack behind the wheel centre", {"mm", 1e3}, 0.0, 0.10, false},
                 {"x_tr", "Tie-rod joint, x", {"mm", 1e3}, -0.1825, -0.0825, false},
                 {"y_tr", "Tie-rod joint, y", {"mm", 1e3}, kMissing, kMissing, true}};

  Design initial = MakeDesign("initial", level, 15.5, 7.0, std::vector<double>(13, 1.0));
  initial.variables = {0.25, 0.05, -0.1325, -0.025};
  initial.geometry = MakeGeometry(0.25, 0.05, -0.1325);
  initial.characteristics = {MakeAssistance(1.0, 1.0), MakeLongitudinal(1.0)};
  Design step1 = MakeDesign(
      "step 1", 0.72 * level, 16.2, 8.0,
      {0.702, 0.771, 0.594, 0.873, 0.751, 0.693, 0.70, 0.80, 0.84, 0.745, 0.733, 0.91, 0.951});
  step1.variables = {0.20, 0.0, -0.0825, -0.025};
  step1.geometry = MakeGeometry(0.20, 0.0, -0.0825);
  step1.characteristics = initial.characteristics;
  Design step2 = MakeDesign(
      "step 2", 0.6 * level, 16.2, 10.0,
      {0.653, 0.64, 0.38, 0.777, 0.631, 0.601, 0.61, 0.79, 0.84, 0.65, 0.64, 0.80, 0.902});
  step2.variables = step1.variables;
  step2.geometry = step1.geometry;
  step2.characteristics = {MakeAssistance(0.94, 1.25), MakeLongitudinal(0.9)};
  Design opt2 = MakeDesign(
      "OPT2", 0.57 * level, 15.9, 10.5,
      {0.641, 0.631, 0.372, 0.77, 0.62, 0.592, 0.60, 0.785, 0.835, 0.641, 0.63, 0.79, 0.893});
  opt2.variables = {0.20, 0.0, -0.0841, -0.025};
  opt2.geometry = MakeGeometry(0.20, 0.0, -0.0841);
  opt2.characteristics = {MakeAssistance(0.92, 1.3), MakeLongitudinal(0.88)};
  opt2.note = "all 15 variables at once, started at step 2 and at 20 random designs.";
  c.designs = {initial, step1, step2, opt2};

  const CharacteristicCurve assistance = MakeAssistance(1.0, 1.0);
  const CharacteristicCurve longitudinal = MakeLongitudinal(1.0);
  const auto scaled = [](Curve curve, double by) {
    for (double& v : curve.y) v *= by;
    return curve;
  };
  const auto shifted = [](Curve curve, double sign) {
    for (double& v : curve.y) v += sign * 0.1 * std::abs(v);
    return curve;
  };
  c.characteristics = {{"Power assistance",
                        "Torsion-bar torque",
                        {"N*m", 1.0},
                        "Assistance force on the rack",
                        {"kN", 1e-3},
                        scaled(assistance.curve, 0.9),
                        scaled(assistance.curve, 1.1)},
                       {"Longitudinal stiffness",
                        "Deflection",
                        {"mm", 1e3},
                        "Force",
                        {"kN", 1e-3},
                        shifted(longitudinal.curve, -1.0),
                        shifted(longitudinal.curve, 1.0)}};

  c.stages = {{"OPT1 step 1", "Nelder-Mead, 20 starts", "r_L, r_X, x_tr within ±5 cm", 3840, 192,
               0.243, 5.0, 3.691, "converged: step below 1e-6 of the range", 15.8},
              {"OPT1 step 2", "CMA-ES", "12 node values ±10 %", 21600, 430, 1.72, 5.0, 4.106,
               "converged", 310.0},
              {"OPT2", "CMA-ES, then BOBYQA", "all 15", 30100, 601, 2.41, 3.081, 3.034,
               "evaluation budget used", 450.0}};
  for (const char* stage : {"OPT1 step 1", "OPT1 step 2", "OPT2"}) {
    Convergence h;
    h.name = stage;
    const double shift = stage[3] == '2' ? 0.4 : stage[10] == '2' ? 0.2 : 0.0;
    for (int k = 0; k < 40; ++k) {
      h.evaluations.push_back(std::round(8.0 * std::pow(1.22, k)));
      h.best.push_back(3.1 - shift + 1.9 * std::exp(-0.14 * k - shift));
    }
    c.convergence.push_back(h);
  }
  Restarts restarts;
  restarts.name = "OPT1 step 1, random starts";
  for (int k = 0; k < 20; ++k) {
    restarts.end_values.push_back(k < 16 ? 3.691 + 1e-5 * k : 3.73 + 0.05 * (k - 16));
    restarts.end_designs.push_back(
        {0.2 + (k < 16 ? 0.0 : 0.03), 0.0, -0.0825 - (k < 16 ? 0.0 : 0.1), -0.025});
  }
  c.restarts = {restarts};
  c.active = {{"step 1",
               "r_L at its lower bound",
               0.20,
               0.20,
               {"mm", 1e3},
               "10 mm more freedom: I_V −2.1 %"},
              {"step 1",
               "x_tr at its upper bound",
               -0.0825,
               -0.0825,
               {"mm", 1e3},
               "10 mm more freedom: I_V −4.4 %"},
              {"OPT2", "assistance at node 5, upper bound", 9222.0, 9222.0, {"kN", 1e-3}, ""}};
  for (const char* design : {"initial", "OPT2"}) {
    Sensitivity s;
    s.design = design;
    s.meaning = "Exact derivatives, scaled to one hundredth of the range between the bounds.";
    s.variables = {"r_L", "r_X", "x_tr", "F_A,1", "F_A,3", "F_A,6", "F_N,2", "F_N,4"};
    s.measures = {"Γ_1", "Γ_2", "Γ_3", "Γ_4", "Γ_5", "I_V"};
    for (size_t i = 0; i < s.variables.size(); ++i) {
      std::vector<double> row;
      for (size_t j = 0; j < s.measures.size(); ++j) {
        row.push_back((i % 2 ? -1.0 : 1.0) * (design[0] == 'i' ? 1.0 : 0.6) * 1.4 / (1.0 + i) *
                      (1.0 + 0.3 * j));
      }
      s.values.push_back(row);
    }
    c.sensitivities.push_back(s);
  }
  c.pareto = {MakeFront("Case " + name + ", ±10 %", 2.9)};
  c.pareto[0].note =
      "Each point of the front is a design that no other tried design beats in both.";
  c.comparisons = {
      {"Table 3: case (2), initial and optimal design",
       {"set A", "set B", "set C"},
       {{"Γ_1", "initial", {"mm/s^2", 1e3}, 19.2, {20.1, 20.8, 19.6}, ""},
        {"Γ_5", "initial", {"mm/s^2", 1e3}, 1.374, {1.402, 1.525, 1.375}, ""},
        {"I_V",
         "sum of ratios",
         {"", 1.0},
         3.691,
         {3.629, 3.496, 3.624},
         "set C: local optimum only"},
        {"r_L", "optimal", {"m", 1.0}, 0.2, {0.2, 0.2, 0.2}, "on its bound"},
        {"r_X", "optimal", {"m", 1.0}, 0.0, {0.0, 0.0, 0.0}, "on its bound"},
        {"x_tr", "optimal", {"m", 1.0}, -0.0825, {-0.0825, -0.0825, -0.1825}, ""}},
       "Printed values are from the paper; the sets were fitted to them, so agreement shows "
       "consistency, not that the author's data were found."}};
  c.warnings = {"Step 1 ends on 3 of 3 bounds: more freedom would lower the index further."};
  return c;
}

inline StudyReportData MakeSampleStudy() {
  StudyReportData data;
  data.title = "Steering kickback: C-segment car";
  data.subtitle =
      "One-sided obstacle pulse at 35 km/h, planar model, hydraulic and electric assistance "
      "(sample data)";
  data.program = "kingpin 0.1.0";
  data.command = "kingpin study examples/c_segment/study.yaml -o results/c_segment";
  data.run_seconds = 14.2;
  data.measures = MakeMeasures();
  data.cases = {MakeCase("hydraulic", 1.0), MakeCase("electric", 0.55)};
  data.summary = {"Both cars gain most from a tie-rod joint closer to the kingpin axis."};
  data.further.text =
      "All characteristics and the geometry free within ±30 % of their start. The index falls to "
      "about half of "
      "the paper's, at the price of road feel shown in the last column and in the Pareto fronts.";
  data.further.ratio_symbols = {"Γ_1", "Γ_2", "Γ_3", "Γ_4", "Γ_5"};
  data.further.rows = {{"set A",
                        "geometry and all characteristics ±30 %",
                        5.0,
                        "OPT2",
                        3.85,
                        2.15,
                        {0.55, 0.36, 0.20, 0.60, 0.44},
                        0.81,
                        ""},
                       {"set B",
                        "geometry and all characteristics ±30 %",
                        5.0,
                        "OPT2",
                        4.118,
                        2.61,
                        {0.66, 0.45, 0.31, 0.63, 0.56},
                        0.77,
                        "two bounds active"},
                       {"set C",
                        "geometry and all characteristics ±30 %",
                        5.0,
                        "OPT2",
                        4.054,
                        2.43,
                        {0.61, 0.44, 0.26, 0.62, 0.50},
                        0.86,
                        ""}};
  data.further.pareto = {MakeFront("Set A, ±30 %", 2.15), MakeFront("Set B, ±30 %", 2.6)};
  data.parameters = {
      {"Steering",
       "models/data/cars/c_segment/steering.yaml",
       {{"steering.rack.mass", "2.0", "kg", "paper, Table 1", false},
        {"steering.wheel.inertia", "0.04", "kg*m^2", "paper, Table 1", false},
        {"steering.wheel.radius", "0.185", "m", "paper, section 2", false},
        {"steering.column.stiffness", "60", "N*m/rad", "--set", true}}},
      {"Suspension",
       "models/data/cars/c_segment/front_suspension.yaml",
       {{"front.tie_rod.length", "0.31", "m", "estimate: C-segment class", false},
        {"front.longitudinal.force", "-16672, -5911, -1394.5, 0, 1394.5, 5911, 16672", "N",
         "identified, set B", false}}}};
  data.options = {{"hands", "free"}, {"friction", "set-valued, μ = 0.08"}, {"assist lag", "off"}};
  data.conventions = {
      {"axes", "ISO 8855: x forward, y left, z up; steering wheel angle positive to the left."},
      {"A_tan", "Rim acceleration: wheel angular acceleration times 0.185 m."}};
  data.solver = {{"integrator", "exponential Runge-Kutta, h = 0.25 ms"}, {"simulations", "55 540"}};
  data.versions = {{"kingpin", "0.1.0"}, {"instruction set", "AVX-512, 8 lanes"}};
  data.inputs = {{"examples/c_segment/study.yaml", "fnv1a64:9ae16a3b2f90404f", 1432},
                 {"models/data/cars/c_segment/steering.yaml", "fnv1a64:c3a5c85c97cb3127", 20531}};
  return data;
}

}  // namespace kingpin::report::sample
