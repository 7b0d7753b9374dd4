#pragma once

#include <random>
#include <vector>

#include "core/math/quaternion.h"
#include "core/mechanism/model.h"

namespace kingpin::mechanism {

/// Models and states that no one has chosen, from a fixed seed.
class RandomMechanism {
 public:
  explicit RandomMechanism(unsigned seed) : random_(seed) {}

  double Normal() { return normal_(random_); }
  Vector3<double> NormalVector() { return {Normal(), Normal(), Normal()}; }
  Vector3<double> UnitVector() {
    const Vector3<double> a = NormalVector();
    return (1.0 / CalcNorm(a)) * a;
  }
  Rotation<double> MakeRotation() {
    return math::MakeRotation(math::MakeQuaternion(NormalVector()));
  }

  /// A tree of `links` links with joints of the given kinds. Parents are drawn so that subtrees
  /// stay contiguous (depth first).
  Model MakeTree(int links, const std::vector<JointKind>& kinds) {
    Model model;
    model.links.emplace_back();
    model.links[0].name = "world";
    std::vector<int> path = {0};
    for (int l = 1; l <= links; ++l) {
      // step back by a random number of levels, at most to the world
      while (path.size() > 1 && random_() % 3 == 0) path.pop_back();
      Link link;
      link.name = "link " + std::to_string(l);
      link.parent = path.back();
      link.kind = kinds[random_() % kinds.size()];
      link.q = model.positions;
      link.v = model.velocities;
      link.pitch = link.kind == JointKind::kScrew ? 0.3 * Normal() : 0;
      link.X_PF = {MakeRotation(), NormalVector()};
      link.mass = 0.5 + std::abs(Normal());
      link.centre = 0.3 * NormalVector();
      // central inertia of four random point masses: always physical
      double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
      for (int k = 0; k < 4; ++k) {
        const Vector3<double> r = 0.4 * NormalVector();
        xx += r.x * r.x, yy += r.y * r.y, zz += r.z * r.z;
        xy += r.x * r.y, xz += r.x * r.z, yz += r.y * r.z;
      }
      const double tensor[6] = {yy + zz, xx + zz, xx + yy, -xy, -xz, -yz};
      std::copy(tensor, tensor + 6, link.central_inertia);
      model.positions += CountPositions(link.kind);
      model.velocities += CountVelocities(link.kind);
      model.links.push_back(link);
      path.push_back(l);
    }
    return model;
  }

  std::vector<double> MakePositions(const Model& model) {
    std::vector<double> q(model.positions);
    for (double& x : q) x = Normal();
    for (const Link& link : model.links) {
      if (CountPositions(link.kind) < 4) continue;
      double* e = &q[link.q + CountPositions(link.kind) - 4];
      const double norm = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3]);
      for (int i = 0; i < 4; ++i) e[i] /= norm;
    }
    return q;
  }

  std::vector<double> MakeVelocities(const Model& model) {
    std::vector<double> v(model.velocities);
    for (double& x : v) x = Normal();
    return v;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

inline const std::vector<JointKind> kAllKinds = {JointKind::kRevolute, JointKind::kPrismatic,
                                                 JointKind::kScrew, JointKind::kSpherical,
                                                 JointKind::kFree};

}  // namespace kingpin::mechanism
