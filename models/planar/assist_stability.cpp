#include "models/planar/assist_stability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "models/planar/linear_model.h"

namespace kingpin::planar {

namespace {

// The free steering's double eigenvalue zero, split by rounding, stays far below this [1/s].
constexpr double kZero = 0.1;

}  // namespace

AssistStability CalcAssistStability(const Parameters<double>& parameters, double slope) {
  Parameters<double> straight = parameters;
  straight.assist_force.count = 2;
  straight.assist_force.x[0] = 0.0;
  straight.assist_force.x[1] = 1.0;
  straight.assist_force.f[0] = 0.0;
  straight.assist_force.f[1] = slope;
  straight.friction_law = FrictionLaw::kNone;
  straight.aligning_stiffness = 0.0;
  const Eigen::VectorXcd eigenvalues =
      Eigen::EigenSolver<Eigen::MatrixXd>(MakeLinearModel(straight).a, false).eigenvalues();
  AssistStability result{-std::numeric_limits<double>::infinity(), 0.0};
  for (const std::complex<double>& value : eigenvalues) {
    if (std::abs(value) < kZero) continue;
    if (value.real() > result.growth) {
      result = {value.real(), std::abs(value.imag()) / (2.0 * std::numbers::pi)};
    }
  }
  return result;
}

double CalcLargestStableSlope(const Parameters<double>& parameters) {
  constexpr double kSteepest = 1e6;
  double stable = 0.0;
  double slope = 1.0;
  while (CalcAssistStability(parameters, slope).growth <= 0.0) {
    stable = slope;
    slope *= 1.1;
    if (slope > kSteepest) return std::numeric_limits<double>::infinity();
  }
  double unstable = slope;
  while (unstable - stable > 1e-6 * unstable) {
    const double middle = 0.5 * (stable + unstable);
    (CalcAssistStability(parameters, middle).growth <= 0.0 ? stable : unstable) = middle;
  }
  return stable;
}

double CalcSteepestChord(const Curve<double>& curve) {
  double slope = 0.0;
  for (int i = 1; i < curve.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    slope = std::max(slope, (curve.f[k] - curve.f[k - 1]) / (curve.x[k] - curve.x[k - 1]));
  }
  return slope;
}

}  // namespace kingpin::planar
