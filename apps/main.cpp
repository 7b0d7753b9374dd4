#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/common_options.h"
#include "core/io/error.h"
#include "core/io/nearest_name.h"

namespace {

/// The parser's own message does not name what it did not know.
void RequireVerb(const CLI::App& app, const std::string& word) {
  if (word.empty() || word[0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (verb->get_name() == word) return;
    names.push_back(verb->get_name());
  }
  throw kingpin::io::InputError({"", 0, "", fmt::format("'{}'", word), "a verb",
                                 kingpin::io::SuggestName(word, names, "verbs")});
}

}  // namespace

int main(int argc, char** argv) {
  using namespace kingpin;
  CLI::App app{"Kingpin: what does the driver's hand feel when one wheel hits an obstacle?",
               "kingpin"};
  app.require_subcommand(1);
  app.set_version_flag("--version", KINGPIN_VERSION);
  apps::CommonOptions options;
  options.command_line.assign(argv, argv + argc);
  apps::AddVerbStudy(app, options);
  apps::AddVerbSimulate(app, options);
  apps::AddVerbOptimise(app, options);
  apps::AddVerbModes(app, options);
  apps::AddVerbMetrics(app, options);
  apps::AddVerbCheck(app, options);
  apps::AddVerbSchema(app, options);
  try {
    if (argc > 1) RequireVerb(app, argv[1]);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const io::InputError& error) {
    std::fprintf(stderr, "kingpin: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kingpin: %s\n", error.what());
    return 1;
  }
  return 0;
}
