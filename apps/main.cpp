#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "core/io/error.h"

int main(int argc, char** argv) {
  CLI::App app{"Kingpin: what does the driver's hand feel when one wheel hits an obstacle?"};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? 0 : 2;
  } catch (const kingpin::io::InputError& error) {
    std::fprintf(stderr, "kingpin: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kingpin: %s\n", error.what());
    return 1;
  }
  return 0;
}
