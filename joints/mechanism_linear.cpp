#include "joints/mechanism_linear.h"

#include <cmath>

#include <fmt/format.h>

#include "core/io/nearest_name.h"
#include "core/mechanism/evaluator.h"
#include "joints/add_forces.h"
#include "joints/fail.h"
#include "joints/mechanism_names.h"

namespace kingpin::joints {

namespace {

struct Input {
  StateSpace::Name name;
  ForceDescription unit_force;
};

bool TurnsAt(const PlaceDescription& place, const Mechanism& mechanism) {
  if (const auto* on = std::get_if<OnCoordinate>(&place)) {
    const int v = mechanism.GetJoint(on->joint).v + on->coordinate;
    return ListVelocityNames(mechanism)[v].turns;
  }
  return std::holds_alternative<AboutAxis>(place);
}

std::vector<Input> ListInputs(const MechanismFile& file, const Mechanism& mechanism) {
  std::vector<Input> inputs;
  for (const ForceDescription& force : file.forces) {
    if (const auto* motor = std::get_if<MotorDescription>(&force)) {
      MotorDescription unit;
      unit.name = motor->name;
      unit.place = motor->place;
      unit.force = [](double) { return 1.0; };
      unit.source = motor->source;
      inputs.push_back(
          {{motor->name, TurnsAt(motor->place, mechanism) ? "N m" : "N"}, std::move(unit)});
    } else if (const auto* body = std::get_if<BodyForceDescription>(&force)) {
      BodyForceDescription unit = *body;
      unit.scale = nullptr;
      inputs.push_back({{body->name, "1"}, std::move(unit)});
    }
  }
  return inputs;
}

std::vector<StateSpace::Name> ListOutputs(const Mechanism& mechanism) {
  std::vector<StateSpace::Name> outputs;
  const auto coordinates = ListVelocityNames(mechanism);
  const char* suffixes[] = {"", ".rate", ".acceleration"};
  for (int derivative = 0; derivative < 3; ++derivative) {
    for (const CoordinateName& c : coordinates) {
      outputs.push_back({c.name + suffixes[derivative], GetUnit(c, derivative)});
    }
  }
  for (int r = 0; r < mechanism.system.model.rows; ++r) {
    outputs.push_back(
        {mechanism.system.model.row_names[r] + ".reaction", GetReactionUnit(mechanism, r)});
  }
  return outputs;
}

std::vector<std::string> GetNames(const std::vector<StateSpace::Name>& list) {
  std::vector<std::string> names;
  for (const StateSpace::Name& entry : list) names.push_back(entry.name);
  return names;
}

int FindIndex(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

}  // namespace

StateSpace CalcStateSpace(const MechanismFile& file, const Mechanism& mechanism) {
  const mechanism::Model& model = mechanism.system.model;
  StateSpace space;
  space.linear = solve::Linearise(mechanism.system, 0, mechanism.start);
  space.outputs = ListOutputs(mechanism);
  const std::vector<Input> inputs = ListInputs(file, mechanism);
  const int nv = model.velocities, n = static_cast<int>(space.linear.A.rows());
  const int outputs = static_cast<int>(space.outputs.size());
  space.C.resize(outputs, n);
  if (n > 0) {  // no empty matrix is taken apart
    space.C.topRows(nv) = space.linear.displacement;
    space.C.middleRows(nv, nv) = space.linear.rate;
    space.C.middleRows(nv + nv, nv) = space.linear.acceleration;
    space.C.bottomRows(model.rows) = space.linear.reaction;
  }
  space.B = Eigen::MatrixXd::Zero(n, static_cast<int>(inputs.size()));
  space.D = Eigen::MatrixXd::Zero(outputs, static_cast<int>(inputs.size()));
  for (size_t k = 0; k < inputs.size(); ++k) {
    space.inputs.push_back(inputs[k].name);
    Mechanism unit = MakeMechanism(file.description);
    unit.system.model.gravity = {};
    unit.system.drives.clear();
    AddForces({inputs[k].unit_force}, unit);
    std::vector<double> y(unit.system.size(), 0.0), rate(y.size());
    std::copy_n(mechanism.start.begin(), model.positions, y.begin());
    mechanism::Evaluator evaluator(unit.system);
    evaluator.ReleaseFriction();
    evaluator.CalcRates(0, y, rate);
    const Eigen::Map<const Eigen::VectorXd> acceleration(evaluator.accelerations().data(), nv);
    const int column = static_cast<int>(k);
    if (n > 0) space.B.col(column) = solve::MakeInputColumn(space.linear, acceleration);
    space.D.col(column).segment(nv + nv, nv) = acceleration;
    for (int r = 0; r < model.rows; ++r) {
      space.D(3 * nv + r, column) = evaluator.reactions()[r];
    }
  }
  return space;
}

std::vector<ResponseCurve> CalcResponses(const MechanismFile& file, const StateSpace& space) {
  std::vector<ResponseCurve> curves;
  const std::vector<std::string> inputs = GetNames(space.inputs), outputs = GetNames(space.outputs);
  for (const MechanismFile::Response& response : file.responses) {
    const int u = FindIndex(inputs, response.from), y = FindIndex(outputs, response.to);
    ResponseCurve curve;
    curve.name = response.name;
    curve.input = response.from;
    curve.output = response.to;
    const std::string &over = space.inputs[u].unit, &unit = space.outputs[y].unit;
    curve.unit = over == "1" ? unit : fmt::format("{}/({})", unit, over);
    const double ratio = std::log(response.high / response.low);
    for (int i = 0; i < response.points; ++i) {
      curve.frequency.push_back(response.low * std::exp(ratio * i / (response.points - 1)));
    }
    if (space.linear.A.rows() > 0) {
      curve.values = solve::CalcFrequencyResponse(space.linear.A, space.B.col(u), space.C.row(y),
                                                  space.D(y, u), curve.frequency);
    } else {  // driven throughout
      curve.values.assign(curve.frequency.size(), space.D(y, u));
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

void CheckResponses(const MechanismFile& file, const Mechanism& mechanism) {
  if (file.responses.empty()) return;
  std::vector<std::string> inputs;
  for (const Input& input : ListInputs(file, mechanism)) inputs.push_back(input.name.name);
  const std::vector<std::string> outputs = GetNames(ListOutputs(mechanism));
  for (const MechanismFile::Response& response : file.responses) {
    const auto look = [&response](const char* key, const std::string& name,
                                  const std::vector<std::string>& known, const char* expected) {
      if (FindIndex(known, name) >= 0) return;
      Fail(response.source, fmt::format("responses.{}.{}", response.name, key),
           fmt::format("'{}'", name), expected, io::SuggestName(name, known, "names"));
    };
    look("from", response.from, inputs, "the name of a motor or of a force on a body");
    look("to", response.to, outputs,
         "a coordinate, its rate or acceleration, or the reaction of a row, as in signals.csv");
  }
}

}  // namespace kingpin::joints
