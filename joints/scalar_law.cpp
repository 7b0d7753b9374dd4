#include "joints/scalar_law.h"

#include <cmath>

#include <fmt/format.h>

#include "joints/fail.h"

namespace kingpin::joints {

ScalarLaw::ScalarLaw(const LawDescription& description, const Source& source,
                     const std::string& key)
    : coefficient_(description.coefficient) {
  const auto& points = description.points;
  if (!std::isfinite(coefficient_)) {
    Fail(source, key, fmt::format("{:g}", coefficient_), "a finite number");
  }
  if (coefficient_ < 0) {
    Fail(source, key, fmt::format("{:g}", coefficient_), "a number that is not negative",
         "give a falling characteristic by points");
  }
  if (points.empty()) return;
  if (coefficient_ != 0) {
    Fail(source, key, fmt::format("a coefficient ({:g}) and points", coefficient_),
         "one of the two");
  }
  const int count = static_cast<int>(points.size());
  if (count < 2 || count > kMaxPoints) {
    Fail(source, key, fmt::format("{} points", count), fmt::format("2 to {} points", kMaxPoints));
  }
  double x[kMaxPoints], f[kMaxPoints];
  for (int k = 0; k < count; ++k) {
    x[k] = points[k][0], f[k] = points[k][1];
    if (!std::isfinite(x[k]) || !std::isfinite(f[k])) {
      Fail(source, key, fmt::format("point ({:g}, {:g})", x[k], f[k]), "finite numbers");
    }
    if (k == 0) continue;
    if (!(x[k] > x[k - 1])) {
      Fail(source, key, fmt::format("argument {:g} after {:g}", x[k], x[k - 1]),
           "arguments in rising order");
    }
    if (description.must_rise && f[k] < f[k - 1]) {
      Fail(source, key,
           fmt::format("force {:g} at {:g} after {:g} at {:g}", f[k], x[k], f[k - 1], x[k - 1]),
           "forces that do not fall");
    }
  }
  spline_ = std::make_shared<const Spline>(description.interpolation ==
                                                   LawDescription::Interpolation::kNatural
                                               ? Spline::MakeNatural(count, x, f)
                                               : Spline::MakeMonotone(count, x, f));
  if (description.must_rise &&
      description.interpolation == LawDescription::Interpolation::kNatural) {
    // the slope of a cubic piece is least at an end or where its second derivative vanishes
    for (int k = 0; k + 1 < count; ++k) {
      const double h = x[k + 1] - x[k];
      const double left = spline_->CalcSlope(x[k]);
      const double middle = spline_->CalcSlope(x[k] + 0.5 * h);
      const double right = spline_->CalcSlope(std::nextafter(x[k + 1], x[k]));
      // slope(t) = left + t (c + t a), t in [0, 1]
      const double a = 2 * (left + right) - 4 * middle, c = right - left - a;
      const double t = a > 0 ? -c / (2 * a) : -1;
      const double least = t > 0 && t < 1 ? left + t * (c + t * a) : std::min(left, right);
      if (least < -1e-9 * (std::abs(left) + std::abs(right))) {
        Fail(source, key,
             fmt::format("a natural spline that falls between {:g} and {:g}", x[k], x[k + 1]),
             "a curve that does not fall", "use monotone interpolation");
      }
    }
  }
  integral_at_zero_ = spline_->CalcIntegral(0.0);
}

ScalarLaw MakeDampingLaw(const LawDescription& description, const Source& source,
                         const std::string& key) {
  ScalarLaw law(description, source, key);
  constexpr int kSamples = 16;
  const auto& points = description.points;
  double largest = 0;
  for (const auto& point : points) largest = std::max(largest, std::abs(point[1]));
  const auto check = [&](double x) {
    if (law(x) * x < -1e-9 * largest * std::abs(x) ||
        (x == 0 && std::abs(law(x)) > 1e-9 * largest)) {
      Fail(source, key, fmt::format("force {:g} at rate {:g}", law(x), x),
           "a damper that never drives: zero at rest, else of the rate's sign");
    }
  };
  if (!points.empty()) {
    check(0.0);
    const double first = points.front()[0], last = points.back()[0];
    const double reach = last - first;
    // the ends continue linearly: one point far out stands for all
    check(first - 1e3 * reach);
    check(last + 1e3 * reach);
  }
  for (size_t k = 0; k + 1 < points.size(); ++k) {
    const double h = (points[k + 1][0] - points[k][0]) / kSamples;
    for (int i = 0; i <= kSamples; ++i) check(points[k][0] + i * h);
  }
  return law;
}

ScalarLaw MakeContactLaw(const LawDescription& description, const Source& source,
                         const std::string& key) {
  LawDescription rising = description;
  rising.must_rise = true;
  ScalarLaw law(rising, source, key);
  double largest = 0;
  for (const auto& point : description.points) largest = std::max(largest, std::abs(point[1]));
  if (std::abs(law(0.0)) > 1e-9 * largest) {
    Fail(source, key, fmt::format("force {:g} at contact", law(0.0)), "no force at contact",
         "let the points begin with (0, 0)");
  }
  if (law.is_zero()) Fail(source, key, "0", "a stiffness above zero");
  return law;
}

}  // namespace kingpin::joints
