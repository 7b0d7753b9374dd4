#include "core/io/value_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/io/nearest_name.h"
#include "core/io/units.h"

namespace kingpin::io {
namespace {

constexpr std::size_t kMostProblems = 50;

}  // namespace

void ValueReader::Note(InputProblem problem) {
  if (problems_.size() < kMostProblems) problems_.push_back(std::move(problem));
}

void ValueReader::Note(const Place& place, const std::string& path, std::string found,
                       std::string expected, std::string suggestion) {
  Note(InputProblem{.file = place.file,
                    .line = place.line,
                    .key = path,
                    .found = std::move(found),
                    .expected = std::move(expected),
                    .suggestion = std::move(suggestion)});
}

void ValueReader::Note(const Node& node, const std::string& path, std::string found,
                       std::string expected, std::string suggestion) {
  Note(Place{node.file_name(), node.line}, path, std::move(found), std::move(expected),
       std::move(suggestion));
}

void ValueReader::Fail(const Node& node, const std::string& path, std::string found,
                       std::string expected, std::string suggestion) {
  Note(node, path, std::move(found), std::move(expected), std::move(suggestion));
  throw FieldIsWrong{};
}

void ValueReader::Fail(const Node& node, const std::string& path, const InputError& error) {
  for (InputProblem problem : error.problems()) {
    if (problem.file.empty()) {
      problem.file = node.file_name();
      problem.line = node.line;
    }
    if (problem.key.empty()) problem.key = path;
    Note(std::move(problem));
  }
  throw FieldIsWrong{};
}

Unit ValueReader::ReadUnit(const Node& node, const std::string& path, const Unit& expected) {
  if (!node.is_scalar()) Fail(node, path, DescribeNode(node), "a unit");
  Unit unit;
  try {
    unit = ParseUnit(node.text);
  } catch (const InputError& error) {
    Fail(node, path, error);
  }
  if (!IsUsableAs(unit.dimension, expected.dimension)) {
    Fail(node, path, DescribeNode(node), "a unit for " + DescribeQuantity(expected));
  }
  // A bare number in a unit without radians still means the dimension that is expected.
  unit.dimension = expected.dimension;
  return unit;
}

double ValueReader::ReadQuantity(const Node& node, const Unit& unit, const std::string& path,
                                 const std::string& expected) {
  if (!node.is_scalar()) Fail(node, path, DescribeNode(node), expected);
  try {
    return ParseQuantity(node.text, unit);
  } catch (const InputError& error) {
    Fail(node, path, error);
  }
}

double ValueReader::ReadInteger(const FieldSpec& field, const Node& node, const std::string& path) {
  if (!node.is_scalar()) Fail(node, path, DescribeNode(node), Describe(field));
  double number = 0.0;
  try {
    number = ParseNumber(node.text);
  } catch (const InputError&) {
    Fail(node, path, DescribeNode(node), Describe(field));
  }
  if (number != std::floor(number)) Fail(node, path, DescribeNode(node), Describe(field));
  return number;
}

bool ValueReader::ReadBoolean(const FieldSpec& field, const Node& node, const std::string& path) {
  if (node.is_scalar()) {
    for (const char* yes : {"true", "yes", "on", "True", "Yes", "On"}) {
      if (node.text == yes) return true;
    }
    for (const char* no : {"false", "no", "off", "False", "No", "Off"}) {
      if (node.text == no) return false;
    }
  }
  Fail(node, path, DescribeNode(node), Describe(field));
}

std::string ValueReader::ReadText(const FieldSpec& field, const Node& node,
                                  const std::string& path) {
  if (!node.is_scalar() || node.text.empty()) {
    Fail(node, path, DescribeNode(node),
         field.kind == FieldKind::kTexts && field.options.empty() ? "a text" : Describe(field));
  }
  const std::vector<std::string> names = NamesOf(field.options);
  if (!names.empty() && std::find(names.begin(), names.end(), node.text) == names.end()) {
    const std::string nearest = FindNearestName(node.text, names);
    Fail(node, path, DescribeNode(node), "one of " + Join(names),
         nearest.empty() ? "" : fmt::format("did you mean '{}'?", nearest));
  }
  return node.text;
}

void ValueReader::CheckCount(const FieldSpec& field, const Node& node, std::size_t count,
                             const std::string& path, const Noun& what) {
  if (count >= field.min_count && count <= field.max_count) return;
  std::string expected;
  if (field.min_count == field.max_count) {
    expected = Count(field.min_count, what);
  } else if (count < field.min_count) {
    expected = "at least " + Count(field.min_count, what);
  } else {
    expected = "at most " + Count(field.max_count, what);
  }
  Fail(node, path, Count(count, what), expected);
}

void ValueReader::CheckRange(const FieldSpec& field, const Node& node, double value,
                             const Unit& unit, const std::string& path) {
  const bool low = field.min && (field.min_is_open ? !(value > *field.min) : value < *field.min);
  const bool high = field.max && (field.max_is_open ? !(value < *field.max) : value > *field.max);
  if (!low && !high) return;
  std::string found = DescribeNode(node);
  const std::string si = FormatQuantity(value, unit.text);
  if (found != fmt::format("'{}'", si) && found != fmt::format("'{}'", FormatNumber(value))) {
    found += fmt::format(" ({})", si);
  }
  Fail(node, path, found, DescribeRange(field));
}

std::filesystem::path ValueReader::Resolve(const Node& node) {
  std::filesystem::path file(node.text);
  if (file.is_absolute() || node.file_name() == "command line") return file;
  return (std::filesystem::path(node.file_name()).parent_path() / file).lexically_normal();
}

}  // namespace kingpin::io
