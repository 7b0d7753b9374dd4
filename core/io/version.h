#pragma once

#include <string>

namespace kingpin::io {

/// What was built, when CMake configured it.
struct Version {
  std::string version;   ///< e.g. `0.1.0`
  std::string revision;  ///< of git, shortened; `unknown` outside a git checkout.
                         ///< `-dirty` behind it: tracked files were modified when CMake configured
  std::string compiler;  ///< e.g. `GNU 12.2.0`
  std::string build_type;
};

Version GetVersion();

/// `kingpin 0.1.0 (1a2b3c4d5e6f)`
std::string FormatVersion();

}  // namespace kingpin::io
