#include "joints/urdf.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "core/math/quaternion.h"
#include "core/mechanism/project.h"
#include "joints/tree_evaluation.h"

namespace kingpin::joints {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Eigen::Vector3d ToEigen(const Vector3<double>& a) { return {a.x, a.y, a.z}; }

Eigen::Matrix3d ToEigen(const Rotation<double>& R) {
  Eigen::Matrix3d m;
  m << ToEigen(R.x), ToEigen(R.y), ToEigen(R.z);
  return m;
}

std::string Inertial(double mass, const std::string& xyz, const std::string& rpy,
                     const std::array<double, 6>& I) {
  return fmt::format(
      "<inertial><origin xyz='{}' rpy='{}'/><mass value='{}'/><inertia ixx='{}' ixy='{}' ixz='{}' "
      "iyy='{}' iyz='{}' izz='{}'/></inertial>",
      xyz, rpy, mass, I[0], I[1], I[2], I[3], I[4], I[5]);
}

std::string Joint(
    const std::string& name, const std::string& type, const std::string& parent,
    const std::string& child, const std::string& origin, const std::string& axis,
    const std::string& more = "<limit lower='-1' upper='1' effort='1' velocity='1'/>") {
  return fmt::format(
      "<joint name='{}' type='{}'><parent link='{}'/><child link='{}'/><origin {}/><axis "
      "xyz='{}'/>{}</joint>\n",
      name, type, parent, child, origin, axis, more);
}

std::string Robot(const std::vector<std::string>& parts) {
  std::string text = "<robot name='test'>\n";
  for (const std::string& part : parts) text += part;
  return text + "</robot>\n";
}

/// A tree with branches, all kinds of joints with one coordinate, fixed joints before and after, a
/// massless link, inertia in rotated frames. Parts in an order that is not that of the tree.
std::vector<std::string> MakeTreeParts() {
  const std::array<double, 6> I = {0.3, 0.02, -0.01, 0.25, 0.03, 0.2};
  std::vector<std::string> parts;
  const auto link = [&](const std::string& name, double mass, const std::string& xyz,
                        const std::string& rpy) {
    parts.push_back(fmt::format("<link name='{}'>{}</link>\n", name, Inertial(mass, xyz, rpy, I)));
  };
  link("trunk", 3, "0.1 0.2 0.05", "0.1 -0.4 1.2");
  parts.push_back("<link name='plate'/>\n");
  link("z_arm", 1.5, "0.3 0 0.1", "0 0.2 0");
  link("a_arm", 1.2, "0.1 -0.3 0", "1 0 0");
  link("hand", 0.7, "0 0.1 0.2", "0.3 0.3 0.3");
  link("slider", 0.9, "0.05 0 0", "0 0 1");
  link("tool", 0.4, "0 0 0.2", "0 1 1");
  parts.push_back(
      Joint("mount", "fixed", "trunk", "plate", "xyz='0 0.1 0.4' rpy='0 0 0.5'", "1 0 0"));
  parts.push_back(
      Joint("z", "revolute", "plate", "z_arm", "xyz='0.2 0 0' rpy='0.4 0 0'", "0.6 0.8 0"));
  parts.push_back(Joint("a", "continuous", "trunk", "a_arm", "xyz='0 -0.2 0.1'", "0 0 1"));
  parts.push_back(
      Joint("wrist", "revolute", "z_arm", "hand", "xyz='0.5 0 0' rpy='0 1 0'", "0 1 0"));
  parts.push_back(Joint("slide", "prismatic", "z_arm", "slider", "rpy='1 1 0'", "0 0.6 -0.8"));
  parts.push_back(Joint("grip", "fixed", "hand", "tool", "xyz='0 0 0.1' rpy='0 0.7 0'", "0 0 1"));
  return parts;
}

/// A robot in a state that no one has chosen.
class Case {
 public:
  Case(const std::string& text, UrdfBase base, unsigned seed)
      : urdf(ReadUrdfText(text, "test.urdf", base)),
        mechanism(MakeMechanism(urdf.description)),
        model(mechanism.system.model) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    q = {mechanism.start.begin(), mechanism.start.begin() + model.positions};
    std::vector<double> direction(model.velocities);
    for (double& x : direction) x = normal(random);
    mechanism::MovePositions(model, direction, q);
    for (std::vector<double>* values : {&v, &tau, &a}) {
      values->resize(model.velocities);
      for (double& x : *values) x = normal(random);
    }
    for (const BodyDescription& body : urdf.description.bodies) {
      frames.push_back(mechanism.GetBody(body.name));
    }
  }

  TreeEvaluation Evaluate() const { return At(q, v, tau, a); }
  TreeEvaluation At(const std::vector<double>& q_at, const std::vector<double>& v_at,
                    const std::vector<double>& tau_at, const std::vector<double>& a_at) const {
    return CalcTreeEvaluation(mechanism, q_at, v_at, tau_at, a_at, frames);
  }
  /// The state after time h of constant joint accelerations, to second order in h apart from terms
  /// of even order, which central differences do not see.
  TreeEvaluation After(double h, const std::vector<double>& acceleration) const {
    std::vector<double> q_at = q, v_at = v, way(v.size());
    for (size_t i = 0; i < v.size(); ++i) {
      way[i] = h * (v[i] + 0.5 * h * acceleration[i]);
      v_at[i] += h * acceleration[i];
    }
    mechanism::MovePositions(model, way, q_at);
    return At(q_at, v_at, tau, a);
  }

