#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/common_options.h"
#include "core/io/input_record.h"
#include "core/io/results.h"
#include "core/io/schema_core.h"

/// What the verbs that run something have in common.
namespace kingpin::apps {

/// --set, parsed. Throws io::InputError.
io::ReadOptions MakeReadOptions(const CommonOptions& options);

/// -o, or results/<name>_<verb>, where the name is that of the file or its folder; a study, the
/// main job, goes to results/<name>.
std::filesystem::path ResultPath(const std::string& verb, const CommonOptions& options,
                                 const std::filesystem::path& input);

/// -o as the file that a verb writes must be none of those it has read: it would replace what a
/// user wrote by what was made of it. Links are followed, hard ones recognised.
/// Throws io::InputError.
void CheckOutputFile(const CommonOptions& options,
                     const std::vector<std::filesystem::path>& inputs);

/// The folder with examples/ and models/: the environment variable KINGPIN_ROOT, or where the
/// program was built.
std::filesystem::path SourceRoot();

io::RunManifest MakeManifest(const CommonOptions& options, const io::InputRecord& record);

/// `2026-11-22 09:15 UTC`
std::string FormatNow();

}  // namespace kingpin::apps
