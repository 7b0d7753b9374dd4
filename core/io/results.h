#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/io/csv.h"
#include "core/io/input_record.h"
#include "core/io/output_file.h"
#include "core/io/schema_core.h"

namespace kingpin::io {

/// A result folder that appears whole or not at all.
///
/// Files are written into a hidden sibling `.<name>.partial-<pid>`; Commit() forces them to the
/// disk and renames the sibling to its place. An older result there is exchanged for the new one in
/// a single step and removed afterwards, so that whoever looks, and whenever the power fails, sees
/// one whole result. Without Commit(), also when an exception passes, the sibling is removed; one
/// that a killed run left behind is removed by the next run of the same name.
///
///     io::ResultDirectory results("results/c_segment", "study");  // fails now, not after the work
///     results.WriteText("signals.csv", io::FormatSignals(signals));
///     results.WriteJson("summary.json", summary);
///     io::WriteManifest(manifest, &results);
///     results.Commit();
///
/// A folder that is there already is replaced only if it is empty, or an earlier result of the same
/// verb in which every file is one that the run wrote (`outputs` of its manifest); any other holds
/// somebody's work and is an InputError. Throws InputError for a place that cannot be used
/// (permission, full disk) and RunError for a device that fails. Messages name files where they
/// will be, not where they are until Commit().
class ResultDirectory {
 public:
  ResultDirectory(std::filesystem::path target, std::string verb);
  ~ResultDirectory();
  ResultDirectory(const ResultDirectory&) = delete;
  ResultDirectory& operator=(const ResultDirectory&) = delete;

  /// Where the folder will be.
  const std::filesystem::path& target() const { return target_; }
  /// What makes the result, e.g. `study`.
  const std::string& verb() const { return verb_; }
  /// Where files go until Commit().
  const std::filesystem::path& partial() const { return partial_; }

  /// `name` may contain folders: `stages/step_1/signals.csv`.
  void WriteText(const std::filesystem::path& name, std::string_view text);
  /// Numbers read back as the same double; NaN and infinity become null.
  void WriteJson(const std::filesystem::path& name, const nlohmann::ordered_json& json);
  /// A file written by others inside partial() is forced to the disk by Commit() as well.
  void Commit();

 private:
  std::filesystem::path target_;
  std::string verb_;
  std::filesystem::path partial_;
  bool is_committed_ = false;
};

/// What made a result: enough to make it again.
struct RunManifest {
  std::vector<std::string> command_line;      ///< as given, program first
  std::vector<std::filesystem::path> inputs;  ///< every file read (InputRecord::files)
  std::vector<Override> overrides;            ///< of --set
  std::optional<std::uint64_t> seed;
  int threads = 1;
  std::string instruction_set;  ///< that ran: `AVX-512`, `AVX2`, `portable`
  /// Numbers of the solvers: steps, evaluations, rejected steps, ...
  std::vector<std::pair<std::string, double>> solver;
  std::chrono::system_clock::time_point start = std::chrono::system_clock::now();
  double duration = 0.0;  ///< wall time [s]
};

/// Copies the inputs to `inputs/` (folders above their common one are left out) and writes
/// `manifest.json` with their SHA-256, the version, revision and compiler, and the list of all
/// files written: the last thing to do before Commit(). Throws as WriteText, and InputError when an
/// input has gone.
void WriteManifest(const RunManifest& manifest, ResultDirectory* results);

}  // namespace kingpin::io
