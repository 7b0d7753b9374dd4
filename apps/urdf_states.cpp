#include "apps/urdf_states.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/io/error.h"
#include "core/io/nearest_name.h"
#include "core/io/utf8.h"
#include "core/io/yaml_document.h"
#include "joints/urdf.h"

namespace kingpin::apps {

namespace {

using nlohmann::json;

constexpr double kQuaternionRounding = 1e-3;
constexpr std::size_t kLargestStatesFile = std::size_t{1} << 30;

std::string Describe(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "a list";
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 60) + "...";
  return text;
}

class Reader {
 public:
  Reader(const std::string& file, const joints::Mechanism& mechanism, bool floating_base)
      : file_(file), mechanism_(mechanism), floating_base_(floating_base) {}

  UrdfStates Read() const {
    const json top = Parse(io::ReadTextFile(file_, kLargestStatesFile));
    CheckKeys(top, "", {"gravity", "states"});
    UrdfStates result;
    const std::vector<double> g = ReadNumbers(top.at("gravity"), "gravity", 3, "x, y, z in m/s^2");
    result.gravity = {g[0], g[1], g[2]};
    const json& states = top.at("states");
    if (!states.is_array()) Fail("states", Describe(states), "a list of states");
    if (states.empty()) Fail("states", "an empty list", "at least one state");
    for (std::size_t k = 0; k < states.size(); ++k) {
      result.states.push_back(ReadState(states[k], fmt::format("states[{}]", k)));
    }
    return result;
  }

 private:
  [[noreturn]] void Fail(std::string key, std::string found, std::string expected,
                         std::string suggestion = {}, int line = 0) const {
    throw io::InputError({.file = file_,
                          .line = line,
                          .key = std::move(key),
                          .found = std::move(found),
                          .expected = std::move(expected),
                          .suggestion = std::move(suggestion)});
  }

  json Parse(const std::string& text) const {
    const auto line_of = [&text](std::size_t at) {
      const auto end = text.begin() + static_cast<long>(std::min(at, text.size()));
      return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
    };
    if (const auto at = io::FindInvalidUtf8(text)) {
      Fail("",
           fmt::format("the byte 0x{:02X}, which is no UTF-8",
                       static_cast<unsigned char>(text[*at])),
           "a text file in UTF-8", {}, line_of(*at));
    }
    std::vector<std::set<std::string>> keys;  // of the objects that are open
    const auto watch = [&](int, json::parse_event_t event, json& value) {
      if (event == json::parse_event_t::object_start) keys.emplace_back();
      if (event == json::parse_event_t::object_end) keys.pop_back();
      if (event == json::parse_event_t::key && !keys.back().insert(value).second) {
        Fail(value.get<std::string>(), "a key given twice in one object", "each key once");
      }
      return true;
    };
    try {
      return json::parse(text, watch);
    } catch (const json::parse_error& error) {
      const std::string what = error.what();
      const auto detail = what.find(": ");
      Fail("", detail == std::string::npos ? what : "no JSON: " + what.substr(detail + 2),
           "a JSON file of states", "JSON has no NaN, no infinity and no remarks",
           line_of(error.byte));
    } catch (const json::out_of_range&) {
      Fail("", "a number beyond the range of double precision", "finite numbers");
    }
  }

  void CheckKeys(const json& object, const std::string& where,
                 const std::vector<std::string>& wanted) const {
    const std::string prefix = where.empty() ? "" : where + '.';
    if (!object.is_object()) {
      Fail(where, Describe(object),
           fmt::format("an object with the keys {}", fmt::join(wanted, ", ")));
    }
    for (const auto& [key, value] : object.items()) {
      if (std::find(wanted.begin(), wanted.end(), key) != wanted.end()) continue;
      if (key == "base_position" || key == "base_quaternion_xyzw") {
        Fail(prefix + key, "the pose of a base that is fixed", "none",
             "run with --floating-base to let it move");
      }
      Fail(prefix + key, "an unknown key",
           where.empty() ? "a key of the file" : fmt::format("a key of '{}'", where),
           io::SuggestName(key, wanted, "keys"));
    }
    for (const std::string& key : wanted) {
      if (!object.contains(key)) Fail(prefix + key, "nothing", "this key");
    }
  }

  double ReadNumber(const json& value, const std::string& key, std::string_view what) const {
    if (!value.is_number()) Fail(key, Describe(value), fmt::format("a number ({})", what));
    const double number = value.get<double>();
    if (!std::isfinite(number)) Fail(key, fmt::format("{}", number), "a finite number");
    return number;
  }

