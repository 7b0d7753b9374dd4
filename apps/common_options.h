#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace kingpin::apps {

/// Options that several verbs have and understand the same way. A verb offers those that change
/// what it does.
struct CommonOptions {
  std::string output;  ///< -o PATH; empty: results/<name>, or standard output where a verb prints
  std::vector<std::string> sets;  ///< --set path=value, in the order given
  int threads = 0;                ///< 0: as many as the machine has
  std::optional<std::uint64_t> seed;
  bool quiet = false;
  bool json = false;                      ///< machine-readable summary on standard output
  std::vector<std::string> command_line;  ///< as typed, for the run manifest
};

/// -o, with what it means for the verb.
void AddOutputOption(CLI::App& verb, CommonOptions& options, const std::string& description);
/// --set
void AddSetOption(CLI::App& verb, CommonOptions& options);
/// --threads and --seed
void AddSearchOptions(CLI::App& verb, CommonOptions& options);
/// --quiet and --json
void AddPrintOptions(CLI::App& verb, CommonOptions& options);

/// Verbs. Each adds its subcommand, whose callback does the work and throws io::InputError (status
/// 2) or any other exception (status 1).
void AddVerbCheck(CLI::App& app, CommonOptions& options);
void AddVerbMetrics(CLI::App& app, CommonOptions& options);
void AddVerbModes(CLI::App& app, CommonOptions& options);
void AddVerbOptimise(CLI::App& app, CommonOptions& options);
void AddVerbSchema(CLI::App& app, CommonOptions& options);
void AddVerbSimulate(CLI::App& app, CommonOptions& options);
void AddVerbStudy(CLI::App& app, CommonOptions& options);
void AddVerbUrdf(CLI::App& app, CommonOptions& options);
void AddVerbValidate(CLI::App& app, CommonOptions& options);

}  // namespace kingpin::apps
