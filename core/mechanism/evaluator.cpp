#include "core/mechanism/evaluator.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "core/mechanism/accelerations.h"
#include "core/mechanism/project.h"

namespace kingpin::mechanism {

namespace {

constexpr double kSingularTolerance = 1e-10;  // of constraints near singular positions [m, rad]

}  // namespace

Evaluator::Evaluator(const System& system)
    : system_(system),
      w_(system.model),
      drive_(system.model.rows),
      drive_rate_(system.model.rows),
      drive_acceleration_(system.model.rows),
      modes_(system.friction.size()),
      normal_(system.friction.size()),
      slip_(system.friction.size()),
      applied_(w_.f.size()),
      joint_(system.model.links.size()),
      applied_generalised_(system.model.velocities),
      link_acceleration_(system.model.links.size()),
      acceleration_(system.model.velocities),
      reaction_(system.model.rows),
      residual_(system.model.rows),
      correction_(system.model.velocities),
      none_(system.model.rows),
      nearest_(system.size()),
      mode_rate_(system.size()),
      held_(system.friction.size()),
      held_force_(system.friction.size()),
      normal_now_(system.friction.size()),
      normal_base_(system.friction.size()),
      normal_mismatch_(static_cast<int>(system.friction.size())),
      normal_change_(normal_mismatch_.size()),
      normal_jacobian_(normal_mismatch_.size(), normal_mismatch_.size()),
      normal_lu_(normal_mismatch_.size()),
      box_(static_cast<int>(system.friction.size())),
      moves_(system.friction.size()),
      candidates_(system.friction.size()) {
  for (const Friction& friction : system.friction) {
    size_t index = 0;
    while (system.model.linear[index].row != friction.row) ++index;
    friction_row_.push_back(static_cast<int>(index));
    of_joints_ |= friction.normal_link != 0;
    depends_on_normals_ |= friction.static_coefficient > 0;
  }
  at_rest_.reserve(system.friction.size());
  ReleaseFriction();
}

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
  CalcRatesAt(time, y, rate);
  if (!w_.singular) return;
  // Near a singular position what y leaves open in the constraints, rounding included, enters the
  // accelerations magnified by the inverse cube of the distance to it. On the constraints it is the
  // inverse square, of rounding only.
  std::copy(y.begin(), y.end(), nearest_.begin());
  Project(time, nearest_, kSingularTolerance, 0);
  CalcRatesAt(time, nearest_, rate);
}

void Evaluator::CalcRatesAt(double time, std::span<const double> y, std::span<double> rate) {
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
  for (size_t f = 0; f < modes_.size(); ++f) slip_[f] = CalcSlip(static_cast<int>(f), y);
  try {
    SolveWithFriction();
  } catch (const std::runtime_error&) {
    ThrowIfNotFinite(time, y, rate);
    throw;
  }
  CalcPositionRates(model, q, v, rate.data());
  std::copy(acceleration_.begin(), acceleration_.end(), rate.begin() + model.positions);
  double sum = 0;  // stays zero exactly as long as every number is finite
  for (int i = model.positions; i < system_.size(); ++i) sum += rate[i] - rate[i];
  if (sum != 0 || sum != sum) {
    ThrowIfNotFinite(time, y, rate);
    throw std::runtime_error(
        fmt::format("the accelerations are not finite numbers at t = {:g} s", time));
  }
}

// Says which force or motion is the cause.
void Evaluator::ThrowIfNotFinite(double time, std::span<const double> y, std::span<double> rate) {
  const Model& model = system_.model;
  for (double value : y) {
    if (std::isfinite(value)) continue;
    throw std::runtime_error(fmt::format(
        "positions, velocities or states are not finite numbers at t = {:g} s: the motion grows "
        "beyond all bounds; smaller steps or less stiff forces may help",
        time));
  }
  for (int r = 0; r < model.rows; ++r) {
    if (std::isfinite(drive_[r]) && std::isfinite(drive_rate_[r]) &&
        std::isfinite(drive_acceleration_[r])) {
      continue;
    }
    throw std::runtime_error(
        fmt::format("the motion that '{}' follows is not a finite number at t "
                    "= {:g} s: ({:g}, {:g}, {:g})",
                    model.row_names[r], time, drive_[r], drive_rate_[r], drive_acceleration_[r]));
  }
  for (size_t g = 0; g < system_.forces.size(); ++g) {
    const int first = system_.first_state[g];
    const std::string culprit = system_.forces[g]->FindNotFinite(
        ForceContext<double>{model, time, y.data(), y.data() + model.positions,
                             y.data() + model.positions + model.velocities + first,
                             rate.data() + model.positions + model.velocities + first, w_});
    if (culprit.empty()) continue;
    throw std::runtime_error(
        fmt::format("force {} is not a finite number at t = {:g} s", culprit, time));
  }
}

