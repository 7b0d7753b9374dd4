#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/mechanism/accelerations.h"
#include "core/mechanism/evaluator.h"

// Dry friction: its forces, and which element sticks and which slides.

namespace kingpin::mechanism {

namespace {

// Below the limits by more than rounding, so that what holds after a choice of modes holds for a
// while, and what gives way really moves.
constexpr double kMargin = 1e-8;

}  // namespace

const LinearRow& Evaluator::GetRow(const Friction& friction) const {
  return system_.model.linear[friction_row_[&friction - system_.friction.data()]];
}

double Evaluator::CalcSlip(int f, std::span<const double> y) const {
  const LinearRow& row = GetRow(system_.friction[f]);
  double slip = -drive_rate_[row.row];
  for (const LinearRow::Term& term : row.terms) {
    slip += term.factor * y[system_.model.positions + term.v];
  }
  return slip;
}

double Evaluator::CalcSlipAcceleration(const Friction& friction,
                                       std::span<const double> acceleration) const {
  double sum = 0;
  for (const LinearRow::Term& term : GetRow(friction).terms) {
    sum += term.factor * acceleration[term.v];
  }
  return sum;
}

double Evaluator::CalcStaticLimit(const Friction& friction, double normal) const {
  return friction.static_force + friction.static_coefficient * normal;
}

double Evaluator::CalcKineticLimit(const Friction& friction, double normal, double slip) const {
  const double kinetic = friction.kinetic_force + friction.kinetic_coefficient * normal;
  if (friction.stribeck == Friction::Stribeck::kNone) return kinetic;
  const double x = std::abs(slip) / friction.stribeck_speed;
  const double share =
      friction.stribeck == Friction::Stribeck::kExponential ? std::exp(-x) : 1 / (1 + x);
  return kinetic + (CalcStaticLimit(friction, normal) - kinetic) * share;
}

// After CalcJointWrenches, if the normal force is that of a joint.
double Evaluator::CalcNormalForce(const Friction& friction) const {
  double normal = friction.preload;
  for (const std::vector<int>& closure : friction.normal_rows) {
    double square = 0;
    for (int r : closure) square += reaction_[r] * reaction_[r];
    normal += std::sqrt(square);
  }
  if (friction.normal_link != 0) {
    const Link& link = system_.model.links[friction.normal_link];
    Vector3<double> force = joint_[friction.normal_link].f;
    if (link.kind == JointKind::kPrismatic) {
      const Vector3<double>& axis = w_.axes[link.v].v;
      force -= Dot(axis, force) * axis;
    }
    normal += CalcNorm(force);
  }
  return normal;
}

// What an element that is no row exerts along its row at the present normal forces.
double Evaluator::CalcForce(int f) const {
  if (modes_[f] == 0) return held_force_[f];
  return -modes_[f] * CalcKineticLimit(system_.friction[f], normal_[f], slip_[f]);
}

// Accelerations with the friction forces of the present modes at the normal forces normal_; `found`
// is what the normal forces are then.
void Evaluator::SolveAtNormals(std::span<double> found) {
  std::copy(applied_.begin(), applied_.end(), w_.f.begin());
  std::copy(applied_generalised_.begin(), applied_generalised_.end(), w_.generalised.begin());
  for (size_t f = 0; f < modes_.size(); ++f) {
    if (held_[f]) continue;
    const double force = CalcForce(static_cast<int>(f));
    for (const LinearRow::Term& term : GetRow(system_.friction[f]).terms) {
      w_.generalised[term.v] += term.factor * force;
    }
  }
  SolveAccelerations(system_.model, drive_acceleration_, w_, acceleration_, reaction_);
  if (of_joints_) CalcJointWrenches();
  for (size_t f = 0; f < modes_.size(); ++f) found[f] = CalcNormalForce(system_.friction[f]);
}

bool Evaluator::AgreeWith(std::span<const double> found) const {
  double scale = of_joints_ ? largest_force_ : 0;
  for (double reaction : reaction_) scale = std::max(scale, std::abs(reaction));
  for (size_t f = 0; f < found.size(); ++f) {
    if (!(std::abs(found[f] - normal_[f]) <= 1e-13 * found[f] + 1e-14 * scale)) return false;
  }
  return true;
}

// Newton's method for normal forces that agree with the friction forces they cause, the derivative
// by differences: forces are linear in the friction forces, but for the direction of normal ones.
void Evaluator::ImproveNormals(std::span<double> found) {
  const int n = static_cast<int>(modes_.size());
  std::copy(found.begin(), found.end(), normal_base_.begin());
  for (int j = 0; j < n; ++j) {
    const double kept = normal_[j];
    const double step = 1e-3 * (kept + found[j] + largest_force_);
    if (step == 0) {
      normal_jacobian_.col(j).setZero();
    } else {
      normal_[j] = kept + step;
      SolveAtNormals(found);
      for (int i = 0; i < n; ++i) {
        normal_jacobian_(i, j) = (found[i] - normal_base_[i]) / step;
      }
    }
    normal_jacobian_(j, j) -= 1;
    normal_[j] = kept;
  }
  for (int i = 0; i < n; ++i) normal_mismatch_[i] = normal_[i] - normal_base_[i];
  normal_lu_.compute(normal_jacobian_);
  normal_change_ = normal_lu_.solve(normal_mismatch_);
  for (int i = 0; i < n; ++i) normal_[i] = std::max(0.0, normal_[i] + normal_change_[i]);
}

// Accelerations with the friction forces of the present modes. Where a limit depends on a normal
// force, which depends on the friction force, both are brought to agreement.
void Evaluator::SolveWithFriction() {
  constexpr int kPlain = 8, kNewton = 20;
  std::copy(w_.f.begin(), w_.f.end(), applied_.begin());
  if (modes_.empty() || friction_released_) {
    SolveAccelerations(system_.model, drive_acceleration_, w_, acceleration_, reaction_);
    return;
  }
  std::copy(w_.generalised.begin(), w_.generalised.end(), applied_generalised_.begin());
  for (int iteration = 0; iteration < kPlain + kNewton; ++iteration) {
    SolveAtNormals(normal_now_);
    const bool agree = AgreeWith(normal_now_);
    if (agree || iteration < kPlain) {
      std::copy(normal_now_.begin(), normal_now_.end(), normal_.begin());
    } else {
      ImproveNormals(normal_now_);
    }
    if (!agree) continue;
    for (size_t f = 0; f < modes_.size(); ++f) {
      if (!held_[f]) reaction_[system_.friction[f].row] = CalcForce(static_cast<int>(f));
    }
    return;
  }
  throw std::runtime_error(
      "dry friction and the normal force it depends on do not agree (a jam): the friction "
      "coefficient is too large for the geometry");
}

void Evaluator::SetMode(int f, int mode, bool held) {
  modes_[f] = mode;
  held_[f] = held;
  held_force_[f] = 0;
  w_.active[system_.friction[f].row] = held ? 1 : 0;
}

void Evaluator::SetHeldRows(double active) {
  for (size_t f = 0; f < held_.size(); ++f) {
    if (held_[f]) w_.active[system_.friction[f].row] = active;
  }
}

void Evaluator::ReleaseFriction() {
  for (size_t f = 0; f < modes_.size(); ++f) SetMode(static_cast<int>(f), 1, false);
  friction_released_ = true;
}

// The slip accelerations of the elements at rest: without their forces, and by each of them.
void Evaluator::SetUpBox(double time, std::span<const double> y) {
  const Model& model = system_.model;
  const int n = static_cast<int>(at_rest_.size());
  box_.Resize(n);
  CalcRates(time, y, mode_rate_);
  for (int i = 0; i < n; ++i) {
    const Friction& friction = system_.friction[at_rest_[i]];
    box_.b[i] = CalcSlipAcceleration(friction, acceleration_) - drive_acceleration_[friction.row];
  }
  UpdateKinematics(time, y);
  for (int j = 0; j < n; ++j) {
    const LinearRow& row = GetRow(system_.friction[at_rest_[j]]);
    std::fill(w_.f.begin(), w_.f.end(), Wrench<double>{});
    AssembleEquations(model, none_.data(), w_);
    for (int i = 0; i < model.unknowns(); ++i) w_.k[model.pattern.GetRightSideSlot(i)] = 0;
    box_.reference[j] = 0;
    for (const LinearRow::Term& term : row.terms) {
      w_.k[model.pattern.GetRightSideSlot(term.v)] += term.factor;
      box_.reference[j] += term.factor * term.factor / w_.k[model.pattern.position(term.v)];
    }
    FactoriseAndSolve(model, w_, correction_, reaction_);
    for (int i = 0; i < n; ++i) {
      box_.A(i, j) = CalcSlipAcceleration(system_.friction[at_rest_[i]], correction_);
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) box_.A(i, j) = box_.A(j, i) = 0.5 * (box_.A(i, j) + box_.A(j, i));
  }
}

double Evaluator::CalcHighestForce(int f, bool kinetic) const {
  const Friction& friction = system_.friction[f];
  const double limit =
      kinetic ? CalcKineticLimit(friction, normal_[f], 0) : CalcStaticLimit(friction, normal_[f]);
  return (1 - kMargin) * limit;
}

// Solves the box problem; where limits depend on normal forces, until those agree. They depend on
// the friction in turn, in either direction: steps are shortened where they overshoot.
void Evaluator::HoldAtRest(double time, std::span<const double> y) {
  constexpr int kIterations = 60;
  const int n = box_.size();
  double share = 1, before = 2;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    double mismatch = 0;  // relative
    for (int i = 0; i < n; ++i) {
      const double limit = CalcHighestForce(at_rest_[i], moves_[at_rest_[i]]);
      if (iteration > 0 && limit != box_.limit[i]) {
        mismatch = std::max(mismatch, std::abs(limit - box_.limit[i]) / (limit + box_.limit[i]));
      }
    }
    if (iteration > 0 && mismatch <= 1e-10) return;
    if (mismatch > 0.5 * before) share *= 0.5;
    before = mismatch;
    for (int i = 0; i < n; ++i) {
      const double limit = CalcHighestForce(at_rest_[i], moves_[at_rest_[i]]);
      box_.limit[i] = iteration == 0 ? limit : box_.limit[i] + share * (limit - box_.limit[i]);
    }
    box_.Solve();
    if (!depends_on_normals_) return;
    for (int i = 0; i < n; ++i) held_force_[at_rest_[i]] = box_.R[i];
    CalcRates(time, y, mode_rate_);
  }
}

