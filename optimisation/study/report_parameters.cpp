#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/io/sha256.h"
#include "optimisation/study/report_parts.h"

namespace kingpin::study {
namespace {

/// Where a value is listed: under a title, by the rest of its path.
struct Place {
  std::string title;
  std::string name;
};

/// `cases[2].model.car.steering.rack.mass` is `rack.mass` of that case's car, section steering.
Place FindPlace(const StudyResult& study, const std::string& path) {
  constexpr std::string_view kCases = "cases[", kCar = "model.car.";
  if (!path.starts_with(kCases)) return {"Study", path};
  const std::size_t close = path.find(']');
  if (close == std::string::npos || close + 2 > path.size()) return {"Study", path};
  const std::size_t number = std::stoul(path.substr(kCases.size(), close - kCases.size()));
  const std::string& name = number < study.definition.cases.size()
                                ? study.definition.cases[number].name
                                : path.substr(0, close + 1);
  const std::string rest = path.substr(close + 2);
  if (!rest.starts_with(kCar)) return {"Study, " + name, rest};
  const std::string inside = rest.substr(kCar.size());
  const std::size_t section = inside.find_first_of(".[");
  const std::string title = "Car of " + name;
  if (section == std::string::npos) return {title, inside};
  // A list element (`loads[0]`) keeps the name of its list.
  const std::string name_inside = inside[section] == '.' ? inside.substr(section + 1) : inside;
  return {title + ": " + inside.substr(0, section), name_inside};
}

report::Parameter MakeParameter(const io::ValueRecord& value, const std::string& name) {
  // The report lists the files with their folders once.
  io::ValueOrigin shown = value.origin;
  shown.file = std::filesystem::path(shown.file).filename().string();
  std::string origin = io::FormatOrigin(shown);
  if (!value.origin.certainty.empty()) origin += " [" + value.origin.certainty + "]";
  if (!value.origin.source.empty()) origin += " " + value.origin.source;
  const bool as_number = value.numbers.size() == 1;
  return {name, as_number ? fmt::format("{:.6g}", value.numbers[0]) : value.value, value.unit,
          origin, value.origin.kind == io::ValueOrigin::Kind::kCommandLine};
}

}  // namespace

std::vector<report::ParameterGroup> MakeParameterGroups(const StudyResult& study,
                                                        const io::InputRecord& inputs) {
  std::vector<report::ParameterGroup> groups;
  for (const CaseResult& result : study.cases) {
    if (result.derived.empty()) continue;
    report::ParameterGroup group;
    group.title = "Derived for the planar model: " + result.name;
    group.source = "docs/theory/car-reduction.md";
    for (const auto& quantity : result.derived) {
      group.parameters.push_back({quantity.name, fmt::format("{:.6g}", quantity.value),
                                  quantity.unit, quantity.formula + "; " + quantity.source, false});
    }
    groups.push_back(std::move(group));
  }
  // Cases share files and repeat each other's sections: a value that an earlier case took from the
  // same place is not listed again.
  std::set<std::string> listed;
  std::map<std::string, std::size_t> group_of;
  for (const io::ValueRecord& value : inputs.values) {
    const Place place = FindPlace(study, value.path);
    const std::string kind = place.title.substr(0, place.title.find_first_of(" ,"));
    const std::string path = value.path.substr(value.path.find('.') + 1);  // within its case
    const report::Parameter parameter = MakeParameter(value, place.name);
    if (!listed
             .insert(fmt::format("{}|{}|{}|{}", kind, path, parameter.value,
                                 io::FormatOrigin(value.origin)))
             .second) {
      continue;
    }
    const auto [found, is_new] = group_of.try_emplace(place.title, groups.size());
    if (is_new) groups.push_back({place.title, "", {}});
    groups[found->second].parameters.push_back(parameter);
  }
  return groups;
}

std::vector<report::NamedText> MakeOptions(const StudyResult& study,
                                           const io::InputRecord& inputs) {
  std::vector<report::NamedText> options;
  constexpr std::string_view kOptions = "model.options.";
  for (const io::ValueRecord& value : inputs.values) {
    const Place place = FindPlace(study, value.path);
    if (!place.name.starts_with(kOptions)) continue;
    const report::Parameter parameter = MakeParameter(value, place.name.substr(kOptions.size()));
    const std::string text = fmt::format("{} {}{}", parameter.name, parameter.value,
                                         parameter.unit.empty() ? "" : " " + parameter.unit);
    const std::string name = place.title.substr(std::string_view("Study, ").size());
    if (!options.empty() && options.back().name == name) {
      options.back().text += ", " + text;
    } else {
      options.push_back({name, text});
    }
  }
  return options;
}

std::vector<report::InputFile> MakeInputFiles(const io::InputRecord& inputs) {
  std::vector<report::InputFile> files;
  for (const auto& file : inputs.files) {
    report::InputFile& shown = files.emplace_back();
    shown.path = file.string();
    try {
      shown.hash = "sha256:" + io::CalcFileSha256(file);
      shown.bytes = static_cast<long>(std::filesystem::file_size(file));
    } catch (const io::InputError&) {
      continue;
    }
  }
  return files;
}

}  // namespace kingpin::study
