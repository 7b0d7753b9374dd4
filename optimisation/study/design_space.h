#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/planar/parameters.h"
#include "optimisation/study/study_definition.h"

/// From a vector of design variables to the parameters of the planar model.
namespace kingpin::study {

/// One design variable: a scalar of the model, or one node value of a characteristic (for an odd curve, the
/// pair at x and −x).
struct DesignVariable {
  enum class Kind { kScalar, kAssistance, kLongitudinal };
  std::string name;  ///< `x_tr`, `assistance[3]`
  std::string unit;
  Kind kind = Kind::kScalar;
  int index = 0;       ///< of the scalar in ScalarNames(), or of the node
  int mirror = -1;     ///< node that takes the negative value, or −1
  double lower = 0.0;
  double upper = 0.0;
  double start = 0.0;
};

/// Names and units of the scalars of the planar model that may be design variables: r_L, r_X, x_tr, y_tr
/// (paper, eq. 3.15) and further parameters by their field names.
struct ScalarName {
  std::string name;
  std::string unit;
};
const std::vector<ScalarName>& ScalarNames();

/// Index in ScalarNames(), or nothing.
std::optional<int> FindScalar(const std::string& name);

/// Value of the scalar with this index.
double GetScalar(const planar::Parameters<double>& parameters, int index);

/// A monotone curve: value(variable `low`) − value(variable `high`) ≤ 0, where −1 stands for a fixed node value.
struct MonotoneCondition {
  int low = -1;
  int high = -1;
  double low_value = 0.0;   ///< used when low is −1
  double high_value = 0.0;  ///< used when high is −1
};

/// The free variables of one stage around a base design.
class DesignSpace {
 public:
  /// `free` names scalars and curves. Bounds come from `variables` and `curves`.
  /// Throws io::InputError when a name is unknown, bounds are crossed or missing, the start lies outside them,
  /// or a curve that must be odd or monotone is not so at the start.
  static DesignSpace Make(const planar::Parameters<double>& base, const std::vector<std::string>& free,
                          const std::vector<VariableBounds>& variables,
                          const std::vector<CurveBounds>& curves, const std::string& context);

  const planar::Parameters<double>& base() const { return base_; }
  const std::vector<DesignVariable>& variables() const { return variables_; }
  const std::vector<MonotoneCondition>& monotone() const { return monotone_; }
  int size() const { return static_cast<int>(variables_.size()); }

  /// The base design with the variables set to x.
  planar::Parameters<double> Apply(std::span<const double> x) const;

  /// The same with the derivative with respect to variable `direction`.
  planar::Parameters<math::Dual<double, 1>> ApplyTangent(std::span<const double> x,
                                                         int direction) const;

 private:
  planar::Parameters<double> base_;
  std::vector<DesignVariable> variables_;
  std::vector<MonotoneCondition> monotone_;
};

/// Sets one scalar by name; throws io::InputError naming the known ones.
void SetScalar(planar::Parameters<double>& parameters, const std::string& name, double value,
               const std::string& context);

}  // namespace kingpin::study
