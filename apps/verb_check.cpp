#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "apps/common_options.h"
#include "apps/input_kinds.h"
#include "core/io/input_record.h"
#include "core/io/output_file.h"

namespace kingpin::apps {

void AddVerbCheck(CLI::App& app, CommonOptions& options) {
  CLI::App* verb = app.add_subcommand(
      "check", "Reads an input file and prints what was understood, with units and origin");
  const auto file = std::make_shared<std::string>();
  verb->add_option("FILE", *file, "Any input file: it says what it is by 'kind:'")->required();
  AddCommonOptions(*verb, options);
  verb->callback([file, &options] {
    io::ReadOptions read_options;
    for (const std::string& set : options.sets) {
      read_options.overrides.push_back(io::ParseOverride(set));
    }
    const io::InputKinds kinds = MakeInputKinds();
    const io::InputRecord record = kinds.Detect(*file).read(*file, read_options);
    const std::string text =
        options.json ? io::FormatRecordAsJson(record) : io::FormatRecordAsText(record);
    if (!options.output.empty()) {
      io::WriteFileAtomically(options.output, text);
    } else if (!options.quiet) {
      io::WriteStandardOutput(text);
    }
  });
}

}  // namespace kingpin::apps
