#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/schema.h"

namespace kingpin::io {

/// One kind of input file, as `kingpin check` and `kingpin schema` see it.
struct InputKind {
  std::string name;  ///< what stands after `kind:`
  std::shared_ptr<const SchemaCore> schema;
  /// Reads a file of this kind with all checks. Throws InputError.
  std::function<InputRecord(const std::filesystem::path&, const ReadOptions&)> read;
};

/// The kinds of input files, told apart by their top-level `kind:`. Filled by explicit calls, one
/// for each folder that has some (`void AddInputKinds(io::InputKinds*)`), so that nothing depends
/// on the order of static initialisers.
class InputKinds {
 public:
  /// `check` looks at the whole object once it was read, beyond what the schema checks (building
  /// the model from it, say), and throws InputError. `derive` gives what follows from it, for the
  /// record. Throws std::logic_error for a name that is taken.
  template <class T>
  void Add(const Schema<T>& schema, std::function<void(const T&)> check = {},
           std::function<DerivedValues(const T&)> derive = {}) {
    Add(InputKind{schema.name(), schema.core(),
                  [schema, check = std::move(check), derive = std::move(derive)](
                      const std::filesystem::path& path, const ReadOptions& options) {
                    InputRecord record;
                    const T object = ReadFile(schema, path, options, &record);
                    if (check) check(object);
                    if (derive) record.derived = derive(object);
                    return record;
                  }});
  }

  /// A kind that is read in a way of its own.
  void Add(InputKind kind);

  const std::vector<InputKind>& kinds() const { return kinds_; }

  /// The kind of a name. Throws InputError with the nearest one suggested.
  const InputKind& Get(std::string_view name) const;

  /// The kind that a file says it is. Throws InputError.
  const InputKind& Detect(const std::filesystem::path& path) const;

 private:
  std::vector<std::string> MakeNames() const;

  std::vector<InputKind> kinds_;
};

}  // namespace kingpin::io
