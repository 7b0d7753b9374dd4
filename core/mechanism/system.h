#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/math/dual.h"
#include "core/mechanism/workspace.h"

namespace kingpin::mechanism {

/// Eight forward derivatives at a time: the scalar of exact Jacobians.
using Dual8 = math::Dual<double, 8>;

/// What a group of force elements sees, and where it adds its forces. Positions and velocities in
/// the workspace are up to date.
template <class S>
struct ForceContext {
  const Model& model;
  S time;
  const S* q;
  const S* v;
  const S* states;  ///< of this group
  S* state_rates;   ///< of this group, to be written
  Workspace<S>& w;  ///< adds to w.f (about the reference point, world axes) and w.generalised
};

/// Power and energy of one group, for the ledger [W], [J].
struct EnergyRates {
  double potential = 0;   ///< stored energy
  double dissipated = 0;  ///< power turned into heat, positive
  double supplied = 0;    ///< power that comes from outside
};

/// Force elements of one type, evaluated together over a flat array. Immutable; shared by all
/// threads.
class ForceGroup {
 public:
  virtual ~ForceGroup() = default;
  /// First-order states of the group (lags, contact patches), integrated with q and v.
  virtual int CountStates() const { return 0; }
  virtual void SetInitialStates(double* /*states*/) const {}
  virtual void AddForces(const ForceContext<double>& context) const = 0;
  virtual void AddForces(const ForceContext<Dual8>& context) const = 0;
  virtual EnergyRates CalcEnergy(const ForceContext<double>& context) const = 0;
  /// Which element's force or state rate is not a finite number at a state that is: its name, "" if
  /// all are finite. Overwrites the forces in the workspace; for messages only.
  virtual std::string FindNotFinite(const ForceContext<double>& context) const;
};

/// Takes all applied forces away from the workspace.
void ClearForces(Workspace<double>& w);
/// Whether all applied forces in the workspace are finite numbers.
bool ForcesAreFinite(const Workspace<double>& w);

/// A motion s(t) that a row of coordinates follows: value, rate, acceleration.
using Drive = std::function<std::array<double, 3>(double time)>;

/// Set-valued (Coulomb) dry friction along a row of coordinates. While it sticks, the row is a
/// constraint and its reaction the friction force; it holds exactly. While it slides, the row is
/// out and the friction force is -sign(ṡ) times the kinetic limit.
///
///   static limit   F_s = static_force + static_coefficient N
///   kinetic limit  F_k = kinetic_force + kinetic_coefficient N,
///                  or with a Stribeck speed v_S: F_k + (F_s - F_k) g(|ṡ|/v_S), g = exp(-x) or 1/(1
///                  + x)
///
/// with ṡ the rate of the row. N is the size of the normal force: of the rows named, or of the
/// force that a joint of the tree transmits (prismatic: its part perpendicular to the axis), plus a
/// preload.
struct Friction {
  enum class Stribeck { kNone, kExponential, kHyperbolic };
  int row = 0;  ///< a LinearRow that is rate_only
  double static_force = 0, kinetic_force = 0;
  double static_coefficient = 0, kinetic_coefficient = 0;
  double preload = 0;  ///< part of N
  /// N counts the size of each of these forces: the rows of its components.
  std::vector<std::vector<int>> normal_rows;
  int normal_link = 0;  ///< N counts the force through the joint of this link; 0: of none
  Stribeck stribeck = Stribeck::kNone;
  double stribeck_speed = 0;
};

/// A mechanism with everything that acts on it. Immutable; shared by all threads.
struct System {
  std::string name;
  Model model;
  std::vector<std::unique_ptr<ForceGroup>> forces;
  std::vector<Drive> drives;  ///< per row; empty function: 0
  std::vector<Friction> friction;
  std::vector<int> first_state;  ///< per group
  int states = 0;                ///< of all groups

  /// Adds a group and its states.
  void Add(std::unique_ptr<ForceGroup> group);

  /// Size of the integrated vector y = (q, v, states).
  int size() const { return model.positions + model.velocities + states; }
};

}  // namespace kingpin::mechanism
