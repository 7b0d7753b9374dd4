#pragma once

#include <string>
#include <vector>

namespace kingpin::parameters {

/// A number that follows from the parameters, with what a reader needs to recompute it.
struct DerivedQuantity {
  std::string name;     ///< path, e.g. `front.kingpin_inclination`
  double value = 0.0;   ///< in the unit shown
  std::string unit;     ///< e.g. `deg`; `-` when there is none
  std::string formula;  ///< as text
  std::string source;   ///< where the formula comes from
};

using DerivedQuantities = std::vector<DerivedQuantity>;

}  // namespace kingpin::parameters
