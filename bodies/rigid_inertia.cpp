#include "bodies/rigid_inertia.h"

#include <cmath>

#include <fmt/format.h>

namespace kingpin::bodies {

namespace {

Eigen::Vector3d ToEigen(const Vector3<double>& a) { return {a.x, a.y, a.z}; }
Vector3<double> FromEigen(const Eigen::Vector3d& a) { return {a.x(), a.y(), a.z()}; }
Eigen::Matrix3d ToEigen(const Rotation<double>& R) {
  Eigen::Matrix3d matrix;
  matrix << ToEigen(R.x), ToEigen(R.y), ToEigen(R.z);
  return matrix;
}

// |r|² 1 - r rᵀ
Eigen::Matrix3d CalcPointTensor(const Eigen::Vector3d& r) {
  return r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose();
}

RigidInertia MakeAligned(double mass, double xx, double yy, double zz) {
  return {mass, {}, {xx, yy, zz, 0, 0, 0}};
}

}  // namespace

Eigen::Matrix3d MakeTensor(const std::array<double, 6>& J) {
  Eigen::Matrix3d tensor;
  tensor << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
  return tensor;
}

std::array<double, 6> ListEntries(const Eigen::Matrix3d& tensor) {
  return {tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(0, 2), tensor(1, 2)};
}

RigidInertia MakeFromPrincipalMoments(double mass, const Vector3<double>& centre,
                                      const Vector3<double>& moments,
                                      const Rotation<double>& axes) {
  const Eigen::Matrix3d R = ToEigen(axes);
  return {mass, centre, ListEntries(R * ToEigen(moments).asDiagonal() * R.transpose())};
}

RigidInertia MakeBox(double mass, const Vector3<double>& edges) {
  const double x = edges.x * edges.x, y = edges.y * edges.y, z = edges.z * edges.z;
  return MakeAligned(mass, mass * (y + z) / 12, mass * (x + z) / 12, mass * (x + y) / 12);
}

RigidInertia MakeSphere(double mass, double radius) {
  const double moment = 0.4 * mass * radius * radius;
  return MakeAligned(mass, moment, moment, moment);
}

RigidInertia MakeCylinder(double mass, double radius, double length) {
  return MakeTube(mass, radius, 0, length);
}

RigidInertia MakeTube(double mass, double outer_radius, double inner_radius, double length) {
  const double axial = mass * (outer_radius * outer_radius + inner_radius * inner_radius) / 2;
  const double transverse = axial / 2 + mass * length * length / 12;
  return MakeAligned(mass, axial, transverse, transverse);
}

RigidInertia MakeRod(double mass, double length) { return MakeCylinder(mass, 0, length); }

RigidInertia Move(const RigidInertia& inertia, const Transform<double>& X_BF) {
  const Eigen::Matrix3d R = ToEigen(X_BF.R);
  return {inertia.mass, X_BF * inertia.centre,
          ListEntries(R * MakeTensor(inertia.central) * R.transpose())};
}

RigidInertia Combine(std::span<const RigidInertia> parts) {
  double mass = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const RigidInertia& part : parts) {
    mass += part.mass;
    moment += part.mass * ToEigen(part.centre);
  }
  if (mass == 0) return {};
  const Eigen::Vector3d centre = moment / mass;
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  for (const RigidInertia& part : parts) {
    tensor += MakeTensor(part.central) + part.mass * CalcPointTensor(ToEigen(part.centre) - centre);
  }
  return {mass, FromEigen(centre), ListEntries(tensor)};
}

Eigen::Matrix4d CalcPseudoInertia(const RigidInertia& inertia) {
  const Eigen::Vector3d c = ToEigen(inertia.centre);
  const Eigen::Matrix3d J = MakeTensor(inertia.central);
  Eigen::Matrix4d H;
  H.topLeftCorner<3, 3>() =
      0.5 * J.trace() * Eigen::Matrix3d::Identity() - J + inertia.mass * c * c.transpose();
  H.topRightCorner<3, 1>() = inertia.mass * c;
  H.bottomLeftCorner<1, 3>() = inertia.mass * c.transpose();
  H(3, 3) = inertia.mass;
  return H;
}

RigidInertia MakeFromPseudoInertia(const Eigen::Matrix4d& H) {
  const double mass = H(3, 3);
  if (mass == 0) return {};
  const Eigen::Vector3d c = H.topRightCorner<3, 1>() / mass;
  const Eigen::Matrix3d central = H.topLeftCorner<3, 3>() - mass * c * c.transpose();
  const Eigen::Matrix3d J = central.trace() * Eigen::Matrix3d::Identity() - central;
  return {mass, FromEigen(c), ListEntries(J)};
}

std::optional<InertiaProblem> FindInertiaProblem(const RigidInertia& inertia) {
  if (!std::isfinite(inertia.mass) || inertia.mass < 0) {
    return InertiaProblem{
        "mass", fmt::format("{:g} kg", inertia.mass), "a mass that is not negative", {}};
  }
  for (double entry : inertia.central) {
    if (!std::isfinite(entry)) {
      return InertiaProblem{"inertia", fmt::format("{:g}", entry), "finite numbers [kg m^2]", {}};
    }
  }
  if (!ToEigen(inertia.centre).allFinite()) {
    return InertiaProblem{"centre", "a number that is not finite", "metres", {}};
  }
  const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
                                        MakeTensor(inertia.central), Eigen::EigenvaluesOnly)
                                        .eigenvalues();
  // input is printed with five digits or so: a thin body may miss the triangle inequality by that
  // much
  const double slack = 1e-4 * std::abs(principal[2]);
  if (principal[0] < -slack || principal[0] + principal[1] < principal[2] - slack) {
    return InertiaProblem{
        "inertia",
        fmt::format("principal moments {:g}, {:g}, {:g} kg m^2", principal[0], principal[1],
                    principal[2]),
        "moments that are not negative, none larger than the sum of the other two",
        "is it given about the centre of mass, in kg m^2?"};
  }
  if (inertia.mass == 0 && principal[2] > 0) {
    return InertiaProblem{"mass", "0 kg with a moment of inertia", "a mass above zero", {}};
  }
  return std::nullopt;
}

}  // namespace kingpin::bodies
