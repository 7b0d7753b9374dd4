#include "joints/urdf_xml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/io/error.h"
#include "core/io/nearest_name.h"
#include "core/io/yaml_document.h"
#include "joints/urdf.h"

namespace kingpin::joints::internal {

namespace {

using tinyxml2::XMLElement;

constexpr std::size_t kMostProblems = 50;
// Axes are printed with three digits or more.
constexpr double kAxisRounding = 1e-3;

const std::vector<std::string> kJointTypes = {"revolute", "continuous", "prismatic",
                                              "fixed",    "floating",   "planar"};

std::string Shorten(std::string_view text) {
  std::string shown(text.substr(0, 60));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return text.size() > 60 ? shown + "..." : shown;
}

std::string DescribeXmlError(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "a file without content";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element that is not closed, or closed by another name";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return fmt::format("more than {} levels of nesting", TINYXML2_MAX_ELEMENT_DEPTH);
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute that cannot be read";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "an element that cannot be read";
    case tinyxml2::XML_ERROR_PARSING:
      return "a file that ends too early";
    default:
      return fmt::format("text that cannot be read ({})", document.ErrorName());
  }
}

class Reader {
 public:
  explicit Reader(const std::string& file) : file_(file) {}

  XmlRobot Read(std::string_view text) {
    if (text.size() > io::kLargestInputFile) {
      Stop(0, "", fmt::format("{} bytes", text.size()),
           fmt::format("at most {} bytes", io::kLargestInputFile));
    }
    if (const auto zero = text.find('\0'); zero != std::string_view::npos) {
      Stop(1 + static_cast<int>(std::count(text.begin(), text.begin() + zero, '\n')), "",
           "a zero byte", "text");
    }
    RefuseDefinitions(text);
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
      Stop(document.ErrorLineNum(), "", DescribeXmlError(document), "a URDF file (XML)");
    }
    const XMLElement* top = document.RootElement();
    if (top == nullptr) Stop(0, "", "no element", "<robot>");
    if (std::string_view(top->Name()) != "robot") {
      Stop(top->GetLineNum(), "", fmt::format("<{}>", Shorten(top->Name())), "<robot>");
    }
    if (const XMLElement* second = top->NextSiblingElement()) {
      Stop(second->GetLineNum(), "", fmt::format("<{}> beside <robot>", Shorten(second->Name())),
           "one <robot> in a file");
    }
    ReadRobot(*top);
    ThrowProblems();
    CheckTree();
    CheckMimics();
    ThrowProblems();
    return std::move(robot_);
  }

 private:
  void Add(int line, std::string key, std::string found, std::string expected,
           std::string suggestion = {}) {
    problems_.push_back({.file = file_,
                         .line = line,
                         .key = std::move(key),
                         .found = std::move(found),
                         .expected = std::move(expected),
                         .suggestion = std::move(suggestion)});
    if (problems_.size() >= kMostProblems) ThrowProblems();
  }

  void ThrowProblems() {
    if (problems_.empty()) return;
    std::stable_sort(problems_.begin(), problems_.end(),
                     [](const auto& a, const auto& b) { return a.line < b.line; });
    throw io::InputError(std::move(problems_));
  }

  [[noreturn]] void Stop(int line, std::string key, std::string found, std::string expected,
                         std::string suggestion = {}) {
    throw io::InputError({.file = file_,
                          .line = line,
                          .key = std::move(key),
                          .found = std::move(found),
                          .expected = std::move(expected),
                          .suggestion = std::move(suggestion)});
  }

  // Entities that a file defines itself are not expanded by the parser, and no URDF file needs
  // them.
  void RefuseDefinitions(std::string_view text) {
    for (const std::string_view word : {"<!DOCTYPE", "<!ENTITY"}) {
      for (auto at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
        const auto opened = text.rfind("<!--", at), closed = text.rfind("-->", at);
        const bool comment = opened != std::string_view::npos &&
                             (closed == std::string_view::npos || closed < opened);
        if (comment) continue;
        Stop(1 + static_cast<int>(std::count(text.begin(), text.begin() + at, '\n')), "",
             fmt::format("'{}'", word), "a file without definitions of its own",
             "write the text where the entity is used");
      }
    }
  }

