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
};

/// A motion s(t) that a row of coordinates follows: value, rate, acceleration.
using Drive = std::function<std::array<double, 3>(double time)>;

/// A mechanism with everything that acts on it. Immutable; shared by all threads.
struct System {
  std::string name;
  Model model;
  std::vector<std::unique_ptr<ForceGroup>> forces;
  std::vector<Drive> drives;     ///< per row; empty function: 0
  std::vector<int> first_state;  ///< per group
  int states = 0;                ///< of all groups

  /// Adds a group and its states.
  void Add(std::unique_ptr<ForceGroup> group);

  /// Size of the integrated vector y = (q, v, states).
  int size() const { return model.positions + model.velocities + states; }
};

}  // namespace kingpin::mechanism