  Urdf urdf;
  Mechanism mechanism;
  const mechanism::Model& model;
  std::vector<double> q, v, tau, a;
  std::vector<mechanism::Frame> frames;  // of the bodies, in the description's order
};

Eigen::Map<const Eigen::VectorXd> Map(const std::vector<double>& x) {
  return {x.data(), static_cast<Eigen::Index>(x.size())};
}

constexpr double kRounding = 1e-12;  // relative; sums of some ten terms of like size
// Central differences with h = 1e-5: truncation h² times derivatives of some ten, rounding 1e-16/h.
constexpr double kStep = 1e-5, kDifferences = 1e-7;

TEST(Urdf, DoublePendulumHasTheClosedForm) {
  const double m1 = 1.3, m2 = 0.8, l1 = 0.7, c1 = 0.4, c2 = 0.25, I1 = 0.06, I2 = 0.02;
  const std::string text =
      Robot({"<link name='base'/>",
             fmt::format("<link name='upper'>{}</link>",
                         Inertial(m1, "0 0 -0.4", "0 0 0", {I1, 0, 0, I1, 0, 0.01})),
             fmt::format("<link name='lower'>{}</link>",
                         Inertial(m2, "0 0 -0.25", "0 0 0", {I2, 0, 0, I2, 0, 0.01})),
             Joint("shoulder", "continuous", "base", "upper", "xyz='0 0 2'", "1 0 0"),
             Joint("elbow", "continuous", "upper", "lower", "xyz='0 0 -0.7'", "1 0 0")});
  Case c(text, UrdfBase::kFixed, 1);
  const double g = 9.80665, q1 = c.q[0], q2 = c.q[1], u1 = c.v[0], u2 = c.v[1];
  const TreeEvaluation e = c.Evaluate();
  const double cross = m2 * l1 * c2, h = cross * std::sin(q2);
  const double M12 = I2 + m2 * c2 * c2 + cross * std::cos(q2);
  EXPECT_NEAR(e.M(0, 0),
              I1 + I2 + m1 * c1 * c1 + m2 * (l1 * l1 + c2 * c2) + 2 * cross * std::cos(q2), 1e-14);
  EXPECT_NEAR(e.M(0, 1), M12, 1e-14);
  EXPECT_NEAR(e.M(1, 0), M12, 1e-14);
  EXPECT_NEAR(e.M(1, 1), I2 + m2 * c2 * c2, 1e-14);
  EXPECT_NEAR(e.bias[0],
              -h * (2 * u1 * u2 + u2 * u2) + g * (m1 * c1 + m2 * l1) * std::sin(q1) +
                  m2 * g * c2 * std::sin(q1 + q2),
              1e-13);
  EXPECT_NEAR(e.bias[1], h * u1 * u1 + m2 * g * c2 * std::sin(q1 + q2), 1e-13);
  EXPECT_NEAR(
      e.potential,
      g * (m1 * (2 - c1 * std::cos(q1)) + m2 * (2 - l1 * std::cos(q1) - c2 * std::cos(q1 + q2))),
      1e-13);
  EXPECT_NEAR(e.centre.x, 0, 1e-15);
  // the second joint's acceleration is that of a point on the first rod
  const FrameMotion& lower = e.frames[2];
  EXPECT_NEAR(lower.acc.y, l1 * (c.a[0] * std::cos(q1) - u1 * u1 * std::sin(q1)), 1e-14);
  EXPECT_NEAR(lower.acc.z, l1 * (c.a[0] * std::sin(q1) + u1 * u1 * std::cos(q1)), 1e-14);
  EXPECT_NEAR(lower.alpha.x, c.a[0] + c.a[1], 1e-15);
}

class UrdfTree : public testing::TestWithParam<UrdfBase> {
 protected:
  Case Make(unsigned seed) const { return Case(Robot(MakeTreeParts()), GetParam(), seed); }
};

INSTANTIATE_TEST_SUITE_P(Bases, UrdfTree, testing::Values(UrdfBase::kFixed, UrdfBase::kFloating),
                         [](const auto& info) {
                           return info.param == UrdfBase::kFixed ? "Fixed" : "Floating";
                         });

TEST_P(UrdfTree, InverseAndForwardDynamicsAreInverses) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Case c = Make(seed);
    const TreeEvaluation e = c.Evaluate();
    EXPECT_LT((e.M * Map(c.a) + e.bias - e.tau).norm(), kRounding * e.tau.norm());
    EXPECT_LT((e.M * e.qdd + e.bias - Map(c.tau)).norm(), 1e-11 * Map(c.tau).norm());
    const std::vector<double> tau(e.tau.begin(), e.tau.end());
    // times the condition of M, some hundred
    EXPECT_LT((c.At(c.q, c.v, tau, c.a).qdd - Map(c.a)).norm(), 1e-10);
  }
}

