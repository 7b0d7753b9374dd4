#include "bench/benchmark_mechanisms.h"

#include <cmath>

#include "core/math/quaternion.h"
#include "core/mechanism/compile.h"
#include "core/mechanism/dynamics.h"

namespace kingpin::mechanism {

namespace {

/// Adds links whose frames at q = 0 are given in world axes, so that everything is assembled at q =
/// 0.
class Assembler {
 public:
  Assembler() {
    model_.links.emplace_back();
    model_.links[0].name = "world";
    origins_.push_back({});
  }

  /// A link at world point p, turning about or sliding along world direction `axis`.
  int Add(int parent, JointKind kind, const Vector3<double>& p, const Vector3<double>& axis,
          double mass, const Vector3<double>& centre, double size) {
    const Transform<double> X{math::MakeRotationWithZ(axis), p};
    Link link;
    link.name = "link " + std::to_string(model_.links.size());
    link.parent = parent;
    link.kind = kind;
    link.q = model_.positions;
    link.v = model_.velocities;
    link.X_PF = origins_[parent].Inverse() * X;
    link.mass = mass;
    link.centre = X.Inverse() * centre;
    for (int i = 0; i < 3; ++i) link.central_inertia[i] = mass * size * size * (1 + 0.3 * i);
    model_.positions += CountPositions(kind);
    model_.velocities += CountVelocities(kind);
    model_.links.push_back(link);
    origins_.push_back(X);
    return static_cast<int>(model_.links.size()) - 1;
  }

  /// Link a's point at world p stays on axes of link b's frame.
  void Close(int a, int b, const Vector3<double>& p, int axes = 7) {
    const int count = __builtin_popcount(axes);
    model_.points.push_back({a,
                             b,
                             origins_[a].Inverse() * p,
                             {origins_[b].R.Transpose(), origins_[b].Inverse() * p},
                             axes,
                             model_.rows});
    for (int r = 0; r < count; ++r) {
      model_.row_names.push_back("loop " + std::to_string(model_.rows));
      model_.holonomic.push_back(1);
      ++model_.rows;
    }
  }

  Model Finish(std::vector<double>& q) {
    q.assign(model_.positions, 0.0);
    for (const Link& link : model_.links) {
      if (CountPositions(link.kind) >= 4) q[link.q + CountPositions(link.kind) - 4] = 1;
    }
    CompileTopology(model_);
    CompileElimination(model_, q);
    return std::move(model_);
  }

