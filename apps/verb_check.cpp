#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/common_options.h"
#include "apps/input_kinds.h"
#include "apps/run_support.h"
#include "core/io/error.h"
#include "core/io/input_record.h"
#include "core/io/json_text.h"
#include "core/io/output_file.h"

namespace kingpin::apps {
namespace {

/// The file itself, or those in a folder that the other verbs look for.
std::vector<std::filesystem::path> FindFiles(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return {path};
  std::vector<std::filesystem::path> files;
  for (const char* name : {"study.yaml", "scenario.yaml", "car.yaml"}) {
    if (std::filesystem::exists(path / name, error)) files.push_back(path / name);
  }
  if (files.empty()) {
    throw io::InputError({path.string(), 0, "", "a folder without any of them",
                          "study.yaml, scenario.yaml or car.yaml", "name the file itself"});
  }
  return files;
}

// What cannot come to rest is found by trying; that message names no file.
io::InputRecord Read(const io::InputKinds& kinds, const std::filesystem::path& file,
                     const io::ReadOptions& options) {
  try {
    return kinds.Detect(file).read(file, options);
  } catch (const io::InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw io::RunError(file.string() + ": " + error.what());
  }
}

void RunCheckVerb(const std::string& path, const CommonOptions& options) {
  const io::ReadOptions read_options = MakeReadOptions(options);
  const io::InputKinds kinds = MakeInputKinds();
  const std::vector<std::filesystem::path> files = FindFiles(path);
  std::string text;
  auto list = nlohmann::ordered_json::array();
  for (const std::filesystem::path& file : files) {
    const io::InputRecord record = Read(kinds, file, read_options);
    CheckOutputFile(options, record.files);
    if (options.json) {
      list.push_back(nlohmann::ordered_json::parse(io::FormatRecordAsJson(record)));
    } else {
      if (files.size() > 1) text += (text.empty() ? "" : "\n") + file.string() + "\n\n";
      text += io::FormatRecordAsText(record);
    }
  }
  if (options.json) text = io::FormatJson(files.size() > 1 ? list : list.front());
  if (!options.output.empty()) {
    io::WriteFileAtomically(options.output, text);
  } else if (!options.quiet) {
    io::WriteStandardOutput(text);
  }
}

}  // namespace

void AddVerbCheck(CLI::App& app, CommonOptions& options) {
  CLI::App* verb = app.add_subcommand(
      "check", "Reads an input file and prints what was understood, with units and origin");
  const auto file = std::make_shared<std::string>();
  verb->add_option("FILE", *file,
                   "Any input file: it says what it is by 'kind:'; or a folder with study.yaml, "
                   "scenario.yaml or car.yaml")
      ->required();
  AddOutputOption(*verb, options, "File instead of standard output");
  AddSetOption(*verb, options);
  AddPrintOptions(*verb, options);
  verb->callback([file, &options] { RunCheckVerb(*file, options); });
}

}  // namespace kingpin::apps
