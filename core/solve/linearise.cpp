#include "core/solve/linearise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/mechanism/dynamics.h"
#include "core/mechanism/evaluator.h"
#include "core/mechanism/jacobian.h"
#include "core/solve/null_space.h"

namespace kingpin::solve {

namespace {

using mechanism::Dual8;
using mechanism::Model;

// u̇ = δv + C u: how an offset of the position, in directions fixed in the links, changes at
// velocity v. For coordinates that are numbers C = 0; turns θ about body axes: θ̇ = δω - ω × θ;
// body-axis translations: u̇ = δv + θ × v - ω × u.
Eigen::MatrixXd CalcTurning(const Model& model, const double* v) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(model.velocities, model.velocities);
  const auto skew = [](const double* a) {
    Eigen::Matrix3d s;
    s << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
    return s;
  };
  for (size_t l = 1; l < model.links.size(); ++l) {
    const mechanism::Link& link = model.links[l];
    if (link.kind == mechanism::JointKind::kSpherical) {
      C.block<3, 3>(link.v, link.v) = -skew(v + link.v);
    } else if (link.kind == mechanism::JointKind::kFree) {
      C.block<3, 3>(link.v, link.v) = -skew(v + link.v + 3);
      C.block<3, 3>(link.v + 3, link.v + 3) = -skew(v + link.v + 3);
      C.block<3, 3>(link.v, link.v + 3) = -skew(v + link.v);
    }
  }
  return C;
}

// ∂(Dᵀ v)/∂u at fixed v.
Eigen::MatrixXd CalcRateDerivatives(const Model& model, const double* q, const double* v) {
  constexpr int kLanes = 8;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(model.rows, model.velocities);
  mechanism::Workspace<Dual8> w(model);
  std::vector<Dual8> qd(model.positions), vd(model.velocities);
  std::vector<double> unit(model.velocities, 0.0), direction(model.positions);
  for (int i = 0; i < model.velocities; ++i) vd[i] = Dual8(v[i]);
  for (int first = 0; first < model.velocities; first += kLanes) {
    const int lanes = std::min(kLanes, model.velocities - first);
    for (int i = 0; i < model.positions; ++i) qd[i] = Dual8(q[i]);
    for (int lane = 0; lane < lanes; ++lane) {
      unit[first + lane] = 1;
      CalcPositionRates(model, q, unit.data(), direction.data());
      unit[first + lane] = 0;
      for (int i = 0; i < model.positions; ++i) qd[i].d[lane] = direction[i];
    }
    UpdatePositions(model, qd.data(), w);
    UpdateVelocities(model, vd.data(), w);
    UpdateClosures(model, w);
    for (int r = 0; r < model.rows; ++r) {
      Dual8 rate(0.0);
      for (int s = model.support_begin[r]; s < model.support_begin[r + 1]; ++s) {
        const Model::Support& support = model.supports[s];
        rate = rate + (Dual8(support.sign) * Dot(w.axes[support.dof], w.W[r])) * vd[support.dof];
      }
      for (int lane = 0; lane < lanes; ++lane) result(r, first + lane) = rate.d[lane];
    }
  }
  return result;
}

}  // namespace

