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

using kingpin::io::InputError;

std::vector<const CLI::App*> GetVerbs(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// `--output` of `--output=x`.
std::string NameOf(const std::string& word) { return word.substr(0, word.find('=')); }

bool IsOption(const CLI::App& app, const std::string& word) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->check_name(NameOf(word))) return true;
  }
  return false;
}

std::vector<std::string> GetOptionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// The parser's own message does not name what it did not know. Returns the verb, null where only
/// the program's own options stand.
const CLI::App* FindVerb(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* verb : GetVerbs(app)) names.push_back(verb->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  if (word.empty()) {
    throw InputError(
        {"", 0, "", "nothing", "a verb",
         kingpin::io::SuggestName("", names, "verbs") + "; 'kingpin --help' says what they do"});
  }
  for (const CLI::App* verb : GetVerbs(app)) {
    if (verb->get_name() == word) return verb;
  }
  if (IsOption(app, word)) return nullptr;
  if (word[0] == '-') {
    const std::string nearest = kingpin::io::FindNearestName(NameOf(word), GetOptionNames(app));
    throw InputError({"", 0, "", fmt::format("'{}'", word), "a verb before any option",
                      nearest.empty() ? kingpin::io::SuggestName("", names, "verbs")
                                      : fmt::format("did you mean '{}'?", nearest)});
  }
  throw InputError({"", 0, "", fmt::format("'{}'", word), "a verb",
                    kingpin::io::SuggestName(word, names, "verbs")});
}

/// What the parser found wrong, in the form of all other messages.
std::string FormatParseError(const CLI::ParseError& error, const CLI::App* verb, int argc,
                             char** argv) {
  const std::string help =
      fmt::format("see 'kingpin{} --help'", verb == nullptr ? "" : " " + verb->get_name());
  if (verb != nullptr && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    for (int i = 2; i < argc; ++i) {
      const std::string word = argv[i];
      if (word.size() < 2 || word[0] != '-' || IsOption(*verb, word)) continue;
      const std::string nearest = kingpin::io::FindNearestName(NameOf(word), GetOptionNames(*verb));
      return kingpin::io::FormatProblem(
          {"command line", 0, "", fmt::format("'{}'", word),
           fmt::format("an option of '{}'", verb->get_name()),
           nearest.empty() ? help : fmt::format("did you mean '{}'?", nearest)});
    }
  }
  return fmt::format("command line: {}; {}", error.what(), help);
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
  apps::AddVerbUrdf(app, options);
  apps::AddVerbCheck(app, options);
  apps::AddVerbSchema(app, options);
  apps::AddVerbValidate(app, options);
  const CLI::App* verb = nullptr;
  try {
    verb = FindVerb(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::fprintf(stderr, "kingpin: %s\n", FormatParseError(error, verb, argc, argv).c_str());
    return 2;
  } catch (const io::InputError& error) {
    std::fprintf(stderr, "kingpin: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kingpin: %s\n", error.what());
    return 1;
  }
  return 0;
}
