#include "joints/mechanism_run.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/solve/linearise.h"
#include "core/solve/null_space.h"

namespace kingpin::joints {

namespace {

struct Coordinate {
  std::string name;
  bool turns = false;
};

// Names and kinds of the coordinates, as q or v has them.
std::vector<Coordinate> ListCoordinates(const Mechanism& mechanism, bool velocities) {
  std::vector<Coordinate> list;
  for (const Mechanism::JointPlace& joint : mechanism.joints) {
    const auto add = [&](const char* suffix, bool turns) {
      list.push_back({*suffix ? joint.name + '.' + suffix : joint.name, turns});
    };
    switch (joint.type) {
      case JointType::kFixed:
        break;
      case JointType::kRevolute:
      case JointType::kScrew:
        add("", true);
        break;
      case JointType::kPrismatic:
        add("", false);
        break;
      case JointType::kCylindrical:
        add("displacement", false), add("angle", true);
        break;
      case JointType::kUniversal:
        add("angle_1", true), add("angle_2", true);
        break;
      case JointType::kPlanar:
        add("x", false), add("y", false), add("angle", true);
        break;
      case JointType::kFree:
        add("x", false), add("y", false), add("z", false);
        [[fallthrough]];
      case JointType::kSpherical:
        if (!velocities) add("quaternion_w", true);
        for (const char* axis : {"x", "y", "z"}) {
          add(fmt::format("{}_{}", velocities ? "angular" : "quaternion", axis).c_str(), true);
        }
        break;
    }
  }
  return list;
}

std::string GetUnit(const Coordinate& c, int derivative) {
  if (c.name.find("quaternion") != std::string::npos) return "1";
  const char* length[] = {"m", "m/s", "m/s^2"};
  const char* angle[] = {"rad", "rad/s", "rad/s^2"};
  return c.turns ? angle[derivative] : length[derivative];
}

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
  return static_cast<int>(solve::CalcNullSpace(mechanism.system.model, q).cols());
}

std::vector<std::string> ListRedundantRows(const mechanism::Model& model) {
  std::vector<std::string> names;
  for (int r = 0; r < model.rows; ++r) {
    if (model.redundant[r] && !model.switching[r]) names.push_back(model.row_names[r]);
  }
  return names;
}

// Units of a row's reaction: closures push in newton or turn in newton metre, coordinates take what
// they are.
std::string GetReactionUnit(const Mechanism& mechanism, int row) {
  const std::string& name = mechanism.system.model.row_names[row];
  const size_t dot = name.rfind('.');
  if (dot != std::string::npos && name.compare(dot + 1, 4, "turn") == 0) return "N m";
  for (const mechanism::LinearRow& linear : mechanism.system.model.linear) {
    if (linear.row != row) continue;
    const auto coordinates = ListCoordinates(mechanism, true);
    return linear.terms.size() == 1 && coordinates[linear.terms[0].v].turns ? "N m" : "N";
  }
  for (const mechanism::PerpendicularClosure& c : mechanism.system.model.perpendiculars) {
    if (c.row == row) return "N m";
  }
  return "N";
}

}  // namespace

MechanismRun RunMechanism(const MechanismFile& file) {
  Mechanism mechanism;
  try {
    mechanism = MakeMechanism(file);
  } catch (const io::InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw io::RunError(error.what());
  }
  const mechanism::Model& model = mechanism.system.model;
  const auto positions = ListCoordinates(mechanism, false),
             velocities = ListCoordinates(mechanism, true);

  MechanismRun run;
  std::vector<io::Signals::Channel>& channels = run.signals.channels;
  const auto add = [&](std::string name, const std::string& unit) {
    channels.push_back({std::move(name), unit, unit, {}});
  };
  for (const Coordinate& c : positions) add(c.name, GetUnit(c, 0));
  for (const Coordinate& c : velocities) add(c.name + ".rate", GetUnit(c, 1));
  for (const Coordinate& c : velocities) add(c.name + ".acceleration", GetUnit(c, 2));
  for (int r = 0; r < model.rows; ++r)
    add(model.row_names[r] + ".reaction", GetReactionUnit(mechanism, r));
  add("energy.kinetic", "J");
  add("energy.potential", "J");

  std::vector<double> y = mechanism.start;
  const auto observe = [&](double time, std::span<const double> state,
                           mechanism::Evaluator& evaluator) {
    run.signals.time.push_back(time);
    size_t channel = 0;
    const auto put = [&](double value) { channels[channel++].values.push_back(value); };
    for (int i = 0; i < model.positions + model.velocities; ++i) put(state[i]);
    for (double a : evaluator.accelerations()) put(a);
    for (double reaction : evaluator.reactions()) put(reaction);
    const mechanism::Energy energy = evaluator.CalcEnergy(time, state);
    put(energy.kinetic);
    put(energy.potential);
  };
  solve::Ledger ledger;
  try {
    ledger = solve::Simulate(mechanism.system, file.simulation, y, observe);
  } catch (const std::runtime_error& error) {
    throw io::RunError(error.what());
  }

  const int freedom = CountFreedom(mechanism);
  const std::vector<std::string> redundant = ListRedundantRows(model);
  const double scale = std::max(ledger.largest_kinetic, 1e-300);
  run.summary["name"] = mechanism.system.name;
  run.summary["method"] = GetMethodName(file.simulation.stepper.method);
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
  run.summary["friction_switches"] = ledger.switches;
  nlohmann::ordered_json end;
  for (size_t i = 0; i < positions.size(); ++i) end[positions[i].name] = y[i];
  run.summary["end"] = end;
  run.statistics = {{"steps", static_cast<double>(ledger.steps)},
                    {"jacobians", static_cast<double>(ledger.jacobians)},
                    {"friction_switches", static_cast<double>(ledger.switches)}};

  run.text = fmt::format("{}: {} coordinates, {} constraint rows, {} degrees of freedom\n",
                         mechanism.system.name, model.velocities, model.rows, freedom);
  if (!redundant.empty()) {
    run.text +=
        fmt::format("Redundant rows, reactions taken as zero: {}\n", fmt::join(redundant, ", "));
  }
  run.text += fmt::format(
      "{:g} s by {}: {} steps\n"
      "Largest residual of the constraints: {:.1e} m or rad, {:.1e} m/s or rad/s\n"
      "Energy: start {:.6g} J, end {:.6g} J, supplied {:.6g} J, dissipated {:.6g} J; balance off "
      "by {:.1e} of the largest kinetic energy\n",
      file.simulation.duration, GetMethodName(file.simulation.stepper.method), ledger.steps,
      ledger.largest_position_residual, ledger.largest_velocity_residual, ledger.energy_start,
      ledger.energy_end, ledger.supplied, ledger.dissipated, ledger.largest_energy_error / scale);
  if (ledger.switches > 0)
    run.text += fmt::format("Dry friction switched {} times\n", ledger.switches);
  return run;
}

MechanismModes CalcMechanismModes(const MechanismFile& file) {
  Mechanism mechanism;
  std::vector<solve::Mode> modes;
  solve::Linearisation linear;
  try {
    mechanism = MakeMechanism(file);
    linear = solve::Linearise(mechanism.system, 0, mechanism.start);
    modes = solve::CalcModes(linear);
  } catch (const io::InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw io::RunError(error.what());
  }
  const auto coordinates = ListCoordinates(mechanism, true);
  MechanismModes result;
  auto& json = result.json;
  json["name"] = mechanism.system.name;
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
  json["A"] = matrix(linear.A);
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
  return result;
}

}  // namespace kingpin::joints
