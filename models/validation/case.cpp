#include "models/validation/case.h"

#include <cmath>

namespace kingpin::validation {

Check Compare(std::string quantity, double reference, double ours, double allowed) {
  return {std::move(quantity), reference, ours, std::abs(ours - reference), allowed};
}

Check CompareRelative(std::string quantity, double reference, double ours, double allowed) {
  return {std::move(quantity) + ", relative", reference, ours, std::abs(ours / reference - 1),
          allowed};
}

Check Bound(std::string quantity, double value, double allowed) {
  return {std::move(quantity), 0, value, std::abs(value), allowed};
}

Check CheckConvergence(std::string quantity, double coarse_error, double fine_error) {
  const double share = fine_error / coarse_error;
  return {"share of the error of " + std::move(quantity) + " left by a 100 times tighter tolerance",
          0, share, share, 0.05};
}

}  // namespace kingpin::validation