Linearisation Linearise(const mechanism::System& system, double time, std::span<const double> y) {
  const Model& model = system.model;
  const int nq = model.positions, nv = model.velocities, nz = system.states;
  const std::span<const double> q(y.data(), nq), v(y.data() + nq, nv);
  mechanism::Evaluator evaluator(system);
  evaluator.ReleaseFriction();
  mechanism::JacobianEvaluator derivatives(system);
  Eigen::MatrixXd jacobian(derivatives.rows(), derivatives.columns());
  Eigen::MatrixXd reactions(model.rows, derivatives.columns());
  if (!derivatives.Calc(time, y, evaluator.workspace().active, jacobian, &reactions)) {
    throw std::runtime_error(
        "the mechanism is in a singular position, about which it has no linearisation");
  }

  const NullSpace free_positions = CalcNullSpace(model, q, Rows::kHolonomic);
  const NullSpace free_velocities = CalcNullSpace(model, q, Rows::kAll);
  Linearisation linear;
  linear.position_basis = free_positions.basis;
  linear.velocity_basis = free_velocities.basis;
  linear.velocity_inverse = free_velocities.inverse;
  const int np = linear.positions = free_positions.freedoms();
  const int nu = linear.velocities = free_velocities.freedoms();
  linear.states = nz;
  const int n = np + nu + nz;
  linear.A = Eigen::MatrixXd::Zero(n, n);
  linear.displacement = linear.rate = linear.acceleration = Eigen::MatrixXd::Zero(nv, n);
  linear.reaction = Eigen::MatrixXd::Zero(model.rows, n);
  if (n == 0) return linear;  // driven throughout
  const Eigen::MatrixXd &Tq = linear.position_basis, &Tv = linear.velocity_basis;
  const Eigen::MatrixXd &Sq = free_positions.inverse, &Sv = linear.velocity_inverse;

  // δv = T_v η + E ξ keeps Dᵀ v = ṡ as the position moves
  Eigen::MatrixXd E = Eigen::MatrixXd::Zero(nv, np);
  if (model.rows > 0 && np > 0) {
    const Eigen::MatrixXd turned = CalcRateDerivatives(model, q.data(), v.data()) * Tq;
    E = -CalcLeastMotion(model, q, turned);
  }
  const auto a_u = jacobian.leftCols(nv);
  const auto a_v = jacobian.middleCols(nv, nv);
  const auto a_z = jacobian.rightCols(nz);
  // no empty matrix is taken apart
  if (np > 0) {
    linear.A.topLeftCorner(np, np) = Sq * (E + CalcTurning(model, v.data()) * Tq);
    linear.displacement.leftCols(np) = Tq;
    linear.rate.leftCols(np) = E;
  }
  if (nu > 0) {  // np > 0, too: velocities meet the holonomic rows
    linear.A.block(0, np, np, nu) = Sq * Tv;
    linear.A.block(np, 0, nu, np) = Sv * (a_u.topRows(nv) * Tq + a_v.topRows(nv) * E);
    linear.A.block(np, np, nu, nu) = Sv * a_v.topRows(nv) * Tv;
    linear.rate.middleCols(np, nu) = Tv;
  }
  if (nz > 0) {
    if (nu > 0) {
      linear.A.block(np, np + nu, nu, nz) = Sv * a_z.topRows(nv);
      linear.A.block(np + nu, np, nz, nu) = a_v.bottomRows(nz) * Tv;
    }
    if (np > 0)
      linear.A.block(np + nu, 0, nz, np) = a_u.bottomRows(nz) * Tq + a_v.bottomRows(nz) * E;
    linear.A.bottomRightCorner(nz, nz) = a_z.bottomRows(nz);
  }
  const auto expand = [&](const auto& all, Eigen::MatrixXd& result) {
    if (all.rows() == 0) return;
    if (np > 0) result.leftCols(np) = all.leftCols(nv) * Tq + all.middleCols(nv, nv) * E;
    if (nu > 0) result.middleCols(np, nu) = all.middleCols(nv, nv) * Tv;
    if (nz > 0) result.rightCols(nz) = all.rightCols(nz);
  };
  expand(jacobian.topRows(nv), linear.acceleration);
  expand(reactions, linear.reaction);
  return linear;
}

Eigen::VectorXd MakeInputColumn(const Linearisation& linear,
                                const Eigen::Ref<const Eigen::VectorXd>& acceleration) {
  Eigen::VectorXd column = Eigen::VectorXd::Zero(linear.A.rows());
  column.segment(linear.positions, linear.velocities) = linear.velocity_inverse * acceleration;
  return column;
}

std::vector<std::complex<double>> CalcFrequencyResponse(const Eigen::MatrixXd& A,
                                                        const Eigen::VectorXd& B,
                                                        const Eigen::RowVectorXd& C, double D,
                                                        std::span<const double> frequencies) {
  std::vector<std::complex<double>> response;
  response.reserve(frequencies.size());
  // one Hessenberg form A = Q H Qᵀ for all frequencies would save a factor of n; sizes are small
  const Eigen::VectorXcd right = B.cast<std::complex<double>>();
  for (double frequency : frequencies) {
    Eigen::MatrixXcd system = -A.cast<std::complex<double>>();
    system.diagonal().array() += std::complex<double>(0, 2 * std::numbers::pi * frequency);
    const Eigen::VectorXcd x = system.partialPivLu().solve(right);
    response.push_back((C.cast<std::complex<double>>() * x).value() + D);
  }
  return response;
}