  // An element or attribute that is nearly one of ours is a slip; anything else is someone else's.
  void CheckSlips(const XMLElement& element, const std::string& key,
                  const std::vector<std::string>& attributes,
                  const std::vector<std::string>& children = {}) {
    std::set<std::string> seen;
    for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      const std::string name = a->Name();
      if (!seen.insert(name).second) {
        Add(a->GetLineNum(), key, fmt::format("attribute '{}' twice", Shorten(name)), "once");
      } else if (std::find(attributes.begin(), attributes.end(), name) == attributes.end()) {
        const std::string nearest = io::FindNearestName(name.substr(0, 60), attributes);
        if (nearest.empty()) continue;
        Add(a->GetLineNum(), key, fmt::format("an unknown attribute '{}'", Shorten(name)),
            fmt::format("an attribute of <{}>", element.Name()),
            fmt::format("did you mean '{}'?", nearest));
      }
    }
    for (const XMLElement* c = element.FirstChildElement(); c != nullptr;
         c = c->NextSiblingElement()) {
      const std::string name = c->Name();
      if (std::find(children.begin(), children.end(), name) != children.end()) continue;
      const std::string nearest = io::FindNearestName(name.substr(0, 60), children);
      if (nearest.empty()) continue;
      Add(c->GetLineNum(), key, fmt::format("an unknown element <{}>", Shorten(name)),
          fmt::format("an element of <{}>", element.Name()),
          fmt::format("did you mean '{}'?", nearest));
    }
  }

  /// The one child of that name, or null.
  const XMLElement* FindChild(const XMLElement& element, const char* name, const std::string& key) {
    const XMLElement* child = element.FirstChildElement(name);
    if (child == nullptr) return nullptr;
    if (const XMLElement* again = child->NextSiblingElement(name)) {
      Add(again->GetLineNum(), key + '.' + name,
          fmt::format("<{}> twice (first in line {})", name, child->GetLineNum()), "once");
    }
    return child;
  }

  std::string ReadName(const XMLElement& element, const char* attribute, const std::string& key) {
    const char* text = element.Attribute(attribute);
    if (text == nullptr || *text == '\0') {
      Add(element.GetLineNum(), key,
          text == nullptr ? fmt::format("no attribute '{}'", attribute) : "an empty name",
          fmt::format("<{} {}=\"...\">", element.Name(), attribute));
      return {};
    }
    return text;
  }

  /// Numbers of an attribute; nothing if it is absent or wrong, which then is a problem noted.
  Numbers ReadNumbers(const XMLElement& element, const char* attribute, const std::string& key,
                      std::size_t count, std::vector<double>* values = nullptr) {
    const tinyxml2::XMLAttribute* found = element.FindAttribute(attribute);
    if (found == nullptr) return std::nullopt;
    const std::string_view text = found->Value();
    const std::string expected =
        count == 1 ? "a finite number" : fmt::format("{} finite numbers", count);
    const auto reject = [&](std::string_view what) {
      Add(found->GetLineNum(), key + '.' + attribute, fmt::format("'{}'", Shorten(what)), expected);
      return std::nullopt;
    };
    constexpr std::string_view kBlanks = " \t\r\n";
    std::string clean;
    std::size_t numbers = 0;
    for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
      std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
      std::string_view word = text.substr(at, end - at);
      if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
      double value = 0;
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(value)) {
        return reject(word);
      }
      if (++numbers > count) return reject(text);
      clean += clean.empty() ? "" : " ";
      clean += word;
      if (values != nullptr) values->push_back(value);
      at = text.find_first_not_of(kBlanks, end);
    }
    if (numbers != count) return reject(text);
    return clean;
  }

  /// One number that must be there.
  std::string ReadNumber(const XMLElement& element, const char* attribute, const std::string& key,
                         double* value = nullptr) {
    if (element.Attribute(attribute) == nullptr) {
      Add(element.GetLineNum(), key + '.' + attribute, fmt::format("no attribute '{}'", attribute),
          "a finite number");
      return "0";
    }
    std::vector<double> values;
    const Numbers text = ReadNumbers(element, attribute, key, 1, &values);
    if (value != nullptr && !values.empty()) *value = values[0];
    return text.value_or("0");
  }

  XmlOrigin ReadOrigin(const XMLElement& element, const std::string& key) {
    const XMLElement* origin = FindChild(element, "origin", key);
    if (origin == nullptr) return {};
    CheckSlips(*origin, key + ".origin", {"xyz", "rpy"});
    return {ReadNumbers(*origin, "xyz", key + ".origin", 3),
            ReadNumbers(*origin, "rpy", key + ".origin", 3)};
  }

  void ReadRobot(const XMLElement& top) {
    robot_.line = top.GetLineNum();
    if (const char* name = top.Attribute("name")) robot_.name = name;
    if (const char* version = top.Attribute("version")) {
      if (std::string_view(version) != "1.0" && std::string_view(version) != "1") {
        Add(robot_.line, "robot.version", fmt::format("'{}'", Shorten(version)), "version 1.0");
      }
    }
    CheckSlips(top, "robot", {"name", "version"},
               {"link", "joint", "material", "transmission", "gazebo", "sensor"});
    for (const XMLElement* e = top.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view name = e->Name();
      if (name == "link") ReadLink(*e);
      if (name == "joint") ReadJoint(*e);
      if (name.substr(0, 6) == "xacro:") {
        Stop(e->GetLineNum(), "robot", fmt::format("<{}>", Shorten(name)), "a plain URDF file",
             "expand the macros first: xacro FILE.xacro > FILE.urdf");
      }
    }
    if (robot_.links.empty()) Add(robot_.line, "robot", "no link", "at least one <link>");
  }

  void ReadLink(const XMLElement& element) {
    XmlLink link;
    link.line = element.GetLineNum();
    link.name = ReadName(element, "name", "link");
    const std::string key = fmt::format("link[{}]", Shorten(link.name));
    if (!link.name.empty()) {
      const auto [first, is_new] = link_of_.emplace(link.name, robot_.links.size());
      if (!is_new) {
        Add(link.line, key,
            fmt::format("a second link of this name (first in line {})",
                        robot_.links[first->second].line),
            "one of each name");
      }
    }
    if (robot_.links.size() >= static_cast<std::size_t>(kMostUrdfLinks)) {
      Stop(link.line, key, "one link more", fmt::format("at most {} links", kMostUrdfLinks));
    }
    CheckSlips(element, key, {"name", "type"}, {"inertial", "visual", "collision"});
    if (const XMLElement* inertial = FindChild(element, "inertial", key)) {
      ReadInertial(*inertial, key + ".inertial", link);
    }
    robot_.links.push_back(std::move(link));
  }

  void ReadInertial(const XMLElement& element, const std::string& key, XmlLink& link) {
    link.inertial_line = element.GetLineNum();
    CheckSlips(element, key, {}, {"origin", "mass", "inertia"});
    link.origin = ReadOrigin(element, key);
    const XMLElement* mass = FindChild(element, "mass", key);
    if (mass == nullptr) {
      Add(link.inertial_line, key, "no <mass>", "<mass value=\"...\"/> [kg]");
    } else {
      CheckSlips(*mass, key + ".mass", {"value"});
      double value = 0;
      link.mass = ReadNumber(*mass, "value", key + ".mass", &value);
      if (value < 0) {
        Add(mass->GetLineNum(), key + ".mass.value", fmt::format("{:g} kg", value),
            "a mass that is not negative");
      }
    }
    const XMLElement* inertia = FindChild(element, "inertia", key);
    if (inertia == nullptr) {
      Add(link.inertial_line, key, "no <inertia>",
          "<inertia ixx=... ixy=... ixz=... iyy=... iyz=... izz=.../> [kg m^2]");
      return;
    }
    const std::vector<std::string> names = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
    for (std::size_t i = 0; i < names.size(); ++i) {
      link.inertia[i] = ReadNumber(*inertia, names[i].c_str(), key + ".inertia");
    }
  }

  void ReadJoint(const XMLElement& element) {
    XmlJoint joint;
    joint.line = element.GetLineNum();
    joint.name = ReadName(element, "name", "joint");
    const std::string key = fmt::format("joint[{}]", Shorten(joint.name));
    if (!joint.name.empty()) {
      const auto [first, is_new] = joint_of_.emplace(joint.name, robot_.joints.size());
      if (!is_new) {
        Add(joint.line, key,
            fmt::format("a second joint of this name (first in line {})",
                        robot_.joints[first->second].line),
            "one of each name");
      }
    }
    joint.type = ReadName(element, "type", key + ".type");
    if (!joint.type.empty() &&
        std::find(kJointTypes.begin(), kJointTypes.end(), joint.type) == kJointTypes.end()) {
      Add(joint.line, key + ".type", fmt::format("'{}'", Shorten(joint.type)),
          "a type of joint that URDF has",
          io::SuggestName(joint.type.substr(0, 60), kJointTypes, "types"));
    }
    CheckSlips(element, key, {"name", "type"},
               {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "calibration",
                "safety_controller"});
    const auto read_end = [&](const char* end, std::string* name, int* line) {
      const XMLElement* e = FindChild(element, end, key);
      if (e == nullptr) {
        Add(joint.line, key, fmt::format("no <{}>", end), fmt::format("<{} link=\"...\"/>", end));
        return;
      }
      *line = e->GetLineNum();
      *name = ReadName(*e, "link", key + '.' + end);
    };
    read_end("parent", &joint.parent, &joint.parent_line);
    read_end("child", &joint.child, &joint.child_line);
    joint.origin = ReadOrigin(element, key);
    ReadAxis(element, key, joint);
    ReadLimit(element, key, joint);
    if (const XMLElement* dynamics = FindChild(element, "dynamics", key)) {
      CheckSlips(*dynamics, key + ".dynamics", {"damping", "friction"});
      joint.dynamics = {ReadNumbers(*dynamics, "damping", key + ".dynamics", 1),
                        ReadNumbers(*dynamics, "friction", key + ".dynamics", 1)};
    }
    if (const XMLElement* mimic = FindChild(element, "mimic", key)) {
      CheckSlips(*mimic, key + ".mimic", {"joint", "multiplier", "offset"});
      joint.mimic = {ReadName(*mimic, "joint", key + ".mimic"), mimic->GetLineNum(),
                     ReadNumbers(*mimic, "multiplier", key + ".mimic", 1),
                     ReadNumbers(*mimic, "offset", key + ".mimic", 1)};
    }
    robot_.joints.push_back(std::move(joint));
  }

  void ReadAxis(const XMLElement& element, const std::string& key, XmlJoint& joint) {
    const XMLElement* axis = FindChild(element, "axis", key);
    if (axis == nullptr || joint.type == "fixed" || joint.type == "floating") return;
    CheckSlips(*axis, key + ".axis", {"xyz"});
    if (axis->Attribute("xyz") == nullptr) {
      Add(axis->GetLineNum(), key + ".axis", "no attribute 'xyz'", "three numbers");
      return;
    }
    std::vector<double> a;
    joint.axis = ReadNumbers(*axis, "xyz", key + ".axis", 3, &a);
    if (!joint.axis) return;
    const double norm = std::hypot(a[0], a[1], a[2]);
    if (!(std::abs(norm - 1) < kAxisRounding)) {
      Add(axis->GetLineNum(), key + ".axis.xyz",
          fmt::format("({:g}, {:g}, {:g}) of length {:g}", a[0], a[1], a[2], norm),
          "a direction of length 1");
    }
  }

  void ReadLimit(const XMLElement& element, const std::string& key, XmlJoint& joint) {
    const XMLElement* limit = FindChild(element, "limit", key);
    if (limit == nullptr) {
      if (joint.type == "revolute" || joint.type == "prismatic") {
        Add(joint.line, key, "no <limit>",
            fmt::format("<limit lower=... upper=... effort=... velocity=.../> for a {} joint",
                        joint.type),
            joint.type == "revolute" ? "a joint without limits is of type 'continuous'" : "");
      }
      return;
    }
    CheckSlips(*limit, key + ".limit", {"lower", "upper", "effort", "velocity"});
    std::vector<double> lower, upper;
    joint.limit.emplace();
    joint.limit->lower = ReadNumbers(*limit, "lower", key + ".limit", 1, &lower);
    joint.limit->upper = ReadNumbers(*limit, "upper", key + ".limit", 1, &upper);
    joint.limit->effort = ReadNumber(*limit, "effort", key + ".limit");
    joint.limit->velocity = ReadNumber(*limit, "velocity", key + ".limit");
    if (!lower.empty() && !upper.empty() && lower[0] > upper[0]) {
      Add(limit->GetLineNum(), key + ".limit",
          fmt::format("lower {:g} above upper {:g}", lower[0], upper[0]), "lower <= upper");
    }
  }

  std::optional<std::size_t> FindLink(const XmlJoint& joint, const std::string& name, int line,
                                      const char* end) {
    const auto found = link_of_.find(name);
    if (found != link_of_.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [link, unused] : link_of_) known.push_back(link);
    if (known.size() > 20) known.clear();
    Add(line, fmt::format("joint[{}].{}", Shorten(joint.name), end),
        fmt::format("'{}'", Shorten(name)), "the name of a link",
        known.empty() ? "" : io::SuggestName(name.substr(0, 60), known, "links"));
    return std::nullopt;
  }

  // Every link but one is the child of one joint, and all are reached from that one.
  void CheckTree() {
    const std::size_t count = robot_.links.size();
    std::vector<const XmlJoint*> carrier(count, nullptr);
    std::vector<std::vector<std::size_t>> children(count);
    for (const XmlJoint& joint : robot_.joints) {
      const auto parent = FindLink(joint, joint.parent, joint.parent_line, "parent");
      const auto child = FindLink(joint, joint.child, joint.child_line, "child");
      if (!parent || !child) continue;
      if (carrier[*child] != nullptr) {
        Add(joint.child_line, fmt::format("joint[{}].child", Shorten(joint.name)),
            fmt::format("'{}', which joint '{}' carries already", Shorten(joint.child),
                        Shorten(carrier[*child]->name)),
            "one parent for each link", "URDF is a tree; close loops in a YAML mechanism file");
        continue;
      }
      carrier[*child] = &joint;
      children[*parent].push_back(*child);
    }
    ThrowProblems();
    std::vector<std::size_t> reached;
    for (std::size_t l = 0; l < count; ++l) {
      if (carrier[l] != nullptr) continue;
      if (reached.empty()) {
        reached.push_back(l);
      } else {
        Add(robot_.links[l].line, fmt::format("link[{}]", Shorten(robot_.links[l].name)),
            fmt::format("a second root beside '{}'", Shorten(robot_.links[reached[0]].name)),
            "one link that no joint carries", "connect it by a joint");
      }
    }
    ThrowProblems();
    if (!reached.empty()) robot_.root = static_cast<int>(reached[0]);
    std::vector<char> is_reached(count, 0);
    for (std::size_t k = 0; k < reached.size(); ++k) {
      is_reached[reached[k]] = 1;
      reached.insert(reached.end(), children[reached[k]].begin(), children[reached[k]].end());
    }
    for (std::size_t l = 0; l < count; ++l) {
      if (is_reached[l]) continue;
      std::size_t on_cycle = l;  // following the parents from any such link leads into the cycle
      for (std::size_t k = 0; k < count; ++k) on_cycle = link_of_.at(carrier[on_cycle]->parent);
      std::string chain = Shorten(robot_.links[on_cycle].name);
      std::size_t at = on_cycle;
      for (int shown = 0; shown < 6; ++shown) {
        at = link_of_.at(carrier[at]->parent);
        chain = Shorten(robot_.links[at].name) + " -> " + chain;
        if (at == on_cycle) break;
      }
      Stop(carrier[on_cycle]->line, fmt::format("joint[{}]", Shorten(carrier[on_cycle]->name)),
           fmt::format("a cycle of joints ({})", chain), "a tree",
           "URDF is a tree; close loops in a YAML mechanism file");
    }
  }

  void CheckMimics() {
    for (const XmlJoint& joint : robot_.joints) {
      if (!joint.mimic) continue;
      const std::string key = fmt::format("joint[{}].mimic", Shorten(joint.name));
      const auto found = joint_of_.find(joint.mimic->joint);
      if (found == joint_of_.end()) {
        std::vector<std::string> known;
        for (const auto& [name, unused] : joint_of_) known.push_back(name);
        if (known.size() > 20) known.clear();
        Add(joint.mimic->line, key, fmt::format("'{}'", Shorten(joint.mimic->joint)),
            "the name of a joint",
            known.empty() ? ""
                          : io::SuggestName(joint.mimic->joint.substr(0, 60), known, "joints"));
        continue;
      }
      const auto has_one = [](const XmlJoint& j) {
        return j.type == "revolute" || j.type == "continuous" || j.type == "prismatic";
      };
      if (!has_one(joint) || !has_one(robot_.joints[found->second])) {
        Add(joint.mimic->line, key,
            fmt::format("a {} joint that mimics a {} one", joint.type,
                        robot_.joints[found->second].type),
            "joints with one coordinate each");
        continue;
      }
      const XmlJoint* at = &joint;
      for (std::size_t k = 0; at->mimic && k <= robot_.joints.size(); ++k) {
        const auto next = joint_of_.find(at->mimic->joint);
        if (next == joint_of_.end()) break;
        at = &robot_.joints[next->second];
        if (at != &joint) continue;
        Add(joint.mimic->line, key, "a joint that in the end mimics itself",
            "another joint that moves by itself");
        break;
      }
    }
  }

  const std::string& file_;
  XmlRobot robot_;
  std::map<std::string, std::size_t> link_of_, joint_of_;
  std::vector<io::InputProblem> problems_;
};

}  // namespace

XmlRobot ReadUrdfXml(std::string_view text, const std::string& file) {
  return Reader(file).Read(text);
}

}  // namespace kingpin::joints::internal
