#include "core/mechanism/jacobian.h"

#include <cmath>

#include "core/mechanism/dynamics.h"
#include "core/mechanism/entries.h"

namespace kingpin::mechanism {

JacobianEvaluator::JacobianEvaluator(const System& system)
    : system_(system),
      w_(system.model),
      q_(system.model.positions),
      v_(system.model.velocities),
      states_(system.states),
      state_rates_(system.states),
      drive_(system.model.rows),
      unit_(system.model.velocities),
      direction_(system.model.positions) {}

// The equations, and in the lanes of q_, v_ and states_ their derivatives for the columns from
// `first` on.
void JacobianEvaluator::Assemble(double time, std::span<const double> y, int first) {
  const Model& model = system_.model;
  const int nq = model.positions, nv = model.velocities, nz = system_.states;
  const int lanes = std::min(kLanes, columns() - first);
  for (int i = 0; i < nq; ++i) q_[i] = Dual8(y[i]);
  for (int i = 0; i < nv; ++i) v_[i] = Dual8(y[nq + i]);
  for (int i = 0; i < nz; ++i) states_[i] = Dual8(y[nq + nv + i]);
  for (int lane = 0; lane < lanes; ++lane) {
    const int column = first + lane;
    if (column < nv) {
      unit_[column] = 1;
      CalcPositionRates(model, y.data(), unit_.data(), direction_.data());
      unit_[column] = 0;
      for (int i = 0; i < nq; ++i) q_[i].d[lane] = direction_[i];
    } else if (column < 2 * nv) {
      v_[column - nv].d[lane] = 1;
    } else {
      states_[column - 2 * nv].d[lane] = 1;
    }
  }
  UpdatePositions(model, q_.data(), w_);
  UpdateVelocities(model, v_.data(), w_);
  UpdateClosures(model, w_);
  std::fill(w_.f.begin(), w_.f.end(), Wrench<Dual8>{});
  std::fill(w_.generalised.begin(), w_.generalised.end(), Dual8(0.0));
  for (size_t g = 0; g < system_.forces.size(); ++g) {
    const int state = system_.first_state[g];
    system_.forces[g]->AddForces(ForceContext<Dual8>{model, Dual8(time), q_.data(), v_.data(),
                                                     states_.data() + state,
                                                     state_rates_.data() + state, w_});
  }
  AssembleEquations(model, drive_.data(), w_);
}

// Where the order of elimination meets a small pivot although the equations are regular: K x = b
// and K δx = δb - δK x, dense. Into w_.x.
bool JacobianEvaluator::SolveDensely() {
  const math::SparseLdltPattern& pattern = system_.model.pattern;
  const int n = system_.model.unknowns();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), right(n, 1 + kLanes);
  const auto entries = ListEntries(system_.model);
  for (const auto& [i, j] : entries) K(i, j) = K(j, i) = w_.k[pattern.GetSlot(i, j)].v;
  for (int i = 0; i < n; ++i) {
    K(i, i) = w_.k[pattern.position(i)].v;  // -1 of rows that are out
    const Dual8& b = w_.k[pattern.GetRightSideSlot(i)];
    right(i, 0) = b.v;
    for (int lane = 0; lane < kLanes; ++lane) right(i, 1 + lane) = b.d[lane];
  }
  // rows and columns of about unit size, so that a rank can be told
  Eigen::VectorXd scale(n);
  for (int i = 0; i < n; ++i) {
    const double largest = K.row(i).cwiseAbs().maxCoeff();
    if (!(largest > 0)) return false;
    scale[i] = 1 / std::sqrt(largest);
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(scale.asDiagonal() * K * scale.asDiagonal());
  if (!lu.isInvertible()) return false;
  const auto solve = [&](const auto& b) -> Eigen::MatrixXd {
    return scale.asDiagonal() * lu.solve(Eigen::MatrixXd(scale.asDiagonal() * b));
  };
  const Eigen::VectorXd x = solve(right.col(0));
  for (const auto& [i, j] : entries) {
    const Dual8& k = w_.k[pattern.GetSlot(i, j)];
    for (int lane = 0; lane < kLanes; ++lane) {
      right(i, 1 + lane) -= k.d[lane] * x[j];
      if (i != j) right(j, 1 + lane) -= k.d[lane] * x[i];
    }
  }
  const Eigen::MatrixXd dx = solve(right.rightCols(kLanes));
  for (int i = 0; i < n; ++i) {
    Dual8& to = w_.x[pattern.position(i)];
    to.v = x[i];
    for (int lane = 0; lane < kLanes; ++lane) to.d[lane] = dx(i, lane);
  }
  return true;
}

bool JacobianEvaluator::Calc(double time, std::span<const double> y, std::span<const double> active,
                             Eigen::Ref<Eigen::MatrixXd> jacobian, Eigen::MatrixXd* reactions) {
  const Model& model = system_.model;
  const int nv = model.velocities, nz = system_.states;
  for (int r = 0; r < model.rows; ++r) {
    w_.active[r] = active[r];
    const bool driven = r < static_cast<int>(system_.drives.size()) && system_.drives[r];
    drive_[r] = driven ? system_.drives[r](time)[2] : 0.0;
  }
  for (int first = 0; first < columns(); first += kLanes) {
    const int lanes = std::min(kLanes, columns() - first);
    Assemble(time, y, first);
    model.pattern.Factorise(w_.k.data());
    if (PivotsAreSafe(model, w_)) {
      model.pattern.BackSubstitute(w_.k.data(), w_.x.data());
    } else {
      Assemble(time, y, first);
      if (!SolveDensely()) return false;
    }
    for (int lane = 0; lane < lanes; ++lane) {
      for (int i = 0; i < nv; ++i) {
        jacobian(i, first + lane) = w_.x[model.pattern.position(i)].d[lane];
      }
      for (int r = 0; reactions != nullptr && r < model.rows; ++r) {
        const bool acts = active[r] != 0 && !model.redundant[r];
        (*reactions)(r, first + lane) =
            acts ? -w_.x[model.pattern.position(model.coordinates + r)].d[lane] : 0.0;
      }
      for (int i = 0; i < nz; ++i) jacobian(nv + i, first + lane) = state_rates_[i].d[lane];
    }
  }
  return jacobian.allFinite();
}

}  // namespace kingpin::mechanism
