#include "optimisation/study/design_space.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/io/nearest_name.h"
#include "models/planar/curve_spline.h"
#include "optimisation/study/scalar_fields.h"

namespace kingpin::study {
namespace {

using planar::Parameters;

[[noreturn]] void Reject(const std::string& context, const std::string& key,
                         const std::string& found, const std::string& expected,
                         const std::string& suggestion = "") {
  throw io::InputError({context, 0, key, found, expected, suggestion});
}

std::vector<std::string> KnownNames() {
  std::vector<std::string> names;
  for (const auto& field : ScalarFields<double>()) names.emplace_back(field.name);
  names.emplace_back("assistance");
  names.emplace_back("longitudinal");
  return names;
}

int FindScalar(const std::string& name) {
  const auto fields = ScalarFields<double>();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (name == fields[i].name) return static_cast<int>(i);
  }
  return -1;
}

template <class S>
planar::Curve<S>& CurveOf(Parameters<S>& p, DesignVariable::Kind kind) {
  return kind == DesignVariable::Kind::kAssistance ? p.assist_force : p.longitudinal_force;
}

const planar::Curve<double>& CurveOf(const Parameters<double>& p, DesignVariable::Kind kind) {
  return kind == DesignVariable::Kind::kAssistance ? p.assist_force : p.longitudinal_force;
}

template <class S>
void SetVariable(Parameters<S>& p, const DesignVariable& variable, const S& value) {
  if (variable.kind == DesignVariable::Kind::kScalar) {
    p.*(ScalarFields<S>()[variable.index].member) = value;
    return;
  }
  planar::Curve<S>& curve = CurveOf(p, variable.kind);
  curve.f[variable.index] = value;
  if (variable.mirror >= 0) curve.f[variable.mirror] = -value;
}

int FindMirror(const planar::Curve<double>& curve, int node) {
  const double wanted = -curve.x[node];
  for (int k = 0; k < curve.count; ++k) {
    if (k != node && std::abs(curve.x[k] - wanted) <= 1e-9 * std::abs(wanted)) return k;
  }
  return -1;
}

void AddScalar(const Parameters<double>& base, const std::string& name, int index,
               const std::optional<VariableBounds>& bounds, const std::string& context,
               std::vector<DesignVariable>& variables) {
  if (!bounds) {
    Reject(context, fmt::format("variables.{}", name), "nothing", "a lower and an upper bound",
           "every free variable needs bounds");
  }
  const auto field = ScalarFields<double>()[index];
  DesignVariable variable;
  variable.name = name;
  variable.unit = field.unit;
  variable.index = index;
  variable.lower = bounds->lower;
  variable.upper = bounds->upper;
  variable.start = base.*(field.member);
  if (!(variable.lower < variable.upper)) {
    Reject(context, fmt::format("variables.{}", name),
           fmt::format("{} .. {} {}", io::FormatNumber(variable.lower),
                       io::FormatNumber(variable.upper), variable.unit),
           "a lower bound below the upper one");
  }
  if (!(variable.start >= variable.lower && variable.start <= variable.upper)) {
    Reject(context, fmt::format("variables.{}", name),
           fmt::format("start {} {}", io::FormatNumber(variable.start), variable.unit),
           fmt::format("a start within {} .. {} {}", io::FormatNumber(variable.lower),
                       io::FormatNumber(variable.upper), variable.unit));
  }
  variables.push_back(variable);
}

/// Slopes of the natural cubic at its nodes, one row of weights of the node values each.
std::vector<std::vector<double>> CalcNaturalSlopeWeights(const planar::Curve<double>& curve) {
  const auto count = static_cast<std::size_t>(curve.count);
  std::vector<std::vector<double>> weights(count, std::vector<double>(count));
  for (std::size_t j = 0; j < count; ++j) {
    planar::Curve<double> unit = curve;
    unit.f.fill(0.0);
    unit.f[j] = 1.0;
    const auto spline = planar::MakeSpline(unit);
    for (std::size_t k = 0; k < count; ++k) weights[k][j] = spline.CalcSlope(curve.x[k]);
  }
  return weights;
}

/// The least slope of the curve on the segment after node k: of a quadratic, at an end or between.
double CalcLeastSlope(const planar::Curve<double>& curve, int k) {
  const auto spline = planar::MakeSpline(curve);
  const double left = curve.x[k], h = curve.x[k + 1] - left;
  const double chord = (curve.f[k + 1] - curve.f[k]) / h;
  // At the right end the slope of this segment: that of the curve, which is C1.
  const double a = spline.CalcSlope(left), b = spline.CalcSlope(left + h);
  const double middle = 1.5 * chord - 0.25 * (a + b);
  double least = std::min(a, b);
  const double curvature = 2.0 * (a + b - 2.0 * middle);
  if (curvature > 0.0) {
    const double at = 0.5 + 0.5 * (a - b) / curvature;
    if (at > 0.0 && at < 1.0) {
      least = std::min(least, middle - 0.25 * (a - b) * (a - b) / curvature);
    }
  }
  return least;
}

void CheckNeverFalls(const planar::Curve<double>& curve, const std::string& name,
                     const std::string& context) {
  double steepest = 0.0;
  for (int k = 0; k + 1 < curve.count; ++k) {
    // A search ends on the condition to rounding.
    const double rounding = 1e-9 * (std::abs(curve.f[k]) + std::abs(curve.f[k + 1]));
    if (curve.f[k] > curve.f[k + 1] + rounding) {
      Reject(
          context, fmt::format("curves.{}", name),
          fmt::format("a curve that falls from {} to {} N at x = {}", io::FormatNumber(curve.f[k]),
                      io::FormatNumber(curve.f[k + 1]), io::FormatNumber(curve.x[k + 1])),
          "node values that never decrease, because the curve is to be monotone");
    }
    steepest = std::max(steepest, (curve.f[k + 1] - curve.f[k]) / (curve.x[k + 1] - curve.x[k]));
  }
  for (int k = 0; k + 1 < curve.count; ++k) {
    if (CalcLeastSlope(curve, k) >= -1e-6 * steepest) continue;
    Reject(context, fmt::format("curves.{}", name),
           fmt::format("a natural cubic that falls between its nodes at x = {} and {}",
                       io::FormatNumber(curve.x[k]), io::FormatNumber(curve.x[k + 1])),
           "a curve that never falls, because it is to be monotone",
           "node values that bend less, or 'monotone: false'");
  }
}

/// Adds the conditions of MonotoneCondition. `owner` and `sign` say which variable sets a node, and
/// with which sign; −1: none.
void AddMonotoneConditions(const planar::Curve<double>& curve, const std::string& name, bool odd,
                           const std::vector<int>& owner, const std::vector<double>& sign,
                           const std::vector<DesignVariable>& variables,
                           std::vector<MonotoneCondition>& conditions) {
  const auto count = static_cast<std::size_t>(curve.count);
  // Σ weight_k f_k ≥ 0, as a row over the variables.
  const auto add = [&](std::string what, const std::vector<double>& weight) {
    MonotoneCondition condition;
    condition.name = std::move(what);
    condition.coefficients.assign(variables.size(), 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      if (owner[k] < 0) {
        condition.bound += weight[k] * curve.f[k];
      } else {
        condition.coefficients[static_cast<std::size_t>(owner[k])] -= weight[k] * sign[k];
      }
    }
    double largest = 0.0;
    for (std::size_t i = 0; i < variables.size(); ++i) {
      const double c = condition.coefficients[i];
      largest += c * (c > 0.0 ? variables[i].upper : variables[i].lower);
    }
    if (largest > condition.bound) conditions.push_back(std::move(condition));
  };
  const bool natural = curve.kind == planar::CurveKind::kNatural;
  const auto slopes = natural ? CalcNaturalSlopeWeights(curve) : std::vector<std::vector<double>>{};
  std::vector<double> weight(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (natural && !(odd && curve.x[k] < 0.0)) {
      // Times the segment's width, so that all conditions are forces.
      const double h = k + 1 < count ? curve.x[k + 1] - curve.x[k] : curve.x[k] - curve.x[k - 1];
      for (std::size_t j = 0; j < count; ++j) weight[j] = h * slopes[k][j];
      add(fmt::format("{} rising at node {}", name, k), weight);
    }
    if (k + 1 == count || (odd && curve.x[k + 1] <= 0.0)) continue;
    if (!natural) {
      std::fill(weight.begin(), weight.end(), 0.0);
      weight[k] = -1.0;
      weight[k + 1] = 1.0;
      add(fmt::format("{}[{}] not below its neighbour", name, k + 1), weight);
      continue;
    }
    const double h = curve.x[k + 1] - curve.x[k];
    for (const std::size_t end : {k, k + 1}) {
      for (std::size_t j = 0; j < count; ++j) weight[j] = -h * slopes[end][j];
      weight[k] -= 3.0;
      weight[k + 1] += 3.0;
      add(fmt::format("{} rising between nodes {} and {}", name, k, k + 1), weight);
    }
  }
}

/// Adds the node values of one curve and the conditions that keep it monotone.
void AddCurve(const Parameters<double>& base, const Parameters<double>& reference,
              const std::string& name, DesignVariable::Kind kind,
              const std::optional<CurveBounds>& bounds, const std::string& context,
              std::vector<DesignVariable>& variables, std::vector<MonotoneCondition>& monotone) {
  if (!bounds) {
    Reject(context, fmt::format("curves.{}", name), "nothing", "how far the node values may move",
           "every free curve needs a fraction");
  }
  if (!(bounds->fraction > 0.0 && std::isfinite(bounds->fraction))) {
    Reject(context, fmt::format("curves.{}.fraction", name), io::FormatNumber(bounds->fraction),
           "a positive fraction");
  }
  const planar::Curve<double>& curve = CurveOf(base, kind);
  const planar::Curve<double>& centre = CurveOf(reference, kind);
  if (curve.count == 0) {
    Reject(context, fmt::format("curves.{}", name), "a model without this curve",
           "a model that has it");
  }
  std::vector<int> owner(curve.count, -1);  // which variable sets this node
  std::vector<double> sign(curve.count, 1.0);
  for (int k = 0; k < curve.count; ++k) {
    if (centre.f[k] == 0.0) continue;
    DesignVariable variable;
    if (bounds->odd) {
      const int mirror = FindMirror(curve, k);
      if (mirror < 0 || std::abs(centre.f[mirror] + centre.f[k]) > 1e-9 * std::abs(centre.f[k])) {
        Reject(context, fmt::format("curves.{}", name),
               fmt::format("a curve that is not odd at x = {}", io::FormatNumber(curve.x[k])),
               "f(-x) = -f(x) at every node");
      }
      if (curve.x[k] < 0.0) continue;
      variable.mirror = mirror;
      owner[mirror] = static_cast<int>(variables.size());
      sign[mirror] = -1.0;
    }
    variable.name = fmt::format("{}[{}]", name, k);
    variable.unit = std::string(1, 'N');
    variable.kind = kind;
    variable.index = k;
    const double reach = bounds->fraction * std::abs(centre.f[k]);
    variable.lower = centre.f[k] - reach;
    variable.upper = centre.f[k] + reach;
    variable.start = std::clamp(curve.f[k], variable.lower, variable.upper);
    owner[k] = static_cast<int>(variables.size());
    variables.push_back(variable);
  }
  if (!bounds->monotone) return;
  CheckNeverFalls(curve, name, context);
  AddMonotoneConditions(curve, name, bounds->odd, owner, sign, variables, monotone);
}

}  // namespace

