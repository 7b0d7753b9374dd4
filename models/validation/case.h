#pragma once

#include <string>
#include <vector>

namespace kingpin::validation {

/// One number of a case held against the truth.
struct Check {
  std::string quantity;  ///< with its unit, and with method and tolerance where several ran
  double reference = 0;
  double ours = 0;
  double error = 0;    ///< as the quantity says: absolute unless it says "relative"
  double allowed = 0;  ///< largest error that passes

  /// A NaN does not pass.
  bool passes() const { return error <= allowed; }
};

/// |ours - reference| <= allowed.
Check Compare(std::string quantity, double reference, double ours, double allowed);
/// |ours/reference - 1| <= allowed.
Check CompareRelative(std::string quantity, double reference, double ours, double allowed);
/// |value| <= allowed: residuals, drifts, and errors that are the largest over a run.
Check Bound(std::string quantity, double value, double allowed);
/// A hundredfold tighter tolerance lowers the error at least twentyfold: the share of the error
/// that is left is at most 0.05.
Check CheckConvergence(std::string quantity, double coarse_error, double fine_error);

/// A problem whose solution is known.
struct Case {
  std::string name;    ///< short, as in benchmarks: `A01`
  std::string title;   ///< what moves
  std::string source;  ///< where the problem and its solution come from
  std::vector<Check> (*run)();
};

}  // namespace kingpin::validation
