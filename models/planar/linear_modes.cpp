#include "models/planar/linear_modes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/io/error.h"

namespace kingpin::planar {
namespace {

using Complex = std::complex<double>;

// |R(hλ)| of the classical Runge-Kutta method.
double CalcRk4Growth(Complex z) {
  return std::abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0))));
}

// Largest h with |R(hλ)| <= 1, for a decaying λ. The region is star-shaped enough along rays of
// the left half plane for bisection: |hλ| <= 2.5 is inside, |hλ| >= 3.5 outside.
double CalcRk4Limit(Complex eigenvalue) {
  const double size = std::abs(eigenvalue);
  if (size == 0.0 || eigenvalue.real() > 0.0) return std::numeric_limits<double>::infinity();
  double inside = 2.0 / size;
  double outside = 3.5 / size;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (CalcRk4Growth(middle * eigenvalue) <= 1.0 + 1e-13 ? inside : outside) = middle;
  }
  return inside;
}

struct ZeroEigenvalues {
  int modes = 0;      // dimension of the null space of A
  int algebraic = 0;  // how often zero is an eigenvalue
};

// Zero eigenvalues by rank, not by size: a Jordan block of them comes out of the iteration as a
// pair of size sqrt(ε) |λ|max. With bases Z and L of the right and left null spaces, every Jordan
// block longer than one takes away one rank of Lᵀ Z.
ZeroEigenvalues CountZeros(const LinearModel& model, double rate) {
  Eigen::MatrixXd scaled = model.a;  // velocities measured in units of rate times coordinate
  scaled.middleRows(model.coordinates, model.coordinates) /= rate;
  scaled.middleCols(model.coordinates, model.coordinates) *= rate;
  Eigen::VectorXd inverse_norm = scaled.colwise().norm().cwiseInverse().transpose();
  for (double& x : inverse_norm) {
    if (!std::isfinite(x)) x = 1.0;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled * inverse_norm.asDiagonal(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const auto& values = svd.singularValues();
  ZeroEigenvalues zeros;
  zeros.modes = static_cast<int>((values.array() <= 1e-12 * values(0)).count());
  if (zeros.modes == 0) return zeros;
  Eigen::MatrixXd right = inverse_norm.asDiagonal() * svd.matrixV().rightCols(zeros.modes);
  right.colwise().normalize();
  const Eigen::MatrixXd product = svd.matrixU().rightCols(zeros.modes).transpose() * right;
  const Eigen::VectorXd overlap = product.jacobiSvd().singularValues();
  zeros.algebraic = zeros.modes + static_cast<int>((overlap.array() < 1e-12).count());
  return zeros;
}

}  // namespace

std::string_view ToString(ModeKind kind) {
  switch (kind) {
    case ModeKind::kDrift:
      return "drift";
    case ModeKind::kOscillatory:
      return "oscillatory";
    case ModeKind::kOverdamped:
      return "overdamped";
    case ModeKind::kLag:
      return "lag";
  }
  return "";
}

Modes CalcModes(const LinearModel& model) {
  if (!model.a.allFinite()) {
    throw io::RunError("modes: the state matrix holds numbers that are not finite");
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(model.a);
  if (solver.info() != Eigen::Success) {
    throw io::RunError("modes: the eigenvalue iteration did not converge");
  }
  const auto& values = solver.eigenvalues();
  const Eigen::Index mechanical = 2 * static_cast<Eigen::Index>(model.coordinates);
  Modes result;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    result.fastest_rate = std::max(result.fastest_rate, std::abs(values(i)));
  }

  ZeroEigenvalues zeros;
  if (result.fastest_rate > 0.0) zeros = CountZeros(model, result.fastest_rate);
  std::vector<double> sizes;
  for (const Complex& value : values) sizes.push_back(std::abs(value));
  std::sort(sizes.begin(), sizes.end());
  const double drift_size =
      zeros.algebraic > 0 ? sizes[static_cast<std::size_t>(zeros.algebraic) - 1] : -1.0;

  const double rounding = 16 * std::numeric_limits<double>::epsilon() * model.a.norm();
  result.rk4_step_limit = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    Complex value = values(i);
    const bool drift = std::abs(value) <= drift_size;
    if (drift) value = 0.0;
    // An undamped mode comes out of the iteration with a real part of either sign.
    if (value.imag() != 0.0 && std::abs(value.real()) <= rounding) value.real(0.0);
    if (value.imag() < 0.0) continue;  // the other one of a pair
    if (value.real() > 0.0) result.stable = false;
    result.rk4_step_limit = std::min(result.rk4_step_limit, CalcRk4Limit(value));

    Mode mode;
    mode.eigenvalue = value;
    mode.frequency = std::abs(value) / (2.0 * std::numbers::pi);
    mode.damped_frequency = value.imag() / (2.0 * std::numbers::pi);
    mode.damping_ratio = drift || value.real() == 0.0 ? 0.0 : -value.real() / std::abs(value);
    mode.time_constant = drift || value.real() == 0.0 ? 0.0 : -1.0 / value.real();

    Eigen::VectorXcd shape = solver.eigenvectors().col(i);
    double total = 0.0;
    std::array<double, 5> energy{};
    for (int k = 0; k < model.coordinates; ++k) {
      energy[static_cast<std::size_t>(k)] =
          model.mass[static_cast<std::size_t>(k)] * std::norm(shape(k));
      total += energy[static_cast<std::size_t>(k)];
    }
    mode.dominant =
        static_cast<int>(std::max_element(energy.begin(), energy.end()) - energy.begin());
    const double coordinates = shape.head(model.coordinates).norm();
    const double extras = shape.tail(model.a.rows() - mechanical).norm();
    if (total > 0.0) {
      const Complex turn = std::conj(shape(mode.dominant)) / std::abs(shape(mode.dominant));
      shape *= turn / std::sqrt(total);
      for (std::size_t k = 0; k < 5; ++k) mode.shares[k] = energy[k] / total;
    }
    mode.shape.assign(shape.begin(), shape.end());

    if (drift) {
      mode.kind = ModeKind::kDrift;
    } else if (value.imag() > 0.0) {
      mode.kind = ModeKind::kOscillatory;
    } else {
      mode.kind = ModeKind::kOverdamped;
      // An extra state's own pole: it moves that state by forces, the coordinates by its response.
      if (model.a.rows() > mechanical && extras > 1e3 * coordinates) {
        for (Eigen::Index k = mechanical; k < model.a.rows(); ++k) {
          if (std::abs(value - model.a(k, k)) < 0.05 * std::abs(value)) mode.kind = ModeKind::kLag;
        }
      }
    }
    result.modes.push_back(std::move(mode));
  }
  std::stable_sort(result.modes.begin(), result.modes.end(), [](const Mode& a, const Mode& b) {
    return std::abs(a.eigenvalue) < std::abs(b.eigenvalue);
  });
  // A double zero is one drift mode.
  const auto drift_end = std::find_if(result.modes.begin(), result.modes.end(),
                                      [](const Mode& m) { return m.kind != ModeKind::kDrift; });
  const auto drifts = static_cast<int>(drift_end - result.modes.begin());
  if (drifts > zeros.modes) {
    result.modes.erase(result.modes.begin() + zeros.modes, drift_end);
  }

  for (Mode& mode : result.modes) {
    const auto index = static_cast<std::size_t>(mode.dominant);
    const std::string who =
        fmt::format("{} ({:.0f} %)", model.coordinate_names[index], 100.0 * mode.shares[index]);
    switch (mode.kind) {
      case ModeKind::kDrift:
        mode.summary = fmt::format("0 Hz, free turning of the steering, {}", who);
        break;
      case ModeKind::kOscillatory:
        mode.summary =
            fmt::format("{:.4g} Hz, {:.3g} %, {}", mode.frequency, 100.0 * mode.damping_ratio, who);
        break;
      case ModeKind::kOverdamped:
        mode.summary = fmt::format("real pole {:.4g} 1/s, {}", mode.eigenvalue.real(), who);
        break;
      case ModeKind::kLag:
        mode.summary = fmt::format("lag, real pole {:.4g} 1/s", mode.eigenvalue.real());
        break;
    }
  }
  return result;
}

}  // namespace kingpin::planar