TEST_P(UrdfTree, MassMatrixIsThatOfTheLinksMotions) {
  const Case c = Make(3);
  const TreeEvaluation e = c.Evaluate();
  const int n = c.model.velocities;
  EXPECT_EQ((e.M - e.M.transpose()).norm(), 0);
  EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(e.M).info(), Eigen::Success);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
  const auto& bodies = c.urdf.description.bodies;
  std::vector<Eigen::MatrixXd> Jv(bodies.size(), Eigen::MatrixXd(3, n)), Jw = Jv;
  for (int i = 0; i < n; ++i) {
    std::vector<double> unit(n);
    unit[i] = 1;
    const TreeEvaluation moved = c.At(c.q, unit, c.tau, c.a);
    for (size_t b = 0; b < bodies.size(); ++b) {
      const FrameMotion& f = moved.frames[b];
      Jw[b].col(i) = ToEigen(f.w);
      Jv[b].col(i) = ToEigen(f.v + Cross(f.w, f.X_WF.R * bodies[b].centre));
    }
  }
  double kinetic = 0, potential = 0, mass = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (GetParam() == UrdfBase::kFixed && c.frames[b].link == 0) continue;  // welded to the world
    const auto& J = bodies[b].central_inertia;
    Eigen::Matrix3d tensor;
    tensor << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
    const Eigen::Matrix3d R = ToEigen(e.frames[b].X_WF.R);
    M += bodies[b].mass * Jv[b].transpose() * Jv[b] +
         Jw[b].transpose() * R * tensor * R.transpose() * Jw[b];
    const Eigen::Vector3d centre = ToEigen(e.frames[b].X_WF * bodies[b].centre);
    potential += 9.80665 * bodies[b].mass * centre.z();
    mass += bodies[b].mass;
    moment += bodies[b].mass * centre;
  }
  kinetic = 0.5 * Map(c.v).dot(M * Map(c.v));
  EXPECT_LT((e.M - M).norm(), kRounding * M.norm());
  EXPECT_NEAR(e.kinetic, kinetic, kRounding * kinetic);
  EXPECT_NEAR(e.potential, potential, kRounding * mass * 9.80665);
  EXPECT_NEAR(e.mass, mass, 1e-14);
  EXPECT_LT((ToEigen(e.centre) - moment / mass).norm(), kRounding);
}

TEST_P(UrdfTree, LinkMotionsAreDerivativesOfPoses) {
  const Case c = Make(5);
  const TreeEvaluation e = c.Evaluate();
  const TreeEvaluation before = c.After(-kStep, c.a), after = c.After(kStep, c.a);
  for (size_t f = 0; f < c.frames.size(); ++f) {
    const auto rate = [&](const Vector3<double> FrameMotion::*member) -> Eigen::Vector3d {
      return (ToEigen(after.frames[f].*member) - ToEigen(before.frames[f].*member)) / (2 * kStep);
    };
    EXPECT_LT((rate(&FrameMotion::v) - ToEigen(e.frames[f].acc)).norm(), kDifferences) << f;
    EXPECT_LT((rate(&FrameMotion::w) - ToEigen(e.frames[f].alpha)).norm(), kDifferences) << f;
    const Eigen::Vector3d v =
        (ToEigen(after.frames[f].X_WF.p) - ToEigen(before.frames[f].X_WF.p)) / (2 * kStep);
    EXPECT_LT((v - ToEigen(e.frames[f].v)).norm(), kDifferences) << f;
    const Eigen::Matrix3d R = ToEigen(e.frames[f].X_WF.R);
    const Eigen::Matrix3d rotation =
        (ToEigen(after.frames[f].X_WF.R) - ToEigen(before.frames[f].X_WF.R)) / (2 * kStep) *
        R.transpose();
    const Eigen::Vector3d w(rotation(2, 1), rotation(0, 2), rotation(1, 0));
    EXPECT_LT((w - ToEigen(e.frames[f].w)).norm(), kDifferences) << f;
  }
}

TEST_P(UrdfTree, PowerOfTheJointForcesIsTheRateOfEnergy) {
  const Case c = Make(7);
  const TreeEvaluation e = c.Evaluate();
  const std::vector<double> qdd(e.qdd.begin(), e.qdd.end());
  const TreeEvaluation before = c.After(-kStep, qdd), after = c.After(kStep, qdd);
  const double rate =
      (after.kinetic + after.potential - before.kinetic - before.potential) / (2 * kStep);
  // energies of some ten joules: rounding 1e-15/h
  EXPECT_NEAR(rate, Map(c.tau).dot(Map(c.v)), 1e-6 * (1 + std::abs(e.potential)));
}

