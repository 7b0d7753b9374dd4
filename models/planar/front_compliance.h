#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/parameters/car.h"

namespace kingpin::planar {

/// What to leave out of, or put into, the compliance of the front suspension.
struct FrontComplianceOptions {
  /// Stiffness of the tie rod along itself, the rack's end held; none: the rod is taken out [N/m].
  std::optional<double> tie_rod_stiffness;
  /// Rubber at the stiffness it has between 10 and 100 Hz instead of the static one.
  bool dynamic_rubber = false;
  enum class Progression {
    kAll,          ///< every bushing follows its law
    kRearLateral,  ///< only the arm's rear bushing, along y, which governs recession
  };
  Progression progression = Progression::kAll;
};

/// Elasto-kinematics of the left front corner about its design position.
///
/// Two rigid bodies, carrier (knuckle, hub, wheel; 6 coordinates: displacement of the wheel centre,
/// rotation) and lower control arm (6: displacement of the ball joint, rotation), held by
///
/// - both arm bushings, three axes each with their laws, rotations linear;
/// - the lower ball joint between arm and carrier, equal stiffness in all directions;
/// - the top mount: its radial stiffness acts across the strut on the carrier's point there, and
///   along the strut its axial stiffness lies in series with the coil spring;
/// - the tie rod, if wanted, along its line.
///
/// Without the rod the carrier turns freely about the steering axis, the line from the ball joint
/// to the top mount: no element resists, exactly. Solving then needs a load without moment about
/// that axis and leaves the carrier unturned about it; other loads throw std::invalid_argument.
///
/// Displacements are small: every element's deformation is linear in the coordinates, d = j q, so
/// the potential Σ ∫F(d) is convex and equilibrium unique. The springs' preload is left out; the
/// reference values of compliance were computed the same way.
class FrontCompliance {
 public:
  using Vector12 = Eigen::Matrix<double, 12, 1>;
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  using Row12 = Eigen::Matrix<double, 1, 12>;

  /// One spring: force k d (1 + (d/d0)^4), damping b ḋ.
  struct Element {
    Row12 row = Row12::Zero();  ///< j
    double stiffness = 0.0;     ///< k
    double progression = 0.0;   ///< 1/d0; 0 for a linear one
    double damping = 0.0;       ///< b
  };

  /// Displacement of the wheel centre and small rotation, car frame [m, rad].
  struct Displacement {
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
    /// Toe, + to the left: rotation about z [rad].
    double toe() const { return rotation.z(); }
    /// Camber, + with the wheel's top outboard: −(rotation about x) on the left side [rad].
    double camber() const { return -rotation.x(); }
  };

  FrontCompliance(const parameters::FrontSuspension& front, const FrontComplianceOptions& options);

  const std::vector<Element>& elements() const { return elements_; }

  /// Generalised force of a force at a point of the carrier and a moment.
  Vector12 CalcLoad(const Eigen::Vector3d& point, const Eigen::Vector3d& force,
                    const Eigen::Vector3d& moment = Eigen::Vector3d::Zero()) const;

  /// Tangent stiffness at q.
  Matrix12 CalcStiffness(const Vector12& q = Vector12::Zero()) const;

  /// Response of the linear system.
  Displacement CalcLinearResponse(const Vector12& load) const;

  /// Stiffness (static condensation, K_kk − K_ke K_ee⁻¹ K_ek) in (Fx, Fy, Mz) against (x, y, ψ) of
  /// the carrier's point, all else free, but for the wheel's height if `hold_height`.
  Eigen::Matrix3d CalcCondensed(const Eigen::Vector3d& point, bool hold_height) const;

  /// Coordinates in equilibrium with a load, by Newton's method with a line search on the convex
  /// potential. Throws io::RunError when it does not converge, which a convex potential excludes
  /// but for a broken parameter set.
  Vector12 SolveEquilibrium(const Vector12& load) const;

  /// Force along x at a point that displaces it by `recession` along x, all else free [N].
  double SolveForce(const Eigen::Vector3d& point, double recession) const;

  /// Displacement of a point of the carrier.
  Eigen::Vector3d CalcPointDisplacement(const Vector12& q, const Eigen::Vector3d& point) const;

  /// Damping b_x of a one-degree-of-freedom motion with the shape of the linear response to a force
  /// along x at the point: Σ b (j q)² for a shape q that moves the point by 1 along x [N s/m].
  double CalcDamping(const Eigen::Vector3d& point) const;

 private:
  Row12 CarrierRow(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
  Row12 ArmRow(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
  double CalcPotential(const Vector12& q, const Vector12& load) const;

  void CheckLoad(const Vector12& load) const;
  Vector12 SolveLinear(const Matrix12& stiffness, const Vector12& load) const;

  Eigen::Vector3d wheel_centre_;
  Eigen::Vector3d ball_joint_;
  bool has_tie_rod_ = false;
  Row12 steering_ = Row12::Zero();              // rotation of the carrier about the steering axis
  Vector12 steering_shape_ = Vector12::Zero();  // the motion that it is, wheel centre included
  std::vector<Element> elements_;
};

/// Damping of a bushing's axis, b = (loss factor) k/(2π f) [N s/m].
double CalcBushingDamping(const parameters::BushingAxis& axis);

}  // namespace kingpin::planar
