#pragma once

#include <Eigen/Dense>
#include <array>
#include <optional>
#include <span>
#include <string>

#include "core/math/vector3.h"

namespace kingpin::bodies {

using math::Rotation;
using math::Transform;
using math::Vector3;

/// Mass, centre of mass and inertia tensor about it, in the axes of the body frame.
struct RigidInertia {
  double mass = 0;         ///< [kg]
  Vector3<double> centre;  ///< in the body frame [m]
  /// Jxx, Jyy, Jzz, Jxy, Jxz, Jyz about the centre of mass [kg m²], with Jxy = -∫xy dm.
  std::array<double, 6> central{};
};

/// From principal moments about the centre of mass; the columns of `axes` are the principal axes in
/// the body frame.
RigidInertia MakeFromPrincipalMoments(double mass, const Vector3<double>& centre,
                                      const Vector3<double>& moments,
                                      const Rotation<double>& axes = {});

// Homogeneous solids, centred on the origin of the body frame; move them with `Move`.

/// Edges along x, y, z [m].
RigidInertia MakeBox(double mass, const Vector3<double>& edges);
RigidInertia MakeSphere(double mass, double radius);
/// Axis along x.
RigidInertia MakeCylinder(double mass, double radius, double length);
/// Hollow cylinder, axis along x.
RigidInertia MakeTube(double mass, double outer_radius, double inner_radius, double length);
/// Without thickness, along x.
RigidInertia MakeRod(double mass, double length);

/// The same body, seen from frame B, in which its own frame F has the pose X_BF.
RigidInertia Move(const RigidInertia& inertia, const Transform<double>& X_BF);

/// Several bodies as one, all given in one frame. Massless parts count for nothing.
RigidInertia Combine(std::span<const RigidInertia> parts);

/// The tensor as a matrix.
Eigen::Matrix3d MakeTensor(const std::array<double, 6>& entries);
std::array<double, 6> ListEntries(const Eigen::Matrix3d& tensor);

/// The pseudo-inertia H = ∫ r̃ r̃ᵀ dm with r̃ = (x, y, z, 1) in the body frame: kinetic energy of a
/// homogeneous transform T is 1/2 tr(Ṫ H Ṫᵀ). Upper left: Σ = 1/2 tr(J) 1 - J about the origin;
/// right column: first moment and mass.
///
/// Source: Wittbrodt, Adamiec-Wójcik, Wojciech, Dynamics of Flexible Multibody Systems (2006).
/// H is positive semi-definite exactly if some distribution of mass has these numbers (Wensing,
/// Kim, Slotine, IEEE Robotics and Automation Letters 3, 2018).
Eigen::Matrix4d CalcPseudoInertia(const RigidInertia& inertia);

/// The way back; mass zero gives zeros.
RigidInertia MakeFromPseudoInertia(const Eigen::Matrix4d& H);

/// What keeps these numbers from being those of a body.
struct InertiaProblem {
  std::string part;  ///< "mass", "centre" or "inertia"
  std::string found, expected, suggestion;
};

/// Checks that all numbers are finite, the mass is not negative, principal moments are not negative
/// and meet the triangle inequality, and a body without mass has no moments.
std::optional<InertiaProblem> FindInertiaProblem(const RigidInertia& inertia);

}  // namespace kingpin::bodies
