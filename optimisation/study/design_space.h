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

/// What keeps a curve from falling, at its nodes and between them: coefficients · x ≤ bound.
///
/// A monotone cubic falls nowhere if its node values f_k do not: f_k ≤ f_{k+1}. The slopes s_k of a
/// natural cubic at its nodes are linear in the node values; with the chords Δ_k = (f_{k+1} −
/// f_k)/h_k it falls nowhere if
///
///   s_k ≥ 0,   s_k ≤ 3 Δ_k,   s_{k+1} ≤ 3 Δ_k
///
/// for every node and segment: halve the segment, and these say that no Bernstein coefficient of
/// the slope on either half is negative. Sufficient, not necessary: a curve may be steeper at a
/// node than three times a neighbouring chord and still rise. Conditions that no design within the
/// bounds violates are left out, and for an odd curve those of its left half.
///
/// Source: the square [0, 3]² within the region of Fritsch and Carlson, SIAM J. Numer. Anal. 17
/// (1980); de Boor and Swartz, J. Approx. Theory 21 (1977).
struct MonotoneCondition {
  std::string name;
  std::vector<double> coefficients;  ///< one per variable
  double bound = 0.0;
};

/// The free variables of one stage around a base design. Immutable.
class DesignSpace {
 public:
  /// `free` names scalars (scalar_fields.h) and curves (`assistance`, `longitudinal`); their bounds
  /// come from `variables` and `curves`. A curve's node values move within ± fraction of their
  /// values in `reference`, the case's initial model; a node at x = 0 or of value 0 stays. Throws
  /// io::InputError (with `context` as the file, the variable's name as the key) when a name is
  /// unknown, bounds are missing or crossed, the start lies outside them, or a curve is not odd or
  /// not monotone (somewhere between its nodes) where that is asked.
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

  /// True when the design is the base but for variables of the space, which lie within its bounds
  /// (to rounding).
  bool Contains(const planar::Parameters<double>& design) const;

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
