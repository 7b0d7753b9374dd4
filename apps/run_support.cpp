#include "apps/run_support.h"

#include <cstdlib>
#include <ctime>

#include <fmt/chrono.h>

#include "core/io/error.h"
#include "core/math/isa.h"

namespace kingpin::apps {

io::ReadOptions MakeReadOptions(const CommonOptions& options) {
  io::ReadOptions read;
  for (const std::string& set : options.sets) read.overrides.push_back(io::ParseOverride(set));
  return read;
}

std::filesystem::path ResultPath(const std::string& verb, const CommonOptions& options,
                                 const std::filesystem::path& input) {
  if (!options.output.empty()) return options.output;
  const std::filesystem::path file = std::filesystem::weakly_canonical(input);
  // `study.yaml` says nothing; the folder it stands in does.
  const bool is_folder = std::filesystem::is_directory(file);
  const std::string stem = file.stem().string();
  const bool generic = stem == "study" || stem == "scenario";
  const std::string name = is_folder ? file.filename().string()
                           : generic ? file.parent_path().filename().string()
                                     : stem;
  return std::filesystem::path("results") / (verb == "study" ? name : name + "_" + verb);
}

void CheckOutputFile(const CommonOptions& options,
                     const std::vector<std::filesystem::path>& inputs) {
  const std::filesystem::path output = options.output;
  std::error_code error;
  // a terminal or a pipe may be read and written at once
  if (!std::filesystem::is_regular_file(output, error)) return;
  for (const std::filesystem::path& input : inputs) {
    if (!std::filesystem::equivalent(output, input, error)) continue;
    throw io::InputError(
        {.file = "command line",
         .key = "-o",
         .found = fmt::format("'{}', which is the input '{}'", output.string(), input.string()),
         .expected = "a file that is no input, which would be lost"});
  }
}

std::filesystem::path SourceRoot() {
  const char* root = std::getenv("KINGPIN_ROOT");
  return root != nullptr ? std::filesystem::path(root) : std::filesystem::path(KINGPIN_SOURCE_DIR);
}

io::RunManifest MakeManifest(const CommonOptions& options, const io::InputRecord& record) {
  io::RunManifest manifest;
  manifest.command_line = options.command_line;
  manifest.inputs = record.files;
  manifest.overrides = MakeReadOptions(options).overrides;
  manifest.instruction_set = isa::ToString(isa::DetectLevel());
  return manifest;
}

std::string FormatNow() {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
}

}  // namespace kingpin::apps