TEST(Urdf, BiasIsThatOfLagrange) {
  const Case c(Robot(MakeTreeParts()), UrdfBase::kFixed, 11);
  const TreeEvaluation e = c.Evaluate();
  const int n = c.model.velocities;
  ASSERT_EQ(n, c.model.positions);
  Eigen::MatrixXd M_rate = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd gradient(n);  // of T - V
  for (int i = 0; i < n; ++i) {
    std::vector<double> before = c.q, after = c.q;
    before[i] -= kStep, after[i] += kStep;
    const TreeEvaluation b = c.At(before, c.v, c.tau, c.a), a = c.At(after, c.v, c.tau, c.a);
    M_rate += (a.M - b.M) / (2 * kStep) * c.v[i];
    gradient[i] = (a.kinetic - a.potential - b.kinetic + b.potential) / (2 * kStep);
  }
  const Eigen::VectorXd bias = M_rate * Map(c.v) - gradient;
  EXPECT_LT((bias - e.bias).norm(), 10 * kDifferences * (1 + e.bias.norm()));
}

TEST(Urdf, FreeBaseFollowsTheMomentumLaws) {
  const Case c(Robot(MakeTreeParts()), UrdfBase::kFloating, 13);
  const TreeEvaluation e = c.Evaluate();
  // the base's generalised force is the wrench on the whole, in base axes about the base's origin
  const auto momentum = [&](const TreeEvaluation& at) {
    Eigen::VectorXd h = Eigen::VectorXd::Zero(6);
    const auto& bodies = c.urdf.description.bodies;
    for (size_t b = 0; b < bodies.size(); ++b) {
      const FrameMotion& f = at.frames[b];
      const Eigen::Vector3d arm = ToEigen(f.X_WF.R * bodies[b].centre);
      const Eigen::Vector3d v = ToEigen(f.v) + ToEigen(f.w).cross(arm);
      const auto& J = bodies[b].central_inertia;
      Eigen::Matrix3d tensor;
      tensor << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
      const Eigen::Matrix3d R = ToEigen(f.X_WF.R);
      h.head(3) += bodies[b].mass * v;
      h.tail(3) += R * tensor * R.transpose() * ToEigen(f.w) +
                   bodies[b].mass * (ToEigen(f.X_WF.p) + arm).cross(v);
    }
    return h;
  };
  const Eigen::VectorXd rate =
      (momentum(c.After(kStep, c.a)) - momentum(c.After(-kStep, c.a))) / (2 * kStep);
  const size_t root = 0;
  ASSERT_EQ(c.urdf.description.bodies[root].name, "trunk");
  const Eigen::Matrix3d R = ToEigen(e.frames[root].X_WF.R);
  const Eigen::Vector3d p = ToEigen(e.frames[root].X_WF.p);
  const Eigen::Vector3d weight(0, 0, -9.80665 * e.mass);
  const Eigen::Vector3d force = R * e.tau.head(3), torque = R * e.tau.segment(3, 3);
  EXPECT_LT((force + weight - rate.head(3)).norm(), 10 * kDifferences * force.norm());
  EXPECT_LT((torque + p.cross(force) + ToEigen(e.centre).cross(weight) - rate.tail(3)).norm(),
            10 * kDifferences * (torque.norm() + p.norm() * force.norm()));
}

TEST(Urdf, TenKilometresFromTheOriginCostNoDigits) {
  const Case c(Robot(MakeTreeParts()), UrdfBase::kFloating, 17);
  const TreeEvaluation near = c.Evaluate();
  std::vector<double> q = c.q;
  q[0] += 1e4, q[1] -= 1e4;
  const TreeEvaluation far = c.At(q, c.v, c.tau, c.a);
  // Only the position differs, and nothing but positions depends on it.
  EXPECT_EQ((near.M - far.M).norm(), 0);
  EXPECT_EQ((near.bias - far.bias).norm(), 0);
  EXPECT_EQ((near.qdd - far.qdd).norm(), 0);
  EXPECT_EQ((near.tau - far.tau).norm(), 0);
}

TEST(Urdf, OrderIsDepthFirstBySiblingsNamesWhateverTheFilesOrder) {
  std::vector<std::string> parts = MakeTreeParts();
  std::mt19937_64 random(3);
  const auto names = [](const Case& c) {
    std::vector<std::string> list;
    for (const auto& place : c.mechanism.joints) list.push_back(place.name);
    return list;
  };
  const Case first(Robot(parts), UrdfBase::kFloating, 19);
  // `mount` is fixed: no coordinate, but its place among the siblings is that of its name
  EXPECT_THAT(names(first), ElementsAre("floating_base", "a", "z", "slide", "wrist"));
  const TreeEvaluation expected = first.Evaluate();
  for (int k = 0; k < 5; ++k) {
    std::shuffle(parts.begin(), parts.end(), random);
    const Case c(Robot(parts), UrdfBase::kFloating, 19);
    EXPECT_EQ(names(c), names(first));
    const TreeEvaluation e = c.Evaluate();
    EXPECT_EQ(e.M, expected.M);
    EXPECT_EQ(e.bias, expected.bias);
    EXPECT_EQ(e.qdd, expected.qdd);
    EXPECT_EQ(e.tau, expected.tau);
  }
}

