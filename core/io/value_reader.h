#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/io/error.h"
#include "core/io/field_text.h"
#include "core/io/schema_core.h"

namespace kingpin::io {

/// Thrown inside the readers of a schema to leave one field; what was wrong is noted already.
struct FieldIsWrong {};

/// Reads single values and collects what is wrong with them, so that all mistakes of a file are
/// reported at once. Fail() notes one and throws FieldIsWrong.
class ValueReader {
 public:
  /// Where a value stands.
  struct Place {
    std::string file;
    int line = 0;
  };

  void Note(InputProblem problem);
  void Note(const Place& place, const std::string& path, std::string found, std::string expected,
            std::string suggestion = {});
  void Note(const Node& node, const std::string& path, std::string found, std::string expected,
            std::string suggestion = {});
  [[noreturn]] void Fail(const Node& node, const std::string& path, std::string found,
                         std::string expected, std::string suggestion = {});
  // An error from elsewhere gets the place and the path it lacks.
  [[noreturn]] void Fail(const Node& node, const std::string& path, const InputError& error);

  Unit ReadUnit(const Node& node, const std::string& path, const Unit& expected);
  double ReadQuantity(const Node& node, const Unit& unit, const std::string& path,
                      const std::string& expected);
  double ReadInteger(const FieldSpec& field, const Node& node, const std::string& path);
  bool ReadBoolean(const FieldSpec& field, const Node& node, const std::string& path);
  std::string ReadText(const FieldSpec& field, const Node& node, const std::string& path);
  void CheckCount(const FieldSpec& field, const Node& node, std::size_t count,
                  const std::string& path, const Noun& what);
  void CheckRange(const FieldSpec& field, const Node& node, double value, const Unit& unit,
                  const std::string& path);
  static std::filesystem::path Resolve(const Node& node);

 protected:
  std::vector<InputProblem> problems_;
};

}  // namespace kingpin::io
