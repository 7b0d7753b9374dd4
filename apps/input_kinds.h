#pragma once

#include <filesystem>

#include "core/io/input_kinds.h"

namespace kingpin::apps {

/// Every kind of input file this program reads.
io::InputKinds MakeInputKinds();

/// Whether a file says that it is of kind `mechanism`. False for what is no file. Throws
/// io::InputError for a file that does not say what it is.
bool IsMechanismFile(const std::filesystem::path& file);

}  // namespace kingpin::apps
