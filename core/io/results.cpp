#include "core/io/results.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <limits>
#include <optional>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <signal.h>
#include <unistd.h>

#include "core/io/error.h"
#include "core/io/json_text.h"
#include "core/io/output_failure.h"
#include "core/io/sha256.h"
#include "core/io/version.h"
#include "core/io/yaml_document.h"

namespace kingpin::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "manifest.json";

fs::path ParentOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::string PartialPrefix(const fs::path& target) {
  return fmt::format(".{}.partial-", target.filename().string());
}

// Everything below the folder that is not itself a folder, as relative names in order.
std::vector<std::string> ListFiles(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->is_directory() && !entry->is_symlink()) continue;
    names.push_back(entry->path().lexically_relative(folder).string());
  }
  if (error) FailOutput(folder, "reading the folder", error.value());
  std::sort(names.begin(), names.end());
  return names;
}

// What the manifest of an earlier result says about it.
struct EarlierResult {
  std::string verb;
  std::set<std::string> outputs;
};

// Nothing when the folder has no manifest of ours.
std::optional<EarlierResult> ReadEarlierResult(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_regular_file(folder / kManifest, error)) return std::nullopt;
  const auto json = nlohmann::json::parse(
      ReadTextFile(folder / kManifest, std::numeric_limits<std::size_t>::max()), nullptr, false);
  if (!json.is_object() || json.value("program", nlohmann::json()) != "kingpin") {
    return std::nullopt;
  }
  EarlierResult result;
  result.outputs.insert(kManifest);
  if (const auto verb = json.find("verb"); verb != json.end() && verb->is_string()) {
    result.verb = verb->get<std::string>();
  }
  if (const auto outputs = json.find("outputs"); outputs != json.end() && outputs->is_array()) {
    for (const auto& name : *outputs) {
      if (name.is_string()) result.outputs.insert(name.get<std::string>());
    }
  }
  return result;
}

// Only an empty folder, or one in which everything was written by an earlier run of the same verb,
// may be replaced.
void CheckTarget(const fs::path& target, const std::string& verb) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(target, error);
  if (!fs::exists(status)) return;
  const auto fail = [&](std::string found, const char* suggestion) {
    throw InputError(InputProblem{
        .file = target.string(),
        .found = std::move(found),
        .expected = fmt::format("a new or an empty folder, or an earlier result of '{}'", verb),
        .suggestion = suggestion});
  };
  constexpr const char* kElsewhere = "choose another place with -o";
  if (fs::is_symlink(status)) fail("a symbolic link", kElsewhere);
  if (!fs::is_directory(status)) fail("a file", kElsewhere);
  const std::vector<std::string> names = ListFiles(target);
  if (names.empty()) return;
  const std::optional<EarlierResult> earlier = ReadEarlierResult(target);
  if (!earlier) fail("a folder with files that are not a result", kElsewhere);
  if (earlier->verb != verb) fail(fmt::format("a result of '{}'", earlier->verb), kElsewhere);
  for (const std::string& name : names) {
    if (earlier->outputs.count(name) == 0) {
      fail(fmt::format("'{}', which the earlier run did not write", name),
           "move it away, or choose another place with -o");
    }
  }
}

// Leftovers of killed runs on this machine.
void RemoveLeftovers(const fs::path& target) {
  const std::string prefix = PartialPrefix(target);
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (auto entry = fs::directory_iterator(ParentOf(target), error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(prefix)) continue;
    long pid = 0;
    char rest = 0;
    if (std::sscanf(name.c_str() + prefix.size(), "%ld-%c", &pid, &rest) != 2 || pid <= 0) continue;
    if (::kill(static_cast<pid_t>(pid), 0) == 0 || errno != ESRCH) continue;
    leftovers.push_back(entry->path());
  }
  for (const fs::path& leftover : leftovers) fs::remove_all(leftover, error);
}

// `shown` is named in messages instead of the hidden folder.
void SyncTree(const fs::path& root, const fs::path& shown) {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
    if (entry.is_directory()) {
      SyncDirectory(entry.path());
    } else if (entry.is_regular_file()) {
      const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC);
      if (descriptor < 0) continue;
      const bool is_safe = ::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP;
      const int reason = errno;
      ::close(descriptor);
      if (!is_safe) {
        FailOutput(shown / entry.path().lexically_relative(root), "writing", reason);
      }
    }
  }
  SyncDirectory(root);
}

std::string FormatTime(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

// Names for copies: the paths below the folder that all of them share.
std::vector<fs::path> MakeCopyNames(const std::vector<fs::path>& files) {
  std::vector<fs::path> absolute;
  absolute.reserve(files.size());
  for (const fs::path& file : files) absolute.push_back(fs::absolute(file).lexically_normal());
  fs::path common = absolute.empty() ? fs::path() : absolute.front().parent_path();
  for (const fs::path& file : absolute) {
    while (true) {
      const fs::path relative = file.lexically_relative(common);
      if (!relative.empty() && *relative.begin() != "..") break;
      common = common.parent_path();
    }
  }
  std::vector<fs::path> names;
  names.reserve(absolute.size());
  for (const fs::path& file : absolute) names.push_back(file.lexically_relative(common));
  return names;
}

}  // namespace