  std::vector<double> ReadNumbers(const json& value, const std::string& key, std::size_t count,
                                  std::string_view what) const {
    const auto expected = [&] { return fmt::format("a list of {} numbers ({})", count, what); };
    if (!value.is_array()) Fail(key, Describe(value), expected());
    if (value.size() != count) Fail(key, fmt::format("{} entries", value.size()), expected());
    std::vector<double> numbers;
    for (std::size_t i = 0; i < count; ++i) {
      numbers.push_back(ReadNumber(value[i], fmt::format("{}[{}]", key, i), what));
    }
    return numbers;
  }

  /// (x, y, z, w) of the file as (w, x, y, z) of unit length.
  void SetQuaternion(const std::vector<double>& xyzw, const std::string& key, double* wxyz) const {
    const double norm = std::hypot(std::hypot(xyzw[0], xyzw[1]), std::hypot(xyzw[2], xyzw[3]));
    if (!(std::abs(norm - 1) < kQuaternionRounding)) {
      Fail(key, fmt::format("a quaternion of length {:g}", norm), "x, y, z, w of length 1");
    }
    for (int i = 0; i < 4; ++i) wxyz[(i + 1) % 4] = xyzw[i] / norm;
  }

  void SetPosition(const json& value, const std::string& key,
                   const joints::Mechanism::JointPlace& place, double* q) const {
    switch (place.type) {
      case joints::JointType::kFree: {
        const auto x = ReadNumbers(value, key, 7, "x, y, z in m, then qx, qy, qz, qw");
        std::copy_n(x.begin(), 3, q);
        SetQuaternion({x.begin() + 3, x.end()}, key, q + 3);
        return;
      }
      case joints::JointType::kPlanar: {
        const auto x = ReadNumbers(value, key, 3, "x, y in m, angle in rad");
        std::copy_n(x.begin(), 3, q);
        return;
      }
      default:
        *q = ReadNumber(value, key,
                        place.type == joints::JointType::kPrismatic ? "metres" : "radians");
    }
  }

  UrdfStates::State ReadState(const json& value, const std::string& where) const {
    std::vector<std::string> keys = {"joint_positions", "v", "tau", "a"};
    if (floating_base_) keys.insert(keys.begin(), {"base_position", "base_quaternion_xyzw"});
    CheckKeys(value, where, keys);
    const mechanism::Model& model = mechanism_.system.model;
    UrdfStates::State state;
    state.q.resize(model.positions);
    const json& positions = value.at("joint_positions");
    const std::string place_key = where + ".joint_positions";
    std::vector<std::string> names;
    for (const auto& place : mechanism_.joints) {
      if (!(floating_base_ && place.name == joints::kFloatingBase)) names.push_back(place.name);
    }
    if (!positions.is_object()) {
      Fail(place_key, Describe(positions), "an object of joint names and values");
    }
    for (const auto& [name, unused] : positions.items()) {
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      Fail(place_key + '.' + name, "no joint of this name that moves",
           "the name of a movable joint", io::SuggestName(name, names, "joints"));
    }
    for (const auto& place : mechanism_.joints) {
      double* q = &state.q[place.q];
      if (floating_base_ && place.name == joints::kFloatingBase) {
        const auto p =
            ReadNumbers(value.at("base_position"), where + ".base_position", 3, "x, y, z in m");
        std::copy(p.begin(), p.end(), q);
        const std::string key = where + ".base_quaternion_xyzw";
        SetQuaternion(ReadNumbers(value.at("base_quaternion_xyzw"), key, 4, "x, y, z, w"), key,
                      q + 3);
        continue;
      }
      const std::string key = place_key + '.' + place.name;
      const auto found = positions.find(place.name);
      if (found == positions.end()) Fail(key, "nothing", "the position of this joint");
      SetPosition(*found, key, place, q);
    }
    const auto n = static_cast<std::size_t>(model.velocities);
    state.v = ReadNumbers(value.at("v"), where + ".v", n, "in the order of velocity_layout");
    state.tau = ReadNumbers(value.at("tau"), where + ".tau", n, "in the order of velocity_layout");
    state.a = ReadNumbers(value.at("a"), where + ".a", n, "in the order of velocity_layout");
    return state;
  }

  const std::string& file_;
  const joints::Mechanism& mechanism_;
  bool floating_base_;
};

}  // namespace

UrdfStates ReadUrdfStates(const std::string& file, const joints::Mechanism& mechanism,
                          bool floating_base) {
  return Reader(file, mechanism, floating_base).Read();
}

}  // namespace kingpin::apps
