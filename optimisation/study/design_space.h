#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/math/dual.h"
#include "models/planar/parameters.h"
#include "optimisation/study/study_definition.h"

/// From a vector of design variables to the parameters of the planar model, and back.
namespace kingpin::study {

/// One design variable: a scalar of the model, or one node value of a characteristic (for an odd
/// curve, the values at x and −x together).
struct DesignVariable {
  enum class Kind { kScalar, kAssistance, kLongitudinal };
  std::string name;  ///< `x_tr`, `assistance[3]`
  std::string unit;
  Kind kind = Kind::kScalar;
  int index = 0;    ///< in ScalarFields(), or of the node
  int mirror = -1;  ///< node that takes the negative value, or −1
  double lower = 0.0;
  double upper = 0.0;
  double start = 0.0;
};

/// A monotone curve: value(low) ≤ value(high) for two neighbouring nodes. A node that is not free
/// has −1 and its fixed value; `low_sign` is −1 where an odd curve's variable stands for the
/// mirrored node.
struct MonotoneCondition {
  int low = -1;
  int high = -1;
  double low_sign = 1.0;
  double high_sign = 1.0;
  double low_value = 0.0;
  double high_value = 0.0;
};

/// The free variables of one stage around a base design. Immutable.
class DesignSpace {
 public:
  /// `free` names scalars (scalar_fields.h) and curves (`assistance`, `longitudinal`); their bounds
  /// come from `variables` and `curves`. A curve's node values move within ± fraction of their
  /// values in `reference`, the case's initial model; a node at x = 0 or of value 0 stays. Throws
  /// io::InputError (with `context` as the file, the variable's name as the key) when a name is
  /// unknown, bounds are missing or crossed, the start lies outside them, or a curve is not odd or
  /// not monotone where that is asked.
  static DesignSpace Make(const planar::Parameters<double>& base,
                          const planar::Parameters<double>& reference,
                          const std::vector<std::string>& free, const VariableTable& variables,
                          const CurveTable& curves, const std::string& context);

  const planar::Parameters<double>& base() const { return base_; }
  const std::vector<DesignVariable>& variables() const { return variables_; }
  const std::vector<MonotoneCondition>& monotone() const { return monotone_; }
  int size() const { return static_cast<int>(variables_.size()); }

  /// The base design with the variables set to x.
  planar::Parameters<double> Apply(std::span<const double> x) const;

  /// The same, with the derivative with respect to variable number `direction`.
  planar::Parameters<math::Dual<double, 1>> ApplyTangent(std::span<const double> x,
                                                         int direction) const;

  /// The same variables around another base, whose free values do not matter.
  DesignSpace WithBase(const planar::Parameters<double>& base) const;

  /// The variables' values in another design, moved into the bounds where they lie outside.
  std::vector<double> Extract(const planar::Parameters<double>& design) const;

 private:
  planar::Parameters<double> base_;
  std::vector<DesignVariable> variables_;
  std::vector<MonotoneCondition> monotone_;
};

/// Value of a variable in a design.
double GetVariable(const planar::Parameters<double>& design, const DesignVariable& variable);

/// The bounds of `special`, and those of `general` where it has none.
CurveTable MergeCurves(const CurveTable& general, const CurveTable& special);

/// Sets the scalars that are given.
void SetScalars(planar::Parameters<double>& design, const DesignValues& values);

}  // namespace kingpin::study
