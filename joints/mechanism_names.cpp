#include "joints/mechanism_names.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/io/nearest_name.h"
#include "joints/fail.h"

namespace kingpin::joints {

namespace {

// Names and kinds of the coordinates, as q or v has them.
std::vector<CoordinateName> ListCoordinates(const Mechanism& mechanism, bool velocities) {
  std::vector<CoordinateName> list;
  for (const Mechanism::JointPlace& joint : mechanism.joints) {
    const auto add = [&](const char* suffix, bool turns) {
      const std::string name = *suffix ? joint.name + '.' + suffix : joint.name;
      list.push_back({name, turns, std::string_view(suffix).starts_with("quaternion")});
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

}  // namespace

std::vector<CoordinateName> ListPositionNames(const Mechanism& mechanism) {
  return ListCoordinates(mechanism, false);
}

std::vector<CoordinateName> ListVelocityNames(const Mechanism& mechanism) {
  return ListCoordinates(mechanism, true);
}

std::string GetUnit(const CoordinateName& c, int derivative) {
  if (c.is_quaternion) return "1";
  const char* length[] = {"m", "m/s", "m/s^2"};
  const char* angle[] = {"rad", "rad/s", "rad/s^2"};
  return c.turns ? angle[derivative] : length[derivative];
}

std::string GetReactionUnit(const Mechanism& mechanism, int row) {
  const std::string& name = mechanism.system.model.row_names[row];
  const size_t dot = name.rfind('.');
  if (dot != std::string::npos && name.compare(dot + 1, 4, "turn") == 0) return "N m";
  for (const mechanism::LinearRow& linear : mechanism.system.model.linear) {
    if (linear.row != row) continue;
    const auto coordinates = ListVelocityNames(mechanism);
    // a gear between angles has a torque; with a displacement in it the row is one of lengths
    return std::all_of(linear.terms.begin(), linear.terms.end(),
                       [&](const auto& term) { return coordinates[term.v].turns; })
               ? "N m"
               : "N";
  }
  for (const mechanism::PerpendicularClosure& c : mechanism.system.model.perpendiculars) {
    if (c.row == row) return "N m";
  }
  return "N";
}

std::vector<std::string> GetNames(const std::vector<CoordinateName>& coordinates) {
  std::vector<std::string> names;
  for (const CoordinateName& c : coordinates) names.push_back(c.name);
  return names;
}

std::vector<int> FindNamed(const std::string& chosen, const std::vector<std::string>& names,
                           const Source& source, const std::string& key, const char* what) {
  std::vector<int> found;
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i] == chosen || names[i].starts_with(chosen + '.')) {
      found.push_back(static_cast<int>(i));
    }
  }
  if (!found.empty()) return found;
  Fail(source, key, fmt::format("'{}'", chosen), fmt::format("the name of a {}", what),
       io::SuggestName(chosen, names, "names"));
}

}  // namespace kingpin::joints
