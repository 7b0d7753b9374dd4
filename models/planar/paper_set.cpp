#include "models/planar/paper_set.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/io/error.h"
#include "models/planar/validate.h"

namespace kingpin::planar {
namespace {

using Json = nlohmann::json;

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  [[noreturn]] void Fail(std::string key, std::string found, std::string expected) const {
    io::InputProblem problem;
    problem.file = file_;
    problem.key = std::move(key);
    problem.found = std::move(found);
    problem.expected = std::move(expected);
    throw io::InputError(problem);
  }

  const Json& Get(const Json& node, const std::string& path, const std::string& key) const {
    if (!node.is_object()) Fail(path, node.type_name(), "an object");
    const auto it = node.find(key);
    if (it == node.end()) Fail(Join(path, key), "nothing", "a value: the key is missing");
    return *it;
  }

  double ToNumber(const Json& value, const std::string& path) const {
    if (!value.is_number()) Fail(path, value.dump().substr(0, 60), "a number");
    const double number = value.get<double>();
    if (!std::isfinite(number)) Fail(path, "a number that is not finite", "a finite number");
    return number;
  }

  double Number(const Json& node, const std::string& path, const std::string& key) const {
    return ToNumber(Get(node, path, key), Join(path, key));
  }

  std::vector<double> Numbers(const Json& node, const std::string& path,
                              const std::string& key) const {
    const Json& list = Get(node, path, key);
    if (!list.is_array()) Fail(Join(path, key), list.type_name(), "a list of numbers");
    std::vector<double> numbers;
    for (size_t i = 0; i < list.size(); ++i) {
      numbers.push_back(ToNumber(list[i], fmt::format("{}[{}]", Join(path, key), i)));
    }
    return numbers;
  }

  Curve<double> ReadCurve(const Json& node, const std::string& path, const std::string& x_key,
                          const std::string& f_key) const {
    const std::vector<double> x = Numbers(node, path, x_key);
    const std::vector<double> f = Numbers(node, path, f_key);
    if (x.size() != f.size() || x.size() < 2 || x.size() > static_cast<size_t>(kMaxCurveNodes)) {
      Fail(Join(path, f_key), fmt::format("{} values at {} nodes", f.size(), x.size()),
           fmt::format("as many values as nodes in {}, 2 to {}", x_key, kMaxCurveNodes));
    }
    Curve<double> curve;
    curve.count = static_cast<int>(x.size());
    for (size_t i = 0; i < x.size(); ++i) {
      curve.x[i] = x[i];
      curve.f[i] = f[i];
    }
    return curve;
  }

  static std::string Join(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + "." + key;
  }

  void Validate(const Parameters<double>& parameters, const std::string& path) const {
    try {
      ValidateParameters(parameters);
    } catch (const io::InputError& error) {
      io::InputProblem problem = error.problem();
      problem.file = file_;
      problem.key = Join(path, problem.key);
      throw io::InputError(problem);
    }
  }

 private:
  std::string file_;
};

void SetFriction(Parameters<double>& p, double mu) {
  p.friction_coefficient = mu;
  p.friction_law = mu > 0 ? FrictionLaw::kSmoothed : FrictionLaw::kNone;
}

}  // namespace

