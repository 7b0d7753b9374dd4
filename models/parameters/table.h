#pragma once

#include <vector>

namespace kingpin::parameters {

/// Points (x_k, y_k) of a characteristic, x strictly increasing. What lies between and outside is
/// up to whom uses it; the header of each use says so.
struct Table {
  std::vector<double> x;
  std::vector<double> y;
};

}  // namespace kingpin::parameters