TEST(Urdf, AFixedRootCountsNowhere) {
  std::vector<std::string> parts = MakeTreeParts();
  const TreeEvaluation e = Case(Robot(parts), UrdfBase::kFixed, 23).Evaluate();
  parts[0] = "<link name='trunk'/>\n";
  const TreeEvaluation without = Case(Robot(parts), UrdfBase::kFixed, 23).Evaluate();
  EXPECT_EQ(e.M, without.M);
  EXPECT_EQ(e.bias, without.bias);
  EXPECT_EQ(e.kinetic, without.kinetic);
  EXPECT_EQ(e.potential, without.potential);
  EXPECT_EQ(e.mass, without.mass);
  EXPECT_EQ(ToEigen(e.centre), ToEigen(without.centre));
  EXPECT_EQ(ToEigen(e.frames[0].acc).norm(), 0);
}

TEST(Urdf, ARobotWithoutMovableJointsHasPosesOnly) {
  const Case c(Robot({"<link name='a'/><link name='b'/>",
                      Joint("j", "fixed", "a", "b", "xyz='1 2 3'", "1 0 0")}),
               UrdfBase::kFixed, 1);
  const TreeEvaluation e = c.Evaluate();
  EXPECT_EQ(e.M.size(), 0);
  EXPECT_EQ(e.mass, 0);
  EXPECT_EQ(ToEigen(e.frames[1].X_WF.p), Eigen::Vector3d(1, 2, 3));
}

TEST(Urdf, RollPitchYawAreFixedAxesInThisOrder) {
  const Case c(Robot({"<link name='a'/><link name='b'/>",
                      Joint("j", "fixed", "a", "b", "rpy='0.3 -0.5 0.9'", "1 0 0")}),
               UrdfBase::kFixed, 1);
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  EXPECT_LT((ToEigen(c.Evaluate().frames[1].X_WF.R) - expected).norm(), 1e-15);
}

TEST(Urdf, InertiaIsGivenInTheInertialFrame) {
  // a quarter turn about z exchanges the moments about x and y and the sign of ixy
  const Urdf urdf = ReadUrdfText(Robot({fmt::format("<link name='a'>{}</link>",
                                                    Inertial(2, "1 2 3", "0 0 1.5707963267948966",
                                                             {0.3, 0.02, 0.01, 0.25, 0.04, 0.2}))}),
                                 "f", UrdfBase::kFloating);
  const BodyDescription& body = urdf.description.bodies[0];
  const std::array<double, 6> expected = {0.25, 0.3, 0.2, -0.02, -0.04, 0.01};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(body.central_inertia[i], expected[i], 1e-16) << i;
  EXPECT_EQ(ToEigen(body.centre), Eigen::Vector3d(1, 2, 3));
}

TEST(Urdf, APlanarJointMovesInThePlaneAcrossItsAxis) {
  const std::string body = Inertial(1, "0 0 0", "0 0 0", {0.1, 0, 0, 0.1, 0, 0.1});
  Case c(Robot({"<link name='a'/>", fmt::format("<link name='b'>{}</link>", body),
                Joint("j", "planar", "a", "b", "xyz='0 0 1' rpy='0.3 0 0'", "0 0.6 0.8")}),
         UrdfBase::kFixed, 1);
  const Eigen::Vector3d axis =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) * Eigen::Vector3d(0, 0.6, 0.8);
  const TreeEvaluation e = c.Evaluate();
  ASSERT_EQ(c.model.velocities, 3);
  EXPECT_NEAR(axis.dot(ToEigen(e.frames[1].X_WF.p) - Eigen::Vector3d(0, 0, 1)), 0, 1e-15);
  EXPECT_NEAR(axis.dot(ToEigen(e.frames[1].v)), 0, 1e-15);
  EXPECT_LT((ToEigen(e.frames[1].w) - c.v[2] * axis).norm(), 1e-15);
  // at zero the frames coincide up to the joint's origin
  const TreeEvaluation rest = c.At({0, 0, 0}, c.v, c.tau, c.a);
  EXPECT_LT((ToEigen(rest.frames[1].X_WF.R) -
             Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix())
                .norm(),
            1e-15);
}

TEST(Urdf, AFloatingJointHasSixCoordinates) {
  const std::string body = Inertial(2, "0 0 0", "0 0 0", {0.1, 0, 0, 0.2, 0, 0.25});
  const Case c(Robot({"<link name='a'/>", fmt::format("<link name='b'>{}</link>", body),
                      Joint("j", "floating", "a", "b", "xyz='0 0 1'", "1 0 0")}),
               UrdfBase::kFixed, 1);
  Eigen::VectorXd diagonal(6);
  diagonal << 2, 2, 2, 0.1, 0.2, 0.25;
  EXPECT_LT((c.Evaluate().M - Eigen::MatrixXd(diagonal.asDiagonal())).norm(), 1e-14);
}

