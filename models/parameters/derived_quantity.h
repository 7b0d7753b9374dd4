#pragma once

#include "core/io/derived_value.h"

namespace kingpin::parameters {

/// A number that follows from the parameters; `kingpin check` and reports print them.
using DerivedQuantity = io::DerivedValue;
using DerivedQuantities = io::DerivedValues;

}  // namespace kingpin::parameters
