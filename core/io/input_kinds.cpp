#include "core/io/input_kinds.h"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/io/nearest_name.h"

namespace kingpin::io {

std::vector<std::string> InputKinds::MakeNames() const {
  std::vector<std::string> names;
  for (const InputKind& kind : kinds_) names.push_back(kind.name);
  return names;
}

void InputKinds::Add(InputKind kind) {
  for (const InputKind& known : kinds_) {
    if (known.name == kind.name) {
      throw std::logic_error(fmt::format("two kinds of input are called '{}'", kind.name));
    }
  }
  kinds_.push_back(std::move(kind));
}

const InputKind& InputKinds::Get(std::string_view name) const {
  for (const InputKind& kind : kinds_) {
    if (kind.name == name) return kind;
  }
  throw InputError(InputProblem{.key = "kind",
                                .found = fmt::format("'{}'", name),
                                .expected = "a kind of input",
                                .suggestion = SuggestName(name, MakeNames(), "kinds")});
}

const InputKind& InputKinds::Detect(const std::filesystem::path& path) const {
  const NodePointer root = ReadYaml(path);
  InputProblem problem{.file = path.string(),
                       .line = root->line,
                       .key = "kind",
                       .expected = "a kind of input at the top of the file, such as 'kind: car'"};
  const Node* kind = root->is_mapping() ? root->Find("kind") : nullptr;
  if (!root->is_mapping()) {
    problem.key.clear();
    problem.found = DescribeNode(*root);
    problem.expected = "a mapping that begins with its kind, such as 'kind: car'";
    throw InputError(problem);
  }
  if (kind == nullptr || !kind->is_scalar()) {
    problem.found = kind == nullptr ? "nothing" : DescribeNode(*kind);
    problem.suggestion = SuggestName("", MakeNames(), "kinds");
    throw InputError(problem);
  }
  try {
    return Get(kind->text);
  } catch (const InputError& error) {
    problem.line = kind->line;
    problem.found = error.problem().found;
    problem.suggestion = error.problem().suggestion;
    throw InputError(problem);
  }
}

}  // namespace kingpin::io