TEST(Urdf, LimitsDampingFrictionAndMimicAreRead) {
  const std::string body = Inertial(1, "0 0 0", "0 0 0", {0.1, 0, 0, 0.1, 0, 0.1});
  const Urdf urdf =
      ReadUrdfText(Robot({"<link name='a'/>",
                          fmt::format("<link name='b'>{0}</link><link name='c'>{0}</link>", body),
                          Joint("one", "revolute", "a", "b", "", "1 0 0",
                                "<limit lower='-1.5' upper='2' effort='30' velocity='4'/><dynamics "
                                "damping='0.3' friction='0.2'/>"),
                          Joint("two", "continuous", "a", "c", "", "1 0 0",
                                "<mimic joint='one' multiplier='-2' offset='0.5'/>")}),
                   "f", UrdfBase::kFixed);
  ASSERT_EQ(urdf.joints.size(), 2u);
  EXPECT_EQ(urdf.joints[0].limit->lower, -1.5);
  EXPECT_EQ(urdf.joints[0].limit->upper, 2);
  EXPECT_EQ(urdf.joints[0].limit->effort, 30);
  EXPECT_EQ(urdf.joints[0].limit->velocity, 4);
  EXPECT_EQ(urdf.joints[0].damping, 0.3);
  EXPECT_EQ(urdf.joints[0].friction, 0.2);
  EXPECT_EQ(urdf.joints[1].mimic->joint, "one");
  const Mechanism mechanism = MakeMechanism(urdf.description);
  ASSERT_EQ(mechanism.rows.size(), 1u);
  EXPECT_EQ(mechanism.rows[0].name, "two mimics one");
  // assembly has met two = -2 one + 0.5
  EXPECT_NEAR(mechanism.start[1], -2 * mechanism.start[0] + 0.5, 1e-12);
}

TEST(Urdf, ALinkMayBeNamedWorld) {
  const std::string body = Inertial(1, "0 0 0", "0 0 0", {0.1, 0, 0, 0.1, 0, 0.1});
  const std::vector<std::string> parts = {
      "<link name='world'/>", fmt::format("<link name='b'>{}</link>", body),
      Joint("j", "continuous", "world", "b", "xyz='0 0 1'", "1 0 0")};
  EXPECT_EQ(Case(Robot(parts), UrdfBase::kFixed, 1).model.velocities, 1);
  const std::vector<std::string> turned = {
      "<link name='b'/>", fmt::format("<link name='world'>{}</link>", body),
      Joint("j", "continuous", "b", "world", "xyz='0 0 1'", "1 0 0")};
  const Case c(Robot(turned), UrdfBase::kFixed, 1);
  EXPECT_EQ(c.model.velocities, 1);
  EXPECT_EQ(c.mechanism.GetBody(c.urdf.bodies.at("world")).link, 1);
}

TEST(Urdf, OtherProgramsTagsAreLeftAlone) {
  const std::string body = Inertial(1, "0 0 0", "0 0 0", {0.1, 0, 0, 0.1, 0, 0.1});
  EXPECT_NO_THROW(ReadUrdfText(
      Robot({fmt::format("<material name='m'/><gazebo reference='b'/><transmission name='t'/>"
                         "<link name='b'>{}<visual><geometry><mesh/></geometry></visual>"
                         "<collision/><contact/></link>",
                         body)}),
      "f", UrdfBase::kFloating));
}

struct Wrong {
  const char* name;
  std::string text;
  std::string message;
};

std::string Chain(const std::string& joint, const std::string& link = "") {
  return "<robot name='r'>\n<link name='a'/>\n<link name='b'>" +
         (link.empty() ? Inertial(1, "0 0 0", "0 0 0", {0.1, 0, 0, 0.1, 0, 0.1}) : link) +
         "</link>\n" + joint + "\n</robot>\n";
}

std::string JointAB(const std::string& inside, const std::string& type = "continuous") {
  return "<joint name='j' type='" + type + "'><parent link='a'/><child link='b'/>" + inside +
         "</joint>";
}

std::string Nest(int levels) {
  std::string text = "<robot name='r'>";
  for (int k = 0; k < levels; ++k) text += "<x>";
  for (int k = 0; k < levels; ++k) text += "</x>";
  return text + "</robot>";
}

class UrdfMistake : public testing::TestWithParam<Wrong> {};

