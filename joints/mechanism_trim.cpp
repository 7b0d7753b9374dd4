#include "joints/mechanism_trim.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "core/io/nearest_name.h"
#include "core/mechanism/evaluator.h"
#include "joints/fail.h"
#include "joints/mechanism_names.h"

namespace kingpin::joints {

namespace {

using Quantity = MechanismFile::Trim::Quantity;

constexpr int kIterations = 30;
constexpr double kTolerance = 1e-8;  // of targets, against 1 + their size
// Equilibria are good to some 1e-9: differences over this step to 1e-5, which Newton's method
// takes.
constexpr double kDifference = 1e-4;

const char* GetName(Quantity quantity) {
  switch (quantity) {
    case Quantity::kFree:
      return "free";
    case Quantity::kPreload:
      return "preload";
    case Quantity::kForce:
      return "force";
    case Quantity::kTarget:
      return "target";
  }
  return "";
}

const std::string& GetForceName(const ForceDescription& force) {
  return std::visit([](const auto& f) -> const std::string& { return f.name; }, force);
}

ForceDescription* FindForce(std::vector<ForceDescription>& forces, const std::string& name) {
  for (ForceDescription& force : forces) {
    if (GetForceName(force) == name) return &force;
  }
  return nullptr;
}

bool Fits(const ForceDescription& force, Quantity quantity) {
  if (const auto* spring = std::get_if<SpringDescription>(&force)) {
    const bool has_free = spring->free || !std::holds_alternative<BetweenPoints>(spring->place);
    return quantity == Quantity::kPreload || (quantity == Quantity::kFree && has_free);
  }
  return std::holds_alternative<MotorDescription>(force) &&
         (quantity == Quantity::kForce || quantity == Quantity::kTarget);
}

double Get(const ForceDescription& force, Quantity quantity) {
  if (const auto* spring = std::get_if<SpringDescription>(&force)) {
    return quantity == Quantity::kFree ? spring->free.value_or(0) : spring->preload;
  }
  const auto& motor = std::get<MotorDescription>(force);
  if (quantity == Quantity::kForce) return motor.force ? motor.force(0) : 0;
  return motor.target ? motor.target(0)[0] : 0;
}

void Set(ForceDescription& force, Quantity quantity, double value) {
  if (auto* spring = std::get_if<SpringDescription>(&force)) {
    (quantity == Quantity::kFree ? spring->free.emplace() : spring->preload) = value;
    return;
  }
  auto& motor = std::get<MotorDescription>(force);
  if (quantity == Quantity::kForce) {
    motor.force = [value](double) { return value; };
  } else {
    motor.target = [value](double) { return std::array<double, 3>{value, 0, 0}; };
  }
}

// Coordinates, then reactions.
std::vector<std::string> ListTargets(const Mechanism& mechanism) {
  std::vector<std::string> names = GetNames(ListPositionNames(mechanism));
  for (const std::string& row : mechanism.system.model.row_names) {
    names.push_back(row + ".reaction");
  }
  return names;
}

}  // namespace

void CheckTrim(const MechanismFile& file, const Mechanism& mechanism) {
  const MechanismFile::Trim& trim = file.trim;
  if (trim.vary.size() != trim.targets.size()) {
    Fail(trim.source, "equilibrium",
         fmt::format("{} quantities and {} targets", trim.vary.size(), trim.targets.size()),
         "as many quantities as targets");
  }
  std::vector<std::string> forces;
  for (const ForceDescription& force : file.forces) forces.push_back(GetForceName(force));
  for (size_t i = 0; i < trim.vary.size(); ++i) {
    const MechanismFile::Trim::Vary& vary = trim.vary[i];
    const auto found = std::find(forces.begin(), forces.end(), vary.of);
    if (found == forces.end()) {
      Fail(vary.source, fmt::format("equilibrium.vary[{}].of", i), fmt::format("'{}'", vary.of),
           "the name of a spring or a motor", io::SuggestName(vary.of, forces, "names"));
    }
    if (!Fits(file.forces[found - forces.begin()], vary.quantity)) {
      Fail(vary.source, fmt::format("equilibrium.vary[{}].quantity", i),
           fmt::format("'{}' of '{}'", GetName(vary.quantity), vary.of),
           "preload, or free where it is given, of a spring; force or target of a motor");
    }
  }
  const std::vector<std::string> names = ListTargets(mechanism);
  for (size_t i = 0; i < trim.targets.size(); ++i) {
    const MechanismFile::Trim::Target& target = trim.targets[i];
    if (std::find(names.begin(), names.end(), target.of) != names.end()) continue;
    Fail(target.source, fmt::format("equilibrium.targets[{}].of", i),
         fmt::format("'{}'", target.of), "a coordinate, or ROW.reaction",
         io::SuggestName(target.of, names, "names"));
  }
}

std::vector<TrimmedQuantity> Trim(MechanismFile& file) {
  const MechanismFile::Trim& trim = file.trim;
  const int n = static_cast<int>(trim.vary.size());
  if (n == 0 && trim.targets.empty()) return {};
  file.start_at_rest = false;
  const Mechanism first = MakeMechanism(file);
  CheckTrim(file, first);
  file.start_at_rest = true;
  const std::vector<std::string> names = ListTargets(first);
  const int positions = first.system.model.positions;
  const auto apply = [&](const Eigen::VectorXd& p) {
    for (int i = 0; i < n; ++i) {
      Set(*FindForce(file.forces, trim.vary[i].of), trim.vary[i].quantity, p[i]);
    }
  };
  // how far the equilibrium is off the targets, in units of 1 + their size
  const auto measure = [&](const Eigen::VectorXd& p) {
    apply(p);
    const Mechanism mechanism = MakeMechanism(file);
    mechanism::Evaluator evaluator(mechanism.system);
    evaluator.ReleaseFriction();
    std::vector<double> rate(mechanism.system.size());
    evaluator.CalcRates(0, mechanism.start, rate);
    Eigen::VectorXd off(n);
    for (int i = 0; i < n; ++i) {
      const int k = static_cast<int>(std::find(names.begin(), names.end(), trim.targets[i].of) -
                                     names.begin());
      const double value =
          k < positions ? mechanism.start[k] : evaluator.reactions()[k - positions];
      off[i] = (value - trim.targets[i].value) / (1 + std::abs(trim.targets[i].value));
    }
    return off;
  };
  Eigen::VectorXd p(n);
  for (int i = 0; i < n; ++i) {
    p[i] = Get(*FindForce(file.forces, trim.vary[i].of), trim.vary[i].quantity);
  }
  Eigen::VectorXd off = measure(p);
  for (int iteration = 0; iteration < kIterations && off.norm() > kTolerance; ++iteration) {
    Eigen::MatrixXd slope(n, n);
    for (int i = 0; i < n; ++i) {
      Eigen::VectorXd changed = p;
      changed[i] += kDifference * (1 + std::abs(p[i]));
      slope.col(i) = (measure(changed) - off) / (changed[i] - p[i]);
    }
    const Eigen::VectorXd step = slope.colPivHouseholderQr().solve(off);
    if (!step.allFinite()) break;
    bool closer = false;
    for (double share = 1; share > 1e-4 && !closer; share /= 2) {
      const Eigen::VectorXd trial = p - share * step;
      Eigen::VectorXd there;
      try {
        there = measure(trial);
      } catch (const io::InputError&) {
        throw;
      } catch (const std::runtime_error&) {
        continue;  // no equilibrium that far away
      }
      if (there.norm() < off.norm()) {
        p = trial;
        off = there;
        closer = true;
      }
    }
    if (!closer) break;
  }
  if (!(off.norm() <= kTolerance)) {
    int worst = 0;
    off.cwiseAbs().maxCoeff(&worst);
    const MechanismFile::Trim::Target& target = trim.targets[worst];
    throw std::runtime_error(fmt::format(
        "equilibrium: the target {:g} of '{}' is missed by {:.3g}; do the quantities that are "
        "varied act on it?",
        target.value, target.of, off[worst] * (1 + std::abs(target.value))));
  }
  apply(p);
  std::vector<TrimmedQuantity> result;
  for (int i = 0; i < n; ++i) {
    result.push_back({fmt::format("{}.{}", trim.vary[i].of, GetName(trim.vary[i].quantity)), p[i]});
  }
  return result;
}

}  // namespace kingpin::joints