ResultDirectory::ResultDirectory(fs::path target, std::string verb)
    : target_(std::move(target)), verb_(std::move(verb)) {
  if (!target_.has_filename()) target_ = target_.parent_path();  // a trailing slash
  if (!target_.has_filename() || target_.filename() == "." || target_.filename() == "..") {
    throw InputError(InputProblem{.file = "command line",
                                  .key = "-o",
                                  .found = fmt::format("'{}'", target_.string()),
                                  .expected = "a folder with a name of its own"});
  }
  CheckTarget(target_, verb_);
  MakeDirectories(target_.parent_path());
  RemoveLeftovers(target_);
  // Two results of one process may be under way; the number after the process tells them apart.
  for (int i = 0;; ++i) {
    partial_ = ParentOf(target_) /
               fmt::format("{}{}-{}", PartialPrefix(target_), static_cast<long>(::getpid()), i);
    std::error_code error;
    if (fs::create_directory(partial_, error)) break;
    if (error) FailOutput(target_, "making the folder", error.value());
  }
}

ResultDirectory::~ResultDirectory() {
  std::error_code ignored;
  if (!is_committed_) fs::remove_all(partial_, ignored);
}

void ResultDirectory::WriteText(const fs::path& name, std::string_view text) {
  const fs::path path = partial_ / name;
  const fs::path shown = target_ / name;
  MakeDirectories(path.parent_path(), shown.parent_path());
  OutputFile file(path, shown);
  file.Write(text);
  file.Close();
}

void ResultDirectory::WriteJson(const fs::path& name, const nlohmann::ordered_json& json) {
  WriteText(name, FormatJson(json));
}

void ResultDirectory::Commit() {
  SyncTree(partial_, target_);
  CheckTarget(target_, verb_);  // it may have changed while we worked
  std::error_code error;
  if (!fs::exists(target_, error)) {
    if (::rename(partial_.c_str(), target_.c_str()) != 0) {
      FailOutput(target_, "renaming the finished folder", errno);
    }
  } else if (::renameat2(AT_FDCWD, partial_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) ==
             0) {
    fs::remove_all(partial_, error);  // the older result now
  } else {
    // A file system without exchange: the older result steps aside first. A crash between the two
    // renames leaves both folders whole under hidden names, and this one is never cleaned up.
    const fs::path older =
        ParentOf(target_) /
        fmt::format(".{}.older-{}", target_.filename().string(), static_cast<long>(::getpid()));
    if (::rename(target_.c_str(), older.c_str()) != 0) {
      FailOutput(target_, "moving the earlier result aside", errno);
    }
    if (::rename(partial_.c_str(), target_.c_str()) != 0) {
      const int reason = errno;
      (void)::rename(older.c_str(), target_.c_str());
      FailOutput(target_, "renaming the finished folder", reason);
    }
    fs::remove_all(older, error);
  }
  is_committed_ = true;
  SyncDirectory(ParentOf(target_));
}

void WriteManifest(const RunManifest& manifest, ResultDirectory* results) {
  nlohmann::ordered_json json;
  const Version version = GetVersion();
  json["program"] = "kingpin";
  json["version"] = version.version;
  json["revision"] = version.revision;
  json["compiler"] = version.compiler;
  json["build_type"] = version.build_type;
  json["verb"] = results->verb();
  json["command_line"] = manifest.command_line;
  json["start"] = FormatTime(manifest.start);
  json["duration"] = {{"value", manifest.duration}, {"unit", "s"}};
  json["threads"] = manifest.threads;
  json["instruction_set"] = manifest.instruction_set;
  if (manifest.seed) json["seed"] = *manifest.seed;
  json["overrides"] = nlohmann::ordered_json::object();
  for (const Override& override_ : manifest.overrides) {
    json["overrides"][override_.path] = FormatNode(*override_.value, 10000);
  }
  std::vector<fs::path> files;  // each once
  std::set<fs::path> seen;
  for (const fs::path& file : manifest.inputs) {
    if (seen.insert(fs::absolute(file).lexically_normal()).second) files.push_back(file);
  }
  const std::vector<fs::path> names = MakeCopyNames(files);
  json["inputs"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string content = ReadTextFile(files[i], std::numeric_limits<std::size_t>::max());
    const fs::path copy = fs::path("inputs") / names[i];
    results->WriteText(copy, content);
    json["inputs"].push_back(
        {{"file", files[i].string()}, {"copy", copy.string()}, {"sha256", CalcSha256(content)}});
  }
  json["solver"] = nlohmann::ordered_json::object();
  for (const auto& [name, value] : manifest.solver) json["solver"][name] = value;
  json["outputs"] = ListFiles(results->partial());
  results->WriteJson(kManifest, json);
}

}  // namespace kingpin::io
