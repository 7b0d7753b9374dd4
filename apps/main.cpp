#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "apps/common_options.h"
#include "core/io/error.h"

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