TEST_P(UrdfMistake, IsNamedWithItsLine) {
  try {
    MakeMechanism(ReadUrdfText(GetParam().text, "f.urdf", UrdfBase::kFixed).description);
    FAIL() << "accepted";
  } catch (const io::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Errors, UrdfMistake,
    testing::Values(
        Wrong{"Empty", "", "f.urdf: found a file without content, expected a URDF file (XML)"},
        Wrong{"NoXml", "hello", "found"},
        Wrong{"WronglyClosed", "<robot name='r'>\n<link name='a'></lonk></robot>",
              "f.urdf:2: found an element that is not closed, or closed by another name"},
        Wrong{"Truncated", "<robot name='r'>\n<link name='a'>\n",
              "f.urdf:2: found a file that ends too early, expected a URDF file (XML)"},
        Wrong{"CutInAnAttribute", "<robot name='r'>\n<link name='a", "f.urdf:2: found"},
        Wrong{"OtherRoot", "<sdf/>", "f.urdf:1: found <sdf>, expected <robot>"},
        Wrong{"TwoRobots", "<robot/>\n<robot/>",
              "f.urdf:2: found <robot> beside <robot>, expected one <robot> in a file"},
        Wrong{"NoLink", "<robot name='r'/>", "f.urdf:1: robot: found no link"},
        Wrong{"EntityBomb",
              "<?xml version='1.0'?>\n<!DOCTYPE r [<!ENTITY a 'x'><!ENTITY b '&a;&a;'>]>\n<robot/>",
              "f.urdf:2: found '<!DOCTYPE', expected a file without definitions of its own"},
        Wrong{"DeepNesting", Nest(5000), "more than 100 levels of nesting"},
        Wrong{"ZeroByte", std::string("<robot>\n\0</robot>", 17), "f.urdf:2: found a zero byte"},
        Wrong{"Xacro", "<robot name='r'>\n<xacro:include filename='x'/></robot>",
              "f.urdf:2: robot: found <xacro:include>, expected a plain URDF file"},
        Wrong{"LinkWithoutName", "<robot>\n<link/></robot>",
              "f.urdf:2: link: found no attribute 'name', expected <link name=\"...\">"},
        Wrong{"LinkTwice", "<robot>\n<link name='a'/>\n<link name='a'/></robot>",
              "f.urdf:3: link[a]: found a second link of this name (first in line 2)"},
        Wrong{"JointTwice", Chain(JointAB("") + "\n" + JointAB("")),
              "f.urdf:5: joint[j]: found a second joint of this name (first in line 4)"},
        Wrong{"UnknownType", Chain(JointAB("", "ball")),
              "f.urdf:4: joint[j].type: found 'ball', expected a type of joint that URDF has; "
              "known types: revolute, continuous, prismatic, fixed, floating, planar"},
        Wrong{"MisspeltType", Chain(JointAB("", "revolut")), "did you mean 'revolute'?"},
        Wrong{"NoParent", Chain("<joint name='j' type='fixed'><child link='b'/></joint>"),
              "f.urdf:4: joint[j]: found no <parent>, expected <parent link=\"...\"/>"},
        Wrong{"NoChild", Chain("<joint name='j' type='fixed'><parent link='a'/></joint>"),
              "f.urdf:4: joint[j]: found no <child>"},
        Wrong{"UnknownLink",
              Chain("<joint name='j' type='fixed'>\n<parent link='a'/><child link='c'/></joint>"),
              "f.urdf:5: joint[j].child: found 'c', expected the name of a link"},
        Wrong{"TwoParents",
              Chain(JointAB("") + "\n<joint name='k' type='fixed'><parent link='a'/><child "
                                  "link='b'/></joint>"),
              "f.urdf:5: joint[k].child: found 'b', which joint 'j' carries already"},
        Wrong{"TwoRoots", Chain(""), "f.urdf:3: link[b]: found a second root beside 'a'"},
        Wrong{"Cycle",
              Chain("<link name='c'/><joint name='j' type='fixed'><parent link='c'/><child "
                    "link='b'/></joint>"
                    "\n<joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint>"),
              "f.urdf:5: joint[k]: found a cycle of joints (c -> b -> c), expected a tree"},
        Wrong{"OwnParent",
              Chain("<joint name='j' type='fixed'><parent link='b'/><child link='b'/></joint>"),
              "f.urdf:4: joint[j]: found a cycle of joints (b -> b), expected a tree"},
        Wrong{"Nan", Chain(JointAB("\n<origin xyz='0 nan 0'/>")),
              "f.urdf:5: joint[j].origin.xyz: found 'nan', expected 3 finite numbers"},
        Wrong{"Infinity", Chain(JointAB("<origin rpy='0 0 inf'/>")),
              "joint[j].origin.rpy: found 'inf'"},
        Wrong{"Overflow", Chain(JointAB("<origin xyz='0 0 1e400'/>")), "found '1e400'"},
        Wrong{"TwoNumbers", Chain(JointAB("<origin xyz='0 0'/>")),
              "joint[j].origin.xyz: found '0 0', expected 3 finite numbers"},
        Wrong{"NoNumber", Chain(JointAB("<origin xyz='0 0 x'/>")), "found 'x'"},
        Wrong{"DecimalComma", Chain(JointAB("<origin xyz='0,5 0 0'/>")), "found '0,5'"},
        Wrong{"LongAxis", Chain(JointAB("\n<axis xyz='0 0 2'/>")),
              "f.urdf:5: joint[j].axis.xyz: found (0, 0, 2) of length 2, expected a direction of "
              "length 1"},
        Wrong{"ZeroAxis", Chain(JointAB("<axis xyz='0 0 0'/>")),
              "joint[j].axis.xyz: found (0, 0, 0) of length 0"},
        Wrong{"AxisWithoutNumbers", Chain(JointAB("<axis/>")),
              "joint[j].axis: found no attribute 'xyz'"},
        Wrong{"OriginTwice", Chain(JointAB("<origin/>\n<origin/>")),
              "f.urdf:5: joint[j].origin: found <origin> twice (first in line 4), expected once"},
        Wrong{"MisspeltElement", Chain(JointAB("<orgin xyz='0 0 1'/>")),
              "joint[j]: found an unknown element <orgin>, expected an element of <joint>; did you "
              "mean 'origin'?"},
        Wrong{"MisspeltAttribute", Chain(JointAB("<origin xzy='0 0 1'/>")),
              "found an unknown attribute 'xzy', expected an attribute of <origin>; did you mean "
              "'xyz'?"},
        Wrong{"NoLimit", Chain(JointAB("", "revolute")), "f.urdf:4: joint[j]: found no <limit>"},
        Wrong{"LimitWithoutEffort",
              Chain(JointAB("<limit lower='0' upper='1' velocity='1'/>", "revolute")),
              "joint[j].limit.effort: found no attribute 'effort', expected a finite number"},
        Wrong{"LimitsExchanged",
              Chain(JointAB("<limit lower='2' upper='1' effort='1' velocity='1'/>", "revolute")),
              "joint[j].limit: found lower 2 above upper 1"},
        Wrong{"NegativeMass",
              Chain(JointAB(""), Inertial(-1, "0 0 0", "0 0 0", {0.1, 0, 0, 0.1, 0, 0.1})),
              "f.urdf:3: link[b].inertial.mass.value: found -1 kg, expected a mass that is not "
              "negative"},
        Wrong{"NoMass",
              Chain(JointAB(""),
                    "<inertial><inertia ixx='1' ixy='0' ixz='0' iyy='1' "
                    "iyz='0' izz='1'/></inertial>"),
              "f.urdf:3: link[b].inertial: found no <mass>"},
        Wrong{"MissingMoment",
              Chain(JointAB(""),
                    "<inertial><mass value='1'/><inertia ixx='1' "
                    "ixy='0' ixz='0' iyy='1' iyz='0'/></inertial>"),
              "link[b].inertial.inertia.izz: found no attribute 'izz'"},
        Wrong{"Triangle",
              Chain(JointAB(""), Inertial(1, "0 0 0", "0 0 0", {0.1, 0, 0, 0.1, 0, 0.3})),
              "f.urdf:3: bodies.b.inertia: found principal moments 0.1, 0.1, 0.3 kg m^2"},
        Wrong{"NegativeMoment",
              Chain(JointAB(""), Inertial(1, "0 0 0", "0 0 0", {-0.1, 0, 0, 0.1, 0, 0.1})),
              "bodies.b.inertia: found principal moments"},
        Wrong{"MovableWithoutInertia", Chain(JointAB(""), " "),
              "f.urdf:4: joints.j: found nothing that link 'b' carries has inertia along its "
              "coordinate 1"},
        Wrong{"MimicsNobody", Chain(JointAB("<mimic joint='k'/>")),
              "joint[j].mimic: found 'k', expected the name of a joint"},
        Wrong{"MimicsItself", Chain(JointAB("<mimic joint='j'/>")),
              "joint[j].mimic: found a joint that in the end mimics itself"},
        Wrong{"FixedMimics", Chain(JointAB("<mimic joint='j'/>", "fixed")),
              "joint[j].mimic: found a fixed joint that mimics a fixed one"},
        Wrong{"Version", "<robot name='r' version='2'>\n<link name='a'/></robot>",
              "f.urdf:1: robot.version: found '2', expected version 1.0"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(UrdfMistakes, AreAllListedInTheOrderOfLines) {
  try {
    ReadUrdfText(Chain(JointAB("\n<origin xyz='0 0 x'/>\n<axis xyz='1 1 0'/>")), "f.urdf",
                 UrdfBase::kFixed);
    FAIL();
  } catch (const io::InputError& error) {
    ASSERT_EQ(error.problems().size(), 2u);
    EXPECT_EQ(error.problems()[0].line, 5);
    EXPECT_EQ(error.problems()[1].line, 6);
  }
}

TEST(UrdfMistakes, TooManyLinks) {
  std::string text = "<robot name='r'>";
  for (int l = 0; l <= kMostUrdfLinks; ++l) text += fmt::format("<link name='l{}'/>", l);
  try {
    ReadUrdfText(text + "</robot>", "f.urdf", UrdfBase::kFixed);
    FAIL();
  } catch (const io::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected at most 2000 links"));
  }
}

TEST(UrdfMistakes, AJointNamedLikeTheFloatingBase) {
  const std::string body = Inertial(1, "0 0 0", "0 0 0", {0.1, 0, 0, 0.1, 0, 0.1});
  const std::string text =
      Robot({fmt::format("<link name='a'>{0}</link><link name='b'>{0}</link>\n", body),
             Joint("floating_base", "continuous", "a", "b", "", "1 0 0")});
  EXPECT_NO_THROW(ReadUrdfText(text, "f.urdf", UrdfBase::kFixed));
  try {
    ReadUrdfText(text, "f.urdf", UrdfBase::kFloating);
    FAIL();
  } catch (const io::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("f.urdf:3: joint[floating_base]: found a joint named"));
  }
}

TEST(Urdf, TheShippedArmIsRead) {
  const Urdf urdf = ReadUrdf(KINGPIN_SOURCE_DIR "/examples/urdf/arm.urdf", UrdfBase::kFixed);
  EXPECT_EQ(urdf.root, "base");
  EXPECT_EQ(MakeMechanism(urdf.description).system.model.velocities, 6);
}

}  // namespace
}  // namespace kingpin::joints
