#pragma once

#include <memory>

#include "core/math/cubic_spline.h"
#include "joints/force_description.h"

namespace kingpin::joints {

/// A force law in evaluation: f(x) and its potential ∫₀ˣ f. Copies share the spline.
class ScalarLaw {
 public:
  static constexpr int kMaxPoints = 64;

  ScalarLaw() = default;
  explicit ScalarLaw(double coefficient) : coefficient_(coefficient) {}
  /// @throws io::InputError with `key`: not finite, arguments that do not rise, too few or many
  /// points, coefficient and points together, or a negative coefficient (a falling characteristic
  /// is given by points)
  ScalarLaw(const LawDescription& description, const Source& source, const std::string& key);

  bool is_zero() const { return !spline_ && coefficient_ == 0; }

  template <class S>
  S operator()(const S& x) const {
    return spline_ ? (*spline_)(x) : S(coefficient_) * x;
  }
  double CalcIntegral(double x) const {
    return spline_ ? spline_->CalcIntegral(x) - integral_at_zero_ : 0.5 * coefficient_ * x * x;
  }

 private:
  using Spline = math::CubicSpline<double, kMaxPoints>;
  double coefficient_ = 0;
  double integral_at_zero_ = 0;
  std::shared_ptr<const Spline> spline_;
};

/// A law that cannot put energy in: f(x) x >= 0 everywhere.
/// @throws io::InputError as above, and for a law that drives
ScalarLaw MakeDampingLaw(const LawDescription& description, const Source& source,
                         const std::string& key);

/// A law of pushing only: f(0) = 0 and rising.
ScalarLaw MakeContactLaw(const LawDescription& description, const Source& source,
                         const std::string& key);

}  // namespace kingpin::joints