PaperSet ReadPaperSet(const std::filesystem::path& file) {
  const Reader reader(file.string());
  std::ifstream stream(file);
  if (!stream) reader.Fail("", "no readable file", "a parameter set in JSON");
  Json root;
  try {
    root = Json::parse(stream);
  } catch (const Json::exception& error) {
    reader.Fail("", error.what(), "well-formed JSON");
  }

  PaperSet set;
  const Json& name = reader.Get(root, "", "set");
  if (!name.is_string()) reader.Fail("set", name.dump().substr(0, 60), "a name");
  set.name = name.get<std::string>();
  set.gamma_3_scale = reader.Number(root, "", "c3");

  const std::string at = "parameters";
  const Json& node = reader.Get(root, "", at);
  const auto number = [&](const char* key) { return reader.Number(node, at, key); };
  Parameters<double>& p = set.parameters;
  p.carrier_mass = number("ms");
  p.carrier_yaw_inertia = number("Is");
  p.rack_mass = number("mR");
  p.wheel_inertia = number("Isw");
  p.column_stiffness = number("ck");
  p.gear_ratio = number("iU");
  p.rod_rigidity = number("EA");
  p.half_track = number("B");
  p.lateral_stiffness = number("cL");
  p.lateral_x = number("xL");
  p.lateral_y = number("yL");
  p.lateral_angle = number("beta");
  p.longitudinal_x = number("xN");
  p.longitudinal_y = number("yN");
  p.longitudinal_angle = number("alpha");
  p.longitudinal_damping = number("bN");
  p.damping_time = number("eta");
  SetFriction(p, number("mu"));
  p.friction_speed = number("vs");
  p.force_x = number("xF");
  p.force_y = number("yF");
  p.lateral_share = number("rho");
  p.rack_half_length = number("rL");
  p.rack_position = number("rX");
  p.outer_joint_x = number("xtr");
  p.outer_joint_y = number("ytr");
  p.two_way = number("twoway") != 0;
  p.aligning_stiffness = number("kpsi");
  p.rim_radius = number("rsw");
  p.longitudinal_force = reader.ReadCurve(node, at, "sN", "fN");
  p.assist_force = reader.ReadCurve(node, at, "sA", "fA");
  reader.Validate(p, at);

  const std::vector<double> amplitude = reader.Numbers(node, at, "A");
  const std::vector<double> start = reader.Numbers(node, at, "ts");
  const std::vector<double> duration = reader.Numbers(node, at, "d");
  if (start.size() != amplitude.size() || duration.size() != amplitude.size()) {
    reader.Fail("parameters.ts",
                fmt::format("{} starts, {} durations, {} amplitudes", start.size(), duration.size(),
                            amplitude.size()),
                "as many starts and durations as amplitudes");
  }
  for (size_t i = 0; i < amplitude.size(); ++i) {
    Pulse pulse;
    pulse.kind = PulseKind::kCubedParabola;
    pulse.amplitude = amplitude[i];
    pulse.start = start[i];
    pulse.duration = duration[i];
    set.pulses.push_back(pulse);
  }
  try {
    const Excitation checked(set.pulses);
  } catch (const io::InputError& error) {
    io::InputProblem problem = error.problem();
    problem.file = file.string();
    throw io::InputError(problem);
  }

  const Json& designs = reader.Get(root, "", "designs");
  if (!designs.is_object()) reader.Fail("designs", designs.type_name(), "an object");
  for (const auto& [key, entry] : designs.items()) {
    const std::string path = "designs." + key;
    PaperDesign design;
    design.rack_half_length = reader.Number(entry, path, "rL");
    design.rack_position = reader.Number(entry, path, "rX");
    design.outer_joint_x = reader.Number(entry, path, "xtr");
    design.outer_joint_y = reader.Number(entry, path, "ytr");
    Parameters<double>& d = design.parameters;
    d = p;
    d.rack_half_length = design.rack_half_length;
    d.rack_position = design.rack_position;
    d.outer_joint_x = design.outer_joint_x;
    d.outer_joint_y = design.outer_joint_y;
    for (const auto& [option, unused] : entry.items()) {
      static_cast<void>(unused);
      if (option == "mu") {
        SetFriction(d, reader.Number(entry, path, "mu"));
      } else if (option == "twoway") {
        d.two_way = reader.Number(entry, path, "twoway") != 0;
      } else if (option == "kpsi") {
        d.aligning_stiffness = reader.Number(entry, path, "kpsi");
      } else if (option != "rL" && option != "rX" && option != "xtr" && option != "ytr") {
        reader.Fail(path + "." + option, "a key that is not known",
                    "rL, rX, xtr, ytr, mu, twoway or kpsi");
      }
    }
    reader.Validate(d, path);
    set.designs.emplace(key, design);
  }
  return set;
}

}  // namespace kingpin::planar