void Evaluator::UpdateModes(double time, std::span<const double> y, double still) {
  const int count = static_cast<int>(modes_.size());
  if (count == 0) return;
  friction_released_ = false;
  UpdateDrives(time);
  at_rest_.clear();
  for (int f = 0; f < count; ++f) {
    const double slip = CalcSlip(f, y);
    const bool rests = std::abs(slip) <= still;
    SetMode(f, rests ? 0 : slip > 0 ? 1 : -1, false);
    if (rests) at_rest_.push_back(f);
    moves_[f] = 0;
  }
  if (at_rest_.empty()) return;
  SetUpBox(time, y);
  // What gives way does so with its kinetic limit, which may take others along.
  bool more = true;
  while (more) {
    HoldAtRest(time, y);
    more = false;
    for (int i = 0; i < box_.size(); ++i) {
      char& moves = moves_[at_rest_[i]];
      more |= box_.a[i] != 0 && !moves;
      moves |= box_.a[i] != 0;
    }
  }
  for (int i = 0; i < box_.size(); ++i) {
    const bool redundant = system_.model.redundant[system_.friction[at_rest_[i]].row];
    candidates_[i] = box_.a[i] == 0 && !redundant;
  }
  box_.KeepIndependent(std::span(candidates_).first(at_rest_.size()));
  for (int i = 0; i < box_.size(); ++i) {
    const int f = at_rest_[i];
    if (box_.a[i] != 0) {
      SetMode(f, box_.a[i] > 0 ? 1 : -1, false);
    } else {
      SetMode(f, 0, candidates_[i]);
      if (!candidates_[i]) held_force_[f] = box_.R[i];
    }
  }
}

void Evaluator::CalcSwitches(std::span<const double> y, std::span<double> switches) const {
  for (size_t f = 0; f < modes_.size(); ++f) {
    const Friction& friction = system_.friction[f];
    const double slip = CalcSlip(static_cast<int>(f), y);
    if (modes_[f] != 0) {
      switches[f] = modes_[f] * slip;
      continue;
    }
    switches[f] = CalcStaticLimit(friction, normal_[f]) - std::abs(reaction_[friction.row]);
    if (!held_[f]) switches[f] = std::min(switches[f], kCreep - std::abs(slip));
  }
}

}  // namespace kingpin::mechanism
