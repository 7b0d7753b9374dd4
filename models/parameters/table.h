#pragma once

#include "core/io/schema.h"

namespace kingpin::parameters {

/// Points (x_k, y_k) of a characteristic, x strictly increasing. What lies between and outside is
/// up to whom uses it; the header of each use says so.
using Table = io::CurveTable;

}  // namespace kingpin::parameters