std::span<const Wrench<double>> Evaluator::CalcJointWrenches() {
  const Model& model = system_.model;
  const int links = static_cast<int>(model.links.size());
  link_acceleration_[0] = w_.A[0];
  joint_[0] = {};
  largest_force_ = 0;
  for (int l = 1; l < links; ++l) {
    const Link& link = model.links[l];
    // A[l] - A[parent] is what the link's own motion adds at zero joint accelerations
    Motion<double> a = link_acceleration_[link.parent] + (w_.A[l] - w_.A[link.parent]);
    for (int i = 0; i < CountVelocities(link.kind); ++i) {
      a = a + acceleration_[link.v + i] * w_.axes[link.v + i];
    }
    link_acceleration_[l] = a;
    joint_[l] = Wrench<double>{} - applied_[l];
    largest_force_ = std::max(largest_force_, CalcNorm(applied_[l].f));
    if (link.mass == 0) continue;
    const auto I =
        math::MakeInertia(link.mass, link.centre, link.central_inertia, w_.R[l], w_.p[l]);
    const Wrench<double> inertial = I * a + Cross(w_.V[l], I * w_.V[l]);
    largest_force_ = std::max(largest_force_, CalcNorm(inertial.f));
    joint_[l] = joint_[l] + inertial;
  }
  const auto react = [&](int a, int b, int row) {
    joint_[a] = joint_[a] - reaction_[row] * w_.W[row];
    joint_[b] = joint_[b] + reaction_[row] * w_.W[row];
  };
  for (const PointClosure& c : model.points) {
    for (int r = 0; r < __builtin_popcount(c.axes); ++r) react(c.a, c.b, c.row + r);
  }
  for (const PerpendicularClosure& c : model.perpendiculars) react(c.a, c.b, c.row);
  for (const DistanceClosure& c : model.distances) react(c.a, c.b, c.row);
  for (const RollingDisc& c : model.discs) {
    for (int r = 0; r < 3; ++r) react(c.a, c.b, c.row + r);
  }
  for (int l = links - 1; l > 0; --l) {
    joint_[model.links[l].parent] = joint_[model.links[l].parent] + joint_[l];
  }
  return joint_;
}

Wrench<double> Evaluator::CalcMomentum() const {
  const Model& model = system_.model;
  Wrench<double> momentum;
  for (size_t l = 1; l < model.links.size(); ++l) {
    const Link& link = model.links[l];
    if (link.mass == 0) continue;
    const auto I =
        math::MakeInertia(link.mass, link.centre, link.central_inertia, w_.R[l], w_.p[l]);
    momentum = momentum + I * w_.V[l];
  }
  return momentum.About(-w_.reference);
}

// The world is what the wrenches of the joints end in: joint_[0] is what the bodies need beyond the
// applied forces, reactions of closures between bodies cancelled.
Wrench<double> Evaluator::CalcExternalWrench() {
  const Model& model = system_.model;
  Wrench<double> external = CalcJointWrenches()[0];
  for (size_t l = 1; l < model.links.size(); ++l) {
    const Link& link = model.links[l];
    const Vector3<double> centre = w_.R[l] * link.centre + w_.p[l];
    external = external + applied_[l] + math::MakeWrench(centre, link.mass * model.gravity);
  }
  return external.About(-w_.reference);
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
  for (size_t f = 0; f < modes_.size(); ++f) {
    if (!held_[f]) residual_[system_.friction[f].row] = 0;
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
  for (int i = 0; i < model.coordinates; ++i) w_.k[model.pattern.GetRightSideSlot(i)] = 0;
  for (int r = 0; r < model.rows; ++r) {
    w_.k[model.pattern.GetRightSideSlot(model.coordinates + r)] = -w_.active[r] * residual_[r];
  }
  FactoriseAndSolve(model, w_, correction_, reaction_);
}

void Evaluator::Project(double time, std::span<double> y, double position_tolerance,
                        double velocity_tolerance) {
  const Model& model = system_.model;
  const std::span<double> q = y.first(model.positions), v = y.subspan(q.size(), model.velocities);
  NormaliseQuaternions(model, q);
  if (model.rows == 0) return;
  UpdateKinematics(time, y);
  // Friction that sticks has no position to keep; it must not stand in the way of the closures.
  SetHeldRows(0);
  try {
    ProjectPositions(time, y, position_tolerance);
  } catch (const std::runtime_error&) {
    SetHeldRows(1);
    throw;
  }
  SetHeldRows(1);
  if (CalcVelocityResiduals(v.data()) > velocity_tolerance) {
    SolveForCorrection();
    for (int i = 0; i < model.velocities; ++i) v[i] += correction_[i];
  }
}

void Evaluator::ProjectPositions(double time, std::span<double> y, double tolerance) {
  constexpr int kIterations = 20;
  // Below this nothing is gained. Above it one correction is made even if the tolerance is met:
  // near a singular position, what is left open grows with the inverse square of the distance to
  // it, and would carry the mechanism onto another branch.
  constexpr double kRounding = 1e-15;
  const std::span<double> q = y.first(system_.model.positions);
  for (int iteration = 0; CalcPositionResiduals(q.data()) >
                          (iteration == 0 ? std::min(kRounding, tolerance) : tolerance);
       ++iteration) {
    if (iteration == kIterations) {
      const int worst = FindWorstRow();
      throw std::runtime_error(fmt::format(
          "the constraints cannot be met to {:g} at t = {:g} s: '{}' stays open by {:g}", tolerance,
          time, system_.model.row_names[worst], residual_[worst]));
    }
    SolveForCorrection();
    MovePositions(system_.model, correction_, q);
    UpdateKinematics(time, y);
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
  for (size_t f = 0; f < modes_.size(); ++f) {
    if (modes_[f] == 0) continue;
    const double slip = CalcSlip(static_cast<int>(f), y);
    energy.dissipated += CalcKineticLimit(system_.friction[f], normal_[f], slip) * std::abs(slip);
  }
  // A driven row works with its reaction along its rate; so does a moving counterpart on what rubs
  // against it.
  for (int r = 0; r < model.rows; ++r) energy.supplied += reaction_[r] * drive_rate_[r];
  return energy;
}

}  // namespace kingpin::mechanism
