#include "joints/mechanism_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/mechanism/kinematics.h"
#include "core/solve/linearise.h"
#include "core/solve/null_space.h"
#include "joints/axis_place.h"
#include "joints/mechanism_linear.h"
#include "joints/mechanism_names.h"
#include "joints/mechanism_trim.h"
#include "joints/turn_watch.h"

namespace kingpin::joints {

namespace {

const char* GetMethodName(solve::Method method) {
  switch (method) {
    case solve::Method::kRosenbrock:
      return "Rosenbrock, order 3, fixed step";
    case solve::Method::kRungeKutta4:
      return "Runge-Kutta, order 4, fixed step";
    case solve::Method::kExplicit8:
      return "explicit, order 8, adaptive (ARKODE)";
    case solve::Method::kBdf:
      return "backward differentiation, adaptive (CVODE)";
  }
  return "";
}

int CountFreedom(const Mechanism& mechanism) {
  const std::span<const double> q(mechanism.start.data(), mechanism.system.model.positions);
  return solve::CalcNullSpace(mechanism.system.model, q).freedoms();
}

std::vector<std::string> ListRedundantRows(const mechanism::Model& model) {
  std::vector<std::string> names;
  for (int r = 0; r < model.rows; ++r) {
    if (model.redundant[r] && !model.switching[r]) names.push_back(model.row_names[r]);
  }
  return names;
}

// What a stop meets over a run.
class StopWatch {
 public:
  StopWatch(const MechanismFile& file, const Mechanism& mechanism) {
    for (const ForceDescription& force : file.forces) {
      const auto* stop = std::get_if<StopDescription>(&force);
      if (stop == nullptr) continue;
      Watch watch{stop->name, stop->upper ? 1.0 : -1.0, stop->limit, "m", {}};
      if (const auto* on = std::get_if<OnCoordinate>(&stop->place)) {
        const Mechanism::JointPlace& joint = mechanism.GetJoint(on->joint);
        const auto coordinates = ListVelocityNames(mechanism);
        if (coordinates[joint.v + on->coordinate].turns) watch.unit = "rad";
        watch.place = CoordinatePlace{joint.q + on->coordinate, joint.v + on->coordinate};
      } else if (const auto* between = std::get_if<BetweenPoints>(&stop->place)) {
        watch.place = PointPlace{mechanism.MakeFrame(between->a), mechanism.MakeFrame(between->b)};
      } else if (const auto* about = std::get_if<AboutAxis>(&stop->place)) {
        watch.unit = "rad";
        watch.place = MakeAxisPlace(mechanism, *about);
      }
      watches_.push_back(std::move(watch));
    }
  }

  void Look(const mechanism::ForceContext<double>& context) {
    for (Watch& watch : watches_) {
      const double x =
          std::visit([&context](const auto& place) { return place.Calc(context).x; }, watch.place);
      const double depth = watch.sign * (x - watch.limit);
      if (depth > 0 && !watch.touches) {
        if (watch.contacts++ == 0) watch.first = context.time;
      }
      watch.touches = depth > 0;
      watch.deepest = std::max(watch.deepest, depth);
    }
  }

  nlohmann::ordered_json MakeJson() const {
    nlohmann::ordered_json json;
    for (const Watch& watch : watches_) {
      auto& entry = json[watch.name];
      entry["contacts"] = watch.contacts;
      if (watch.contacts > 0) entry["first"] = watch.first;
      entry["deepest"] = watch.deepest;
      entry["unit"] = watch.unit;
    }
    return json;
  }
  bool empty() const { return watches_.empty(); }

