#include "core/mechanism/evaluator.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "core/mechanism/accelerations.h"
#include "core/mechanism/project.h"

namespace kingpin::mechanism {

Evaluator::Evaluator(const System& system)
    : system_(system),
      w_(system.model),
      drive_(system.model.rows),
      drive_rate_(system.model.rows),
      drive_acceleration_(system.model.rows),
      acceleration_(system.model.velocities),
      reaction_(system.model.rows),
      residual_(system.model.rows),
      correction_(system.model.velocities),
      none_(system.model.rows) {}

void Evaluator::UpdateDrives(double time) {
  for (size_t r = 0; r < system_.drives.size(); ++r) {
    if (!system_.drives[r]) continue;
    const std::array<double, 3> s = system_.drives[r](time);
    drive_[r] = s[0], drive_rate_[r] = s[1], drive_acceleration_[r] = s[2];
  }
}

void Evaluator::UpdateKinematics(double time, std::span<const double> y) {
  const Model& model = system_.model;
  UpdateDrives(time);
  UpdatePositions(model, y.data(), w_);
  UpdateVelocities(model, y.data() + model.positions, w_);
  UpdateClosures(model, w_);
}

void Evaluator::CalcRates(double time, std::span<const double> y, std::span<double> rate) {
  const Model& model = system_.model;
  const double* q = y.data();
  const double* v = q + model.positions;
  const double* states = v + model.velocities;
  double* state_rates = rate.data() + model.positions + model.velocities;
  UpdateKinematics(time, y);
  std::fill(w_.f.begin(), w_.f.end(), Wrench<double>{});
  std::fill(w_.generalised.begin(), w_.generalised.end(), 0.0);
  for (size_t g = 0; g < system_.forces.size(); ++g) {
    const int first = system_.first_state[g];
    system_.forces[g]->AddForces(
        ForceContext<double>{model, time, q, v, states + first, state_rates + first, w_});
  }
  SolveAccelerations(model, drive_acceleration_, w_, acceleration_, reaction_);
  CalcPositionRates(model, q, v, rate.data());
  std::copy(acceleration_.begin(), acceleration_.end(), rate.begin() + model.positions);
}

double Evaluator::CalcPositionResiduals(const double* q) {
  const Model& model = system_.model;
  std::copy(w_.residual.begin(), w_.residual.end(), residual_.begin());
  for (const LinearRow& row : model.linear) {
    double sum = row.rate_only ? 0.0 : -drive_[row.row];
    if (!row.rate_only) {
      for (const LinearRow::Term& term : row.terms) sum += term.factor * q[term.q];
    }
    residual_[row.row] = sum;
  }
  double largest = 0;
  for (double x : residual_) largest = std::max(largest, std::abs(x));
  return largest;
}

double Evaluator::CalcVelocityResiduals(const double* v) {
  const Model& model = system_.model;
  for (int r = 0; r < model.rows; ++r) {
    double sum = -drive_rate_[r];
    for (int s = model.support_begin[r]; s < model.support_begin[r + 1]; ++s) {
      const Model::Support& support = model.supports[s];
      sum += support.sign * Dot(w_.axes[support.dof], w_.W[r]) * v[support.dof];
    }
    residual_[r] = sum;
  }
  for (const LinearRow& row : model.linear) {
    for (const LinearRow::Term& term : row.terms) residual_[row.row] += term.factor * v[term.v];
  }
  double largest = 0;
  for (double x : residual_) largest = std::max(largest, std::abs(x));
  return largest;
}

Evaluator::Residuals Evaluator::CalcResiduals(double time, std::span<const double> y) {
  UpdateKinematics(time, y);
  Residuals residuals;
  residuals.position = CalcPositionResiduals(y.data());
  residuals.velocity = CalcVelocityResiduals(y.data() + system_.model.positions);
  return residuals;
}

int Evaluator::FindWorstRow() const {
  int worst = 0;
  for (int r = 1; r < system_.model.rows; ++r) {
    if (!(std::abs(residual_[r]) <= std::abs(residual_[worst]))) worst = r;
  }
  return worst;
}

// The correction of least kinetic energy: [M, D; Dᵀ, 0] [δ; ·] = [0; -residual].
void Evaluator::SolveForCorrection() {
  const Model& model = system_.model;
  std::fill(w_.f.begin(), w_.f.end(), Wrench<double>{});
  AssembleEquations(model, none_.data(), w_);
  for (int i = 0; i < model.velocities; ++i) w_.k[model.pattern.GetRightSideSlot(i)] = 0;
  for (int r = 0; r < model.rows; ++r) {
    w_.k[model.pattern.GetRightSideSlot(model.velocities + r)] = -w_.active[r] * residual_[r];
  }
  FactoriseAndSolve(model, w_, correction_, reaction_);
}

void Evaluator::Project(double time, std::span<double> y, double tolerance) {
  const Model& model = system_.model;
  constexpr int kIterations = 20;
  double* q = y.data();
  double* v = q + model.positions;
  NormaliseQuaternions(model, {q, static_cast<size_t>(model.positions)});
  if (model.rows == 0) return;
  UpdateKinematics(time, y);
  for (int iteration = 0; CalcPositionResiduals(q) > tolerance; ++iteration) {
    if (iteration == kIterations) {
      const int worst = FindWorstRow();
      throw std::runtime_error(fmt::format(
          "the constraints cannot be met to {:g} at t = {:g} s: '{}' stays open by {:g}", tolerance,
          time, model.row_names[worst], residual_[worst]));
    }
    SolveForCorrection();
    MovePositions(model, correction_, {q, static_cast<size_t>(model.positions)});
    UpdateKinematics(time, y);
  }
  if (CalcVelocityResiduals(v) > tolerance) {
    SolveForCorrection();
    for (int i = 0; i < model.velocities; ++i) v[i] += correction_[i];
  }
}

Energy Evaluator::CalcEnergy(double time, std::span<const double> y) {
  const Model& model = system_.model;
  const double* q = y.data();
  const double* v = q + model.positions;
  const double* states = v + model.velocities;
  Energy energy;
  UpdateKinematics(time, y);
  for (size_t l = 1; l < model.links.size(); ++l) {
    const Link& link = model.links[l];
    if (link.mass == 0) continue;
    const auto I =
        math::MakeInertia(link.mass, link.centre, link.central_inertia, w_.R[l], w_.p[l]);
    energy.kinetic += 0.5 * Dot(w_.V[l], I * w_.V[l]);
    energy.potential -= Dot(model.gravity, I.h + link.mass * w_.reference);
  }
  for (size_t g = 0; g < system_.forces.size(); ++g) {
    const EnergyRates rates = system_.forces[g]->CalcEnergy(
        ForceContext<double>{model, time, q, v, states + system_.first_state[g], nullptr, w_});
    energy.potential += rates.potential;
    energy.dissipated += rates.dissipated;
    energy.supplied += rates.supplied;
  }
  // a driven row works with its reaction along its rate
  for (int r = 0; r < model.rows; ++r) energy.supplied += reaction_[r] * drive_rate_[r];
  return energy;
}

}  // namespace kingpin::mechanism
