#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/common_options.h"
#include "apps/input_kinds.h"
#include "core/io/output_file.h"

namespace kingpin::apps {

void AddVerbSchema(CLI::App& app, CommonOptions& options) {
  CLI::App* verb = app.add_subcommand(
      "schema", "Prints what a kind of input file may hold: JSON Schema for editors, or a table");
  const auto kind = std::make_shared<std::string>();
  const auto is_table = std::make_shared<bool>(false);
  verb->add_option("KIND", *kind, "Which kind; without it, the kinds there are");
  verb->add_flag("--markdown", *is_table, "A table for people instead of JSON Schema");
  AddOutputOption(*verb, options, "File instead of standard output");
  verb->callback([kind, is_table, &options] {
    const io::InputKinds kinds = MakeInputKinds();
    std::string text;
    if (kind->empty()) {
      for (const io::InputKind& known : kinds.kinds()) {
        text += fmt::format("{}: {}\n", known.name, known.schema->description());
      }
    } else {
      const io::SchemaCore& schema = *kinds.Get(*kind).schema;
      text = *is_table ? io::FormatSchemaAsMarkdown(schema) : io::FormatJsonSchema(schema);
    }
    if (!options.output.empty()) {
      io::WriteFileAtomically(options.output, text);
    } else {
      io::WriteStandardOutput(text);
    }
  });
}

}  // namespace kingpin::apps