namespace {

// The state (ξ, η, z) in coordinates in which each vibration is (ω ξ', η'): A then has entries
// ±ω in place of 1 and ω², which lie orders of magnitude apart in stiff mechanisms and cost as many
// digits of the slow modes.
struct ModalForm {
  Eigen::MatrixXd A;
  Eigen::MatrixXd positions;  ///< ξ per ξ'
};

// With η̇ = -K ξ + ..., K symmetric (forces that have a potential, at rest) and K = V Ω² Vᵀ:
// ξ = V Ω⁻¹ ξ', η = V η', A = [0, Ω; -Ω, ...]. Without damping it is skew: its eigenvalues are as
// exact as the largest is rounded, and none seems to grow. What is not symmetric of K is kept as it
// is, unless it is rounding.
ModalForm CalcModalForm(const Linearisation& linear) {
  const int n = linear.positions, nz = linear.states;
  const auto K = -linear.A.block(n, 0, n, n);
  const Eigen::MatrixXd symmetric = 0.5 * (K + K.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  const Eigen::MatrixXd& V = solver.eigenvectors();
  const Eigen::VectorXd& squares = solver.eigenvalues();
  const double largest = squares.cwiseAbs().maxCoeff();
  const double rounding = n * std::numeric_limits<double>::epsilon() * largest;
  const Eigen::VectorXd omega =
      (largest > 0 ? squares.cwiseAbs().cwiseMax(rounding) : Eigen::VectorXd::Ones(n).eval())
          .cwiseSqrt();
  Eigen::MatrixXd skew = K - symmetric;
  if (skew.cwiseAbs().maxCoeff() <= rounding) skew.setZero();

  const int nx = 2 * n + nz;
  Eigen::MatrixXd from = Eigen::MatrixXd::Identity(nx, nx), to = from;
  from.topLeftCorner(n, n) = V * omega.cwiseInverse().asDiagonal();
  to.topLeftCorner(n, n) = omega.asDiagonal() * V.transpose();
  from.block(n, n, n, n) = V;
  to.block(n, n, n, n) = V.transpose();
  ModalForm form;
  Eigen::MatrixXd rest = linear.A;
  rest.block(0, n, n, n) -= Eigen::MatrixXd::Identity(n, n);
  rest.block(n, 0, n, n) = -skew;
  form.A = to * rest * from;
  for (int i = 0; i < n; ++i) {
    form.A(i, n + i) += omega[i];
    form.A(n + i, i) -= squares[i] / omega[i];
  }
  form.positions = from.topLeftCorner(n, n);
  return form;
}

}  // namespace

std::vector<Mode> CalcModes(const Linearisation& linear) {
  if (linear.A.rows() == 0) return {};  // driven throughout
  const int np = linear.positions;
  const ModalForm form = np > 0 && np == linear.velocities
                             ? CalcModalForm(linear)
                             : ModalForm{linear.A, Eigen::MatrixXd::Identity(np, np)};
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(form.A);
  const Eigen::MatrixXcd vectors = solver.eigenvectors();
  Eigen::MatrixXcd shapes;
  if (np > 0) shapes = (linear.position_basis * form.positions).cast<std::complex<double>>();
  std::vector<Mode> modes;
  for (int k = 0; k < form.A.rows(); ++k) {
    Mode mode;
    mode.eigenvalue = solver.eigenvalues()[k];
    if (mode.eigenvalue.imag() < 0) continue;
    const double size = std::abs(mode.eigenvalue);
    if (mode.eigenvalue.imag() > 0) mode.frequency = size / (2 * std::numbers::pi);
    mode.damping_ratio = size > 0 ? -mode.eigenvalue.real() / size : 0;
    mode.shape = Eigen::VectorXcd::Zero(linear.position_basis.rows());
    if (np > 0) {
      mode.shape = shapes * vectors.col(k).head(np);
      int largest = 0;
      mode.shape.cwiseAbs().maxCoeff(&largest);
      if (std::abs(mode.shape[largest]) > 0) mode.shape /= mode.shape[largest];
    }
    modes.push_back(std::move(mode));
  }
  std::sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) {
    const bool pair_a = a.eigenvalue.imag() > 0, pair_b = b.eigenvalue.imag() > 0;
    if (pair_a != pair_b) return pair_a;
    return pair_a ? a.frequency < b.frequency : a.eigenvalue.real() < b.eigenvalue.real();
  });
  return modes;
}

}  // namespace kingpin::solve