 private:
  Model model_;
  std::vector<Transform<double>> origins_;
};

const Vector3<double> kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

}  // namespace

Model MakeBenchmarkVehicle(std::vector<double>& q) {
  Assembler a;
  const int chassis = a.Add(0, JointKind::kFree, {0, 0, 0.5}, kZ, 1200, {0, 0, 0.55}, 0.8);
  const int rack = a.Add(chassis, JointKind::kPrismatic, {1.2, 0, 0.3}, kY, 3, {1.2, 0, 0.3}, 0.2);
  for (int corner = 0; corner < 4; ++corner) {
    const double x = corner < 2 ? 1.3 : -1.3, s = corner % 2 == 0 ? 1 : -1;
    const int lower =
        a.Add(chassis, JointKind::kRevolute, {x, s * 0.35, 0.2}, kX, 4, {x, s * 0.5, 0.2}, 0.15);
    const int knuckle =
        a.Add(lower, JointKind::kSpherical, {x, s * 0.7, 0.2}, kZ, 12, {x, s * 0.72, 0.3}, 0.1);
    a.Add(knuckle, JointKind::kRevolute, {x, s * 0.75, 0.3}, kY, 20, {x, s * 0.76, 0.3}, 0.2);
    const int upper =
        a.Add(chassis, JointKind::kRevolute, {x, s * 0.4, 0.45}, kX, 2, {x, s * 0.5, 0.45}, 0.12);
    const Vector3<double> upper_ball{x - 0.02, s * 0.68, 0.45}, rod_in{x - 0.12, s * 0.38, 0.28},
        rod_out{x - 0.13, s * 0.68, 0.26};
    const int rod_parent = corner < 2 ? rack : chassis;
    const int cross = a.Add(rod_parent, JointKind::kRevolute, rod_in, kX, 0, rod_in, 0);
    const int rod =
        a.Add(cross, JointKind::kRevolute, rod_in, kZ, 0.8, {x - 0.125, s * 0.53, 0.27}, 0.1);
    a.Close(upper, knuckle, upper_ball);
    a.Close(rod, knuckle, rod_out);
  }
  return a.Finish(q);
}

Model MakeSpatialFourBars(int count, std::vector<double>& q) {
  Assembler a;
  int ground = 0;
  for (int n = 0; n < count; ++n) {
    const double x = 1.0 * n, z = 0.1 * n;
    const Vector3<double> tip{x + 0.1, 0.05, z + 0.3}, end{x + 0.8, 0.2, z + 0.5};
    const int crank =
        a.Add(ground, JointKind::kRevolute, {x, 0, z}, kY, 1, {x + 0.05, 0, z + 0.15}, 0.1);
    const int cross = a.Add(crank, JointKind::kRevolute, tip, kY, 0, tip, 0);
    const int coupler =
        a.Add(cross, JointKind::kRevolute, tip, kZ, 2, {x + 0.45, 0.1, z + 0.4}, 0.2);
    const int rocker = a.Add(ground, JointKind::kRevolute, {x + 0.9, 0, z},
                             {0.1, std::sqrt(0.99), 0}, 1.5, {x + 0.85, 0.1, z + 0.25}, 0.15);
    a.Close(coupler, rocker, end);
    ground = rocker;
  }
  return a.Finish(q);
}

Model MakePlanarFourBars(int count, std::vector<double>& q) {
  Assembler a;
  int ground = 0;
  for (int n = 0; n < count; ++n) {
    const double x = 1.0 * n, z = 0.1 * n;
    const Vector3<double> tip{x + 0.1, 0, z + 0.3}, end{x + 0.8, 0, z + 0.5};
    const int crank =
        a.Add(ground, JointKind::kRevolute, {x, 0, z}, kY, 1, {x + 0.05, 0, z + 0.15}, 0.1);
    const int coupler = a.Add(crank, JointKind::kRevolute, tip, kY, 2, {x + 0.45, 0, z + 0.4}, 0.2);
    const int rocker = a.Add(ground, JointKind::kRevolute, {x + 0.9, 0, z}, kY, 1.5,
                             {x + 0.85, 0, z + 0.25}, 0.15);
    a.Close(coupler, rocker, end);
    ground = rocker;
  }
  return a.Finish(q);
}

Model MakeChain(int bodies, bool loops, std::vector<double>& q) {
  Assembler a;
  const Vector3<double> axes[3] = {kZ, kY, kX};
  const auto get_point = [](double n) {
    return Vector3<double>{0.1 * n, 0.2 * std::cos(0.7 * n), 0.2 * std::sin(0.7 * n)};
  };
  int link = 0, last_tenth = 0;
  for (int n = 0; n < bodies; ++n) {
    link = a.Add(link, JointKind::kRevolute, get_point(n), axes[n % 3], 1, get_point(n + 0.5), 0.1);
    if (!loops || (n + 1) % 10 != 0) continue;
    a.Close(link, last_tenth, get_point(n + 1));
    last_tenth = link;
  }
  return a.Finish(q);
}

Model MakeHumanoid(std::vector<double>& q) {
  Assembler a;
  const int base = a.Add(0, JointKind::kFree, {0, 0, 1}, kZ, 20, {0, 0, 1.1}, 0.2);
  const Vector3<double> axes[3] = {kZ, kX, kY};
  const auto limb = [&](int parent, Vector3<double> p, Vector3<double> step, int joints) {
    for (int j = 0; j < joints; ++j) {
      parent = a.Add(parent, JointKind::kRevolute, p, axes[j % 3], 2, p + 0.5 * step, 0.1);
      p += step;
    }
    return parent;
  };
  limb(base, {0, 0.1, 0.9}, {0.01, 0.01, -0.14}, 6);
  limb(base, {0, -0.1, 0.9}, {0.01, -0.01, -0.14}, 6);
  const int torso = limb(base, {0, 0, 1.1}, {0, 0, 0.1}, 2);
  limb(torso, {0, 0.2, 1.4}, {0.01, 0.08, -0.05}, 7);
  limb(torso, {0, -0.2, 1.4}, {0.01, -0.08, -0.05}, 7);
  limb(torso, {0, 0, 1.5}, {0, 0, 0.1}, 2);
  return a.Finish(q);
}

}  // namespace kingpin::mechanism
