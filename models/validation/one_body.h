#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "core/math/vector3.h"
#include "models/validation/extrapolation.h"

namespace kingpin::validation {

/// One rigid body held by constraints against the ground, in absolute coordinates: the multipliers
/// and the accelerations come from one dense system in `long double`.
///
///   m a - Σ λ n = m g + f,   J ω̇ - Σ λ t = τ - ω × J ω,   n·a + t·ω̇ = c
class OneBody {
 public:
  using Vector = math::Vector3<Real>;
  using Attitude = math::Rotation<Real>;

  /// At an instant: centre of mass and velocity, attitude and angular velocity, in ground axes.
  struct Place {
    Vector centre, velocity, spin;
    Attitude R;
    /// A point of the body, given from its centre in body axes.
    Vector GetPoint(const Vector& r) const { return centre + R * r; }
    Vector GetVelocity(const Vector& r) const { return velocity + Cross(spin, R * r); }
  };
  /// A row n·a + t·ω̇ = c.
  struct Row {
    Vector n, t;
    Real c = 0;
  };
  using Constraint = std::function<Row(const Place&)>;
  struct Load {
    Vector force, torque;  ///< about the centre
  };

  Real mass = 1;
  Vector centre;                      ///< in body axes, from the body's origin
  Eigen::Matrix<Real, 3, 3> inertia;  ///< about the centre, in body axes
  Vector gravity{0, 0, -9.80665L};
  std::vector<Constraint> constraints;
  std::function<Load(const Place&)> load;  ///< beside gravity; empty: none

  /// The body point r (from the centre) does not leave the plane normal to n.
  void HoldPoint(const Vector& r, const Vector& n);
  /// The body direction u stays perpendicular to the ground direction w.
  void HoldPerpendicular(const Vector& u, const Vector& w);
  /// The body point r keeps its distance to a ground point.
  void HoldDistance(const Vector& r, const Vector& ground);
  /// The body point r moves by `pitch` along n for each radian about it.
  void HoldPitch(const Vector& r, const Vector& n, Real pitch);

  /// At rest with the origin at the ground's and the axes along its own.
  State MakeStart() const;
  /// Everything that is exerted on the body but gravity: force, and torque about the centre.
  Load CalcTransmitted(const State& y) const;
  void Advance(Real from, Real to, State& y) const;
  static Place GetPlace(const State& y);

 private:
  struct Accelerations {
    Vector linear, angular;
  };
  Accelerations CalcAccelerations(const Place& place) const;
  Vector CalcInertiaTimes(const Place& place, const Vector& w) const;
};

}  // namespace kingpin::validation