DesignSpace DesignSpace::Make(const Parameters<double>& base, const Parameters<double>& reference,
                              const std::vector<std::string>& free, const VariableTable& variables,
                              const CurveTable& curves, const std::string& context) {
  DesignSpace space;
  space.base_ = base;
  for (const std::string& name : free) {
    if (std::count(free.begin(), free.end(), name) > 1) {
      Reject(context, "free", fmt::format("'{}' twice", name), "every variable once");
    }
    if (const int index = FindScalar(name); index >= 0) {
      AddScalar(base, name, index, variables[index], context, space.variables_);
    } else if (name == "assistance") {
      AddCurve(base, reference, name, DesignVariable::Kind::kAssistance, curves.assistance, context,
               space.variables_, space.monotone_);
    } else if (name == "longitudinal") {
      AddCurve(base, reference, name, DesignVariable::Kind::kLongitudinal, curves.longitudinal,
               context, space.variables_, space.monotone_);
    } else {
      Reject(context, "free", fmt::format("'{}'", name), "the name of a design variable or curve",
             io::SuggestName(name, KnownNames(), "names"));
    }
  }
  // Those of the first curve know nothing of the variables that came later.
  for (MonotoneCondition& condition : space.monotone_) {
    condition.coefficients.resize(space.variables_.size(), 0.0);
  }
  return space;
}

