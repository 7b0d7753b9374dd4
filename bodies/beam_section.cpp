#include "bodies/beam_section.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

namespace kingpin::bodies {

namespace {

using std::numbers::pi;

void CheckPositive(const char* what, double value) {
  if (std::isfinite(value) && value > 0) return;
  throw std::invalid_argument(fmt::format("{} of {:g}, expected a number above zero", what, value));
}

GivenSection Calc(const TubeSection& tube) {
  CheckPositive("outer diameter", tube.outer);
  if (!(tube.inner >= 0 && tube.inner < tube.outer)) {
    throw std::invalid_argument(fmt::format(
        "inner diameter of {:g}, expected 0 to below the outer {:g}", tube.inner, tube.outer));
  }
  const double o2 = tube.outer * tube.outer, i2 = tube.inner * tube.inner;
  const double I = pi / 64 * (o2 * o2 - i2 * i2);
  const double m = tube.inner / tube.outer, m2 = m * m, ring = (1 + m2) * (1 + m2);
  const double kappa = (10 * ring + 32 * m2) / (9 * ring);
  return {pi / 4 * (o2 - i2), I, I, 2 * I, kappa, kappa};
}

GivenSection Calc(const RoundSection& round) {
  CheckPositive("diameter", round.diameter);
  return Calc(TubeSection{round.diameter, 0});
}

GivenSection Calc(const RectangularSection& rectangle) {
  CheckPositive("width", rectangle.width);
  CheckPositive("height", rectangle.height);
  const double w = rectangle.width, h = rectangle.height;
  const double a = std::max(w, h), b = std::min(w, h);  // a long, b short edge
  // J = a b³ (1/3 - 64/π⁵ b/a Σ tanh(n π a/(2 b))/n⁵, n = 1, 3, 5, ...), Timoshenko and Goodier
  // §109
  double sum = 0;
  for (int n = 399; n > 0; n -= 2) sum += std::tanh(n * pi * a / (2 * b)) / std::pow(n, 5);
  const double J = a * b * b * b * (1.0 / 3 - 64 / std::pow(pi, 5) * b / a * sum);
  return {w * h, w * h * h * h / 12, h * w * w * w / 12, J, 1.2, 1.2};
}

GivenSection Calc(const GivenSection& given) {
  CheckPositive("area", given.area);
  CheckPositive("Iy", given.Iy);
  CheckPositive("Iz", given.Iz);
  CheckPositive("torsion constant", given.torsion_constant);
  CheckPositive("shear factor", given.shear_y);
  CheckPositive("shear factor", given.shear_z);
  return given;
}

double Mix(double from, double to, double s) { return from + s * (to - from); }

RoundSection Mix(const RoundSection& a, const RoundSection& b, double s) {
  return {Mix(a.diameter, b.diameter, s)};
}
TubeSection Mix(const TubeSection& a, const TubeSection& b, double s) {
  return {Mix(a.outer, b.outer, s), Mix(a.inner, b.inner, s)};
}
RectangularSection Mix(const RectangularSection& a, const RectangularSection& b, double s) {
  return {Mix(a.width, b.width, s), Mix(a.height, b.height, s)};
}
GivenSection Mix(const GivenSection& a, const GivenSection& b, double s) {
  return {Mix(a.area, b.area, s),       Mix(a.Iy, b.Iy, s),
          Mix(a.Iz, b.Iz, s),           Mix(a.torsion_constant, b.torsion_constant, s),
          Mix(a.shear_y, b.shear_y, s), Mix(a.shear_z, b.shear_z, s)};
}

}  // namespace

GivenSection CalcSection(const Section& section) {
  return std::visit([](const auto& shape) { return Calc(shape); }, section);
}

Section Interpolate(const Section& from, const Section& to, double s) {
  return std::visit(
      [&](const auto& a) -> Section {
        const auto* b = std::get_if<std::decay_t<decltype(a)>>(&to);
        if (!b) throw std::invalid_argument("a taper between sections of two shapes");
        return Mix(a, *b, s);
      },
      from);
}

}  // namespace kingpin::bodies
