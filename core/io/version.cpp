#include "core/io/version.h"

#include <fmt/format.h>

namespace kingpin::io {

Version GetVersion() {
  return Version{.version = KINGPIN_VERSION,
                 .revision = KINGPIN_REVISION,
                 .compiler = KINGPIN_COMPILER,
                 .build_type = KINGPIN_BUILD_TYPE};
}

std::string FormatVersion() {
  return fmt::format("kingpin {} ({})", KINGPIN_VERSION, KINGPIN_REVISION);
}

}  // namespace kingpin::io
