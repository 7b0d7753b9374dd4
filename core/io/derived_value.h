#pragma once

#include <string>
#include <vector>

namespace kingpin::io {

/// A number that follows from an input, with what a reader needs to recompute it.
struct DerivedValue {
  std::string name;     ///< path, e.g. `front.kingpin_inclination`
  double value = 0.0;   ///< in the unit shown
  std::string unit;     ///< e.g. `deg`; `-` when there is none
  std::string formula;  ///< as text
  std::string source;   ///< where the formula comes from
};

using DerivedValues = std::vector<DerivedValue>;

}  // namespace kingpin::io
