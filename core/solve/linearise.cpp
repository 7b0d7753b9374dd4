#include "core/solve/linearise.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/mechanism/dynamics.h"
#include "core/mechanism/evaluator.h"
#include "core/mechanism/jacobian.h"
#include "core/mechanism/project.h"
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

  Linearisation linear;
  linear.position_basis = CalcNullSpace(model, q, Rows::kHolonomic);
  linear.velocity_basis = CalcNullSpace(model, q, Rows::kAll);
  linear.positions = static_cast<int>(linear.position_basis.cols());
  linear.velocities = static_cast<int>(linear.velocity_basis.cols());
  linear.states = nz;
  const Eigen::MatrixXd &Tq = linear.position_basis, &Tv = linear.velocity_basis;

  // δv = T_v η + E ξ keeps Dᵀ v = ṡ as the position moves
  Eigen::MatrixXd E = Eigen::MatrixXd::Zero(nv, linear.positions);
  if (model.rows > 0 && linear.positions > 0) {
    Eigen::MatrixXd Dt = mechanism::CalcEquationMatrix(model, q).bottomLeftCorner(model.rows, nv);
    Eigen::MatrixXd turned = CalcRateDerivatives(model, q.data(), v.data());
    for (int r = 0; r < model.rows; ++r) {
      if (!model.switching[r]) continue;
      Dt.row(r).setZero();
      turned.row(r).setZero();
    }
    E = -Dt.completeOrthogonalDecomposition().solve(turned * Tq);
  }
  const int np = linear.positions, nu = linear.velocities;
  linear.A = Eigen::MatrixXd::Zero(np + nu + nz, np + nu + nz);
  const auto a_u = jacobian.leftCols(nv);
  const auto a_v = jacobian.middleCols(nv, nv);
  const auto a_z = jacobian.rightCols(nz);
  linear.A.topLeftCorner(np, np) = Tq.transpose() * (E + CalcTurning(model, v.data()) * Tq);
  linear.A.block(0, np, np, nu) = Tq.transpose() * Tv;
  linear.A.block(np, 0, nu, np) = Tv.transpose() * (a_u.topRows(nv) * Tq + a_v.topRows(nv) * E);
  linear.A.block(np, np, nu, nu) = Tv.transpose() * a_v.topRows(nv) * Tv;
  linear.A.block(np, np + nu, nu, nz) = Tv.transpose() * a_z.topRows(nv);
  linear.A.block(np + nu, 0, nz, np) = a_u.bottomRows(nz) * Tq + a_v.bottomRows(nz) * E;
  linear.A.block(np + nu, np, nz, nu) = a_v.bottomRows(nz) * Tv;
  linear.A.block(np + nu, np + nu, nz, nz) = a_z.bottomRows(nz);

  const int n = np + nu + nz;
  linear.displacement = linear.rate = Eigen::MatrixXd::Zero(nv, n);
  linear.displacement.leftCols(np) = Tq;
  linear.rate.leftCols(np) = E;
  linear.rate.middleCols(np, nu) = Tv;
  const auto expand = [&](const auto& all) {
    Eigen::MatrixXd result(all.rows(), n);
    result.leftCols(np) = all.leftCols(nv) * Tq + all.middleCols(nv, nv) * E;
    result.middleCols(np, nu) = all.middleCols(nv, nv) * Tv;
    result.rightCols(nz) = all.rightCols(nz);
    return result;
  };
  linear.acceleration = expand(jacobian.topRows(nv));
  linear.reaction = expand(reactions);
  return linear;
}

Eigen::VectorXd MakeInputColumn(const Linearisation& linear,
                                const Eigen::Ref<const Eigen::VectorXd>& acceleration) {
  Eigen::VectorXd column = Eigen::VectorXd::Zero(linear.A.rows());
  column.segment(linear.positions, linear.velocities) =
      linear.velocity_basis.transpose() * acceleration;
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

std::vector<Mode> CalcModes(const Linearisation& linear) {
  if (linear.A.rows() == 0) return {};  // driven throughout
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(linear.A);
  std::vector<Mode> modes;
  for (int k = 0; k < linear.A.rows(); ++k) {
    Mode mode;
    mode.eigenvalue = solver.eigenvalues()[k];
    if (mode.eigenvalue.imag() < 0) continue;
    const double size = std::abs(mode.eigenvalue);
    if (mode.eigenvalue.imag() > 0) mode.frequency = size / (2 * std::numbers::pi);
    mode.damping_ratio = size > 0 ? -mode.eigenvalue.real() / size : 0;
    mode.shape = linear.position_basis.cast<std::complex<double>>() *
                 solver.eigenvectors().col(k).head(linear.positions);
    if (mode.shape.size() > 0) {
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
