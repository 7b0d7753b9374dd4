#pragma once

#include <utility>
#include <vector>

#include "core/mechanism/model.h"

namespace kingpin::mechanism {

/// The pairs of unknowns (i, j), i >= j, whose entry in the equations may be non-zero, each once;
/// the diagonal of the coordinates among them.
std::vector<std::pair<int, int>> ListEntries(const Model& model);

/// Where the pattern of the model stores the entries that the assembly writes.
void SetSlots(Model& model);

}  // namespace kingpin::mechanism
