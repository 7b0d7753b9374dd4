#pragma once

#include <string>
#include <vector>

#include "models/validation/case.h"

namespace kingpin::validation {

/// A case that has been run.
struct Outcome {
  std::string name, title, source;
  std::vector<Check> checks;
  std::string failure;  ///< what stopped it; empty: nothing
  double seconds = 0;

  /// Checks that fail; a case that stopped counts as one.
  int CountFailures() const;
  bool passes() const { return CountFailures() == 0; }
};

/// Runs a case. What it throws becomes `failure`.
Outcome RunCase(const Case& each);

/// One line per check: case, quantity, reference, ours, error, allowed, pass.
std::string FormatOutcome(const Outcome& outcome);

}  // namespace kingpin::validation
