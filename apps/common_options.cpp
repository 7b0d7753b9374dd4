#include "apps/common_options.h"

#include <CLI/CLI.hpp>

namespace kingpin::apps {

void AddCommonOptions(CLI::App& verb, CommonOptions& options) {
  verb.add_option("-o,--output", options.output, "Where the results go")->type_name("PATH");
  verb.add_option("--set", options.sets, "Override a value of the input, e.g. --set duration='2 s'")
      ->type_name("PATH=VALUE")
      ->expected(1)
      ->take_all();
  verb.add_option("--threads", options.threads, "Threads to use (default: all cores)")
      ->check(CLI::Range(1, 1024));
  verb.add_option("--seed", options.seed, "Seed of every random choice");
  verb.add_flag("--quiet", options.quiet, "No progress, no summary");
  verb.add_flag("--json", options.json, "Print the summary as JSON");
}

}  // namespace kingpin::apps