 private:
  struct Watch {
    std::string name;
    double sign = 1, limit = 0;
    const char* unit = "m";
    std::variant<CoordinatePlace, PointPlace, AxisPlace> place;
    bool touches = false;
    int contacts = 0;
    double first = 0, deepest = 0;
  };
  std::vector<Watch> watches_;
};

nlohmann::ordered_json MakeJson(const std::vector<TrimmedQuantity>& trimmed) {
  nlohmann::ordered_json json;
  for (const TrimmedQuantity& quantity : trimmed) json[quantity.name] = quantity.value;
  return json;
}

std::string FormatTrimmed(const std::vector<TrimmedQuantity>& trimmed) {
  std::string text;
  for (const TrimmedQuantity& quantity : trimmed) {
    text += fmt::format("Equilibrium meets its targets with {} = {:.9g}\n", quantity.name,
                        quantity.value);
  }
  return text;
}

struct ShownNames {
  std::vector<std::string> coordinates, reactions;
};

// The channels that `report:` chooses; by default what is not inside a beam.
ShownNames FindShownNames(const MechanismFile& file, const Mechanism& mechanism) {
  const auto choose = [](const std::vector<std::string>& chosen,
                         const std::vector<std::string>& names,
                         const std::vector<std::string>& hidden, const Source& source,
                         const char* key, const char* what) {
    std::vector<std::string> result;
    for (const std::string& name : chosen) {
      for (int i : FindNamed(name, names, source, key, what)) result.push_back(names[i]);
    }
    if (!chosen.empty()) return result;
    for (const std::string& name : names) {
      const bool inside =
          std::any_of(hidden.begin(), hidden.end(), [&name](const std::string& joint) {
            return name == joint || name.starts_with(joint + '.');
          });
      if (!inside) result.push_back(name);
    }
    return result.empty() ? names : result;
  };
  return {choose(file.report.coordinates, GetNames(ListPositionNames(mechanism)), file.beam_joints,
                 file.report.coordinates_source, "report.coordinates", "joint or coordinate"),
          choose(file.report.reactions, mechanism.system.model.row_names, {},
                 file.report.reactions_source, "report.reactions",
                 "closure, coupling, motion, friction or row")};
}

std::vector<io::Signals::Channel> MakeChannels(const Mechanism& mechanism) {
  const mechanism::Model& model = mechanism.system.model;
  const auto positions = ListPositionNames(mechanism), velocities = ListVelocityNames(mechanism);
  std::vector<io::Signals::Channel> channels;
  const auto add = [&](std::string name, const std::string& unit) {
    channels.push_back({std::move(name), unit, unit, {}});
  };
  for (const CoordinateName& c : positions) add(c.name, GetUnit(c, 0));
  for (const CoordinateName& c : velocities) add(c.name + ".rate", GetUnit(c, 1));
  for (const CoordinateName& c : velocities) add(c.name + ".acceleration", GetUnit(c, 2));
  for (int r = 0; r < model.rows; ++r)
    add(model.row_names[r] + ".reaction", GetReactionUnit(mechanism, r));
  for (const char* part : {"kinetic", "potential", "total", "dissipated", "supplied", "balance"}) {
    add(fmt::format("energy.{}", part), "J");
  }
  for (const char* part : {"x", "y", "z", "balance"}) {
    add(fmt::format("momentum.{}", part), "N s");
  }
  for (const char* part : {"x", "y", "z", "balance"}) {
    add(fmt::format("angular_momentum.{}", part), "N m s");
  }
  add("residual.position", "1");
  add("residual.velocity", "1");
  return channels;
}

void AddSample(double time, std::span<const double> state, const solve::Ledger& ledger,
               mechanism::Evaluator& evaluator, io::Signals& signals) {
  const mechanism::Model& model = evaluator.system().model;
  signals.time.push_back(time);
  size_t channel = 0;
  const auto put = [&](double value) { signals.channels[channel++].values.push_back(value); };
  for (int i = 0; i < model.positions + model.velocities; ++i) put(state[i]);
  for (double a : evaluator.accelerations()) put(a);
  for (double reaction : evaluator.reactions()) put(reaction);
  const mechanism::Energy energy = evaluator.CalcEnergy(time, state);
  put(energy.kinetic);
  put(energy.potential);
  put(energy.kinetic + energy.potential);
  put(ledger.dissipated);
  put(ledger.supplied);
  put(energy.kinetic + energy.potential - ledger.energy_start - ledger.supplied +
      ledger.dissipated);
  const math::Wrench<double> momentum = evaluator.CalcMomentum();
  const math::Wrench<double> error = momentum - ledger.momentum_start - ledger.impulse;
  const auto put_vector = [&](const math::Vector3<double>& v, const math::Vector3<double>& off) {
    for (double value : {v.x, v.y, v.z, CalcNorm(off)}) put(value);
  };
  put_vector(momentum.f, error.f);
  put_vector(momentum.t, error.t);
  const auto residuals = evaluator.CalcResiduals(time, state);
  put(residuals.position);
  put(residuals.velocity);
}

// A sample that could not be evaluated to its end, or to finite numbers, is none.
void DropUnfinishedSamples(io::Signals& signals) {
  size_t samples = signals.time.size();
  for (const auto& channel : signals.channels) {
    const auto end = std::find_if_not(channel.values.begin(), channel.values.end(),
                                      [](double value) { return std::isfinite(value); });
    samples = std::min(samples, static_cast<size_t>(end - channel.values.begin()));
  }
  signals.time.resize(samples);
  for (auto& channel : signals.channels) channel.values.resize(samples);
}

// Thrown where the user ends a run.
struct Ended {};

nlohmann::ordered_json MakeEnd(const Mechanism& mechanism, const io::Signals& signals) {
  nlohmann::ordered_json end;
  for (int i = 0; i < mechanism.system.model.positions; ++i) {
    end[signals.channels[i].name] = signals.channels[i].values.back();
  }
  return end;
}

void AddSummary(const MechanismFile& file, const Mechanism& mechanism, const solve::Ledger& ledger,
                const std::vector<TrimmedQuantity>& trimmed, MechanismRun& run) {
  const mechanism::Model& model = mechanism.system.model;
  const int freedom = CountFreedom(mechanism);
  const std::vector<std::string> redundant = ListRedundantRows(model);
  run.summary["name"] = mechanism.system.name;
  run.summary["method"] = GetMethodName(file.simulation.stepper.method);
  run.summary["finished"] = run.finished;
  if (!run.failure.empty()) run.summary["failure"] = run.failure;
  run.summary["time_reached"] = run.signals.time.back();
  run.summary["coordinates"] = model.velocities;
  run.summary["constraint_rows"] = model.rows;
  run.summary["degrees_of_freedom"] = freedom;
  run.summary["redundant_rows"] = redundant;
  run.summary["largest_residual"] = {{"position", ledger.largest_position_residual},
                                     {"velocity", ledger.largest_velocity_residual}};
  run.summary["energy"] = {{"unit", "J"},
                           {"start", ledger.energy_start},
                           {"end", ledger.energy_end},
                           {"supplied", ledger.supplied},
                           {"dissipated", ledger.dissipated},
                           {"largest_kinetic", ledger.largest_kinetic},
                           {"largest_error", ledger.largest_energy_error}};
  const auto momentum = [](const char* unit, math::Vector3<double> start, math::Vector3<double> end,
                           math::Vector3<double> impulse, double largest_error) {
    const auto list = [](const math::Vector3<double>& v) {
      return nlohmann::ordered_json{v.x, v.y, v.z};
    };
    return nlohmann::ordered_json{{"unit", unit},
                                  {"start", list(start)},
                                  {"end", list(end)},
                                  {"impulse", list(impulse)},
                                  {"largest_error", largest_error}};
  };
  run.summary["momentum"] = momentum("N s", ledger.momentum_start.f, ledger.momentum_end.f,
                                     ledger.impulse.f, ledger.largest_momentum_error);
  run.summary["angular_momentum"] =
      momentum("N m s", ledger.momentum_start.t, ledger.momentum_end.t, ledger.impulse.t,
               ledger.largest_angular_momentum_error);
  if (!trimmed.empty()) run.summary["equilibrium"] = MakeJson(trimmed);
  run.summary["friction_switches"] = ledger.switches;
  if (run.finished) {  // only a finished run has counted its steps
    run.statistics = {{"steps", static_cast<double>(ledger.steps)},
                      {"jacobians", static_cast<double>(ledger.jacobians)}};
  }
  run.statistics.emplace_back("friction_switches", static_cast<double>(ledger.switches));

  run.text = FormatTrimmed(trimmed);
  run.text += fmt::format("{}: {} coordinates, {} constraint rows, {} degree{} of freedom\n",
                          mechanism.system.name, model.velocities, model.rows, freedom,
                          freedom == 1 ? "" : "s");
  if (!redundant.empty()) {
    run.text +=
        fmt::format("Redundant rows, reactions taken as zero: {}\n", fmt::join(redundant, ", "));
  }
  run.text +=
      run.finished
          ? fmt::format("{:g} s by {}: {} steps\n", file.simulation.duration,
                        GetMethodName(file.simulation.stepper.method), ledger.steps)
          : fmt::format("{:g} s of {:g} s by {}, then it ended early\n", run.signals.time.back(),
                        file.simulation.duration, GetMethodName(file.simulation.stepper.method));
  run.text += fmt::format(
      "Largest residual of the constraints: {:.1e} m or rad, {:.1e} m/s or rad/s\n"
      "Energy: start {:.6g} J, end {:.6g} J, supplied {:.6g} J, dissipated {:.6g} J\n"
      "Balance of energy off by {:.1e} J, largest kinetic energy {:.6g} J\n"
      "Balance of momentum off by {:.1e} N s, of angular momentum by {:.1e} N m s\n",
      ledger.largest_position_residual, ledger.largest_velocity_residual, ledger.energy_start,
      ledger.energy_end, ledger.supplied, ledger.dissipated, ledger.largest_energy_error,
      ledger.largest_kinetic, ledger.largest_momentum_error, ledger.largest_angular_momentum_error);
  if (ledger.switches > 0)
    run.text += fmt::format("Dry friction switched {} time{}\n", ledger.switches,
                            ledger.switches == 1 ? "" : "s");
}

}  // namespace

void CheckNames(const MechanismFile& file, const Mechanism& mechanism) {
  FindShownNames(file, mechanism);
  CheckResponses(file, mechanism);
  CheckTrim(file, mechanism);
}

MechanismRun RunMechanism(const MechanismFile& given, const Proceed& proceed) {
  MechanismFile file = given;
  Mechanism mechanism;
  std::vector<TrimmedQuantity> trimmed;
  try {
    trimmed = Trim(file);
    mechanism = MakeMechanism(file);
  } catch (const io::InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw io::RunError(error.what());
  }
  const mechanism::Model& model = mechanism.system.model;
  CheckNames(file, mechanism);

  MechanismRun run;
  run.signals.channels = MakeChannels(mechanism);
  run.positions = model.positions;
  run.velocities = model.velocities;
  run.rows = model.rows;
  const ShownNames shown = FindShownNames(file, mechanism);
  run.shown_coordinates = shown.coordinates;
  run.shown_reactions = shown.reactions;

  std::vector<double> y = mechanism.start;
  solve::Ledger ledger;
  StopWatch stops(file, mechanism);
  TurnWatch turns(file.forces, mechanism);
  mechanism::Workspace<double> w(model);
  const auto observe = [&](double time, std::span<const double> state,
                           mechanism::Evaluator& evaluator) {
    AddSample(time, state, ledger, evaluator, run.signals);
    if (!stops.empty() || !turns.empty()) {
      mechanism::UpdatePositions(model, state.data(), w);
      mechanism::UpdateVelocities(model, state.data() + model.positions, w);
      const mechanism::ForceContext<double> context{
          model, time, state.data(), state.data() + model.positions, nullptr, nullptr, w};
      stops.Look(context);
      turns.Look(context);
    }
    if (proceed && !proceed(time)) throw Ended();
  };
  try {
    solve::Simulate(mechanism.system, file.simulation, y, observe, ledger);
  } catch (const Ended&) {
    run.finished = false;
  } catch (const std::runtime_error& error) {
    DropUnfinishedSamples(run.signals);
    if (run.signals.time.empty()) throw io::RunError(error.what());
    run.finished = false;
    run.failure = error.what();
  }

  for (const solve::FrictionEvent& event : ledger.events) {
    const std::string& name = model.row_names[mechanism.system.friction[event.element].row];
    run.friction_changes.push_back({event.time, name, event.mode});
  }
  AddSummary(file, mechanism, ledger, trimmed, run);
  if (!stops.empty()) run.summary["stops"] = stops.MakeJson();
  run.summary["end"] = MakeEnd(mechanism, run.signals);
  return run;
}

MechanismModes CalcMechanismModes(const MechanismFile& given) {
  MechanismFile file = given;
  std::vector<TrimmedQuantity> trimmed;
  Mechanism mechanism;
  std::vector<solve::Mode> modes;
  StateSpace space;
  MechanismModes result;
  try {
    trimmed = Trim(file);
    mechanism = MakeMechanism(file);
    CheckNames(file, mechanism);
    space = CalcStateSpace(file, mechanism);
    modes = solve::CalcModes(space.linear);
    result.responses = CalcResponses(file, space);
  } catch (const io::InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw io::RunError(error.what());
  }
  const solve::Linearisation& linear = space.linear;
  const auto coordinates = ListVelocityNames(mechanism);
  auto& json = result.json;
  json["name"] = mechanism.system.name;
  if (!trimmed.empty()) json["equilibrium"] = MakeJson(trimmed);
  json["independent"] = {{"positions", linear.positions},
                         {"velocities", linear.velocities},
                         {"states", linear.states}};
  const auto matrix = [](const Eigen::MatrixXd& m) {
    auto rows = nlohmann::ordered_json::array();
    for (int i = 0; i < m.rows(); ++i) {
      auto row = nlohmann::ordered_json::array();
      for (int j = 0; j < m.cols(); ++j) row.push_back(m(i, j));
      rows.push_back(std::move(row));
    }
    return rows;
  };
  const auto names = [](const std::vector<StateSpace::Name>& list) {
    auto entries = nlohmann::ordered_json::array();
    for (const auto& [name, unit] : list) entries.push_back({{"name", name}, {"unit", unit}});
    return entries;
  };
  json["inputs"] = names(space.inputs);
  json["outputs"] = names(space.outputs);
  json["A"] = matrix(linear.A);
  json["B"] = matrix(space.B);
  json["C"] = matrix(space.C);
  json["D"] = matrix(space.D);
  json["position_basis"] = matrix(linear.position_basis);
  json["velocity_basis"] = matrix(linear.velocity_basis);
  result.text = fmt::format(
      "{}: {} independent positions\n\n  {:>12} {:>10}  {:>24}  largest motion\n",
      mechanism.system.name, linear.positions, "frequency Hz", "damping", "eigenvalue 1/s");
  auto list = nlohmann::ordered_json::array();
  for (const solve::Mode& mode : modes) {
    nlohmann::ordered_json shape;
    std::string largest;
    for (size_t i = 0; i < coordinates.size(); ++i) {
      const std::complex<double> x = mode.shape[static_cast<int>(i)];
      shape[coordinates[i].name] = {x.real(), x.imag()};
      if (std::abs(x) > 0.999999 && largest.empty()) largest = coordinates[i].name;
    }
    list.push_back({{"eigenvalue", {mode.eigenvalue.real(), mode.eigenvalue.imag()}},
                    {"frequency_hz", mode.frequency},
                    {"damping_ratio", mode.damping_ratio},
                    {"shape", shape}});
    result.text +=
        fmt::format("  {:12.6g} {:10.4g}  {:11.5g} {:+11.5g}i  {}\n", mode.frequency,
                    mode.damping_ratio, mode.eigenvalue.real(), mode.eigenvalue.imag(), largest);
  }
  json["modes"] = std::move(list);
  result.text += FormatTrimmed(trimmed);
  auto responses = nlohmann::ordered_json::array();
  for (const ResponseCurve& curve : result.responses) {
    std::vector<double> magnitude, phase;
    for (const std::complex<double>& value : curve.values) {
      magnitude.push_back(std::abs(value));
      phase.push_back(std::arg(value) * 180 / std::numbers::pi);
    }
    const auto peak = std::max_element(magnitude.begin(), magnitude.end()) - magnitude.begin();
    result.text +=
        fmt::format("\n{}: {} to {}, largest {:.6g} {} at {:.6g} Hz", curve.name, curve.input,
                    curve.output, magnitude[peak], curve.unit, curve.frequency[peak]);
    responses.push_back({{"name", curve.name},
                         {"input", curve.input},
                         {"output", curve.output},
                         {"unit", curve.unit},
                         {"frequency", {{"unit", "Hz"}, {"values", curve.frequency}}},
                         {"magnitude", magnitude},
                         {"phase", {{"unit", "deg"}, {"values", phase}}}});
  }
  if (!result.responses.empty()) result.text += '\n';
  json["frequency_responses"] = std::move(responses);
  return result;
}

}  // namespace kingpin::joints