Parameters<double> DesignSpace::Apply(std::span<const double> x) const {
  Parameters<double> p = base_;
  for (int i = 0; i < size(); ++i) SetVariable(p, variables_[i], x[i]);
  return p;
}

Parameters<math::Dual<double, 1>> DesignSpace::ApplyTangent(std::span<const double> x,
                                                            int direction) const {
  using D = math::Dual<double, 1>;
  auto p = planar::ConvertParameters<D>(base_, [](double value) { return D(value); });
  for (int i = 0; i < size(); ++i) {
    D value(x[i]);
    if (i == direction) value.d[0] = 1.0;
    SetVariable(p, variables_[i], value);
  }
  return p;
}

DesignSpace DesignSpace::WithBase(const Parameters<double>& base) const {
  DesignSpace space = *this;
  space.base_ = base;
  return space;
}

std::vector<double> DesignSpace::Extract(const Parameters<double>& design) const {
  std::vector<double> x;
  x.reserve(variables_.size());
  for (const DesignVariable& v : variables_) {
    x.push_back(std::clamp(GetVariable(design, v), v.lower, v.upper));
  }
  return x;
}

bool DesignSpace::Contains(const Parameters<double>& design) const {
  const Parameters<double> inside = Apply(Extract(design));
  const auto near = [](double a, double b) {
    return std::abs(a - b) <= 1e-9 * (std::abs(a) + std::abs(b));
  };
  const auto same_curve = [&](const planar::Curve<double>& a, const planar::Curve<double>& b) {
    if (a.count != b.count) return false;
    return std::equal(a.x.begin(), a.x.begin() + a.count, b.x.begin(), near) &&
           std::equal(a.f.begin(), a.f.begin() + a.count, b.f.begin(), near);
  };
  for (const auto& field : ScalarFields<double>()) {
    if (!near(design.*(field.member), inside.*(field.member))) return false;
  }
  return same_curve(design.assist_force, inside.assist_force) &&
         same_curve(design.longitudinal_force, inside.longitudinal_force);
}

double GetVariable(const Parameters<double>& design, const DesignVariable& variable) {
  if (variable.kind == DesignVariable::Kind::kScalar) {
    return design.*(ScalarFields<double>()[variable.index].member);
  }
  return CurveOf(design, variable.kind).f[variable.index];
}

CurveTable MergeCurves(const CurveTable& general, const CurveTable& special) {
  CurveTable merged = general;
  if (special.assistance) merged.assistance = special.assistance;
  if (special.longitudinal) merged.longitudinal = special.longitudinal;
  return merged;
}

void SetScalars(Parameters<double>& design, const DesignValues& values) {
  const auto fields = ScalarFields<double>();
  for (int i = 0; i < kScalarFieldCount; ++i) {
    if (values[i]) design.*(fields[i].member) = *values[i];
  }
}

}  // namespace kingpin::study
