#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "joints/mechanism.h"

namespace kingpin::joints {

/// A second formulation of the mechanics, for comparison: every body has six coordinates of its
/// own, and every joint, closure, coupling and motion is a set of constraint equations on them,
///
///   [ M  Aᵀ ; A  0 ] [a ; -R] = [F ; γ],
///
/// M with mass and inertia about the centres of mass in world axes, A and γ from Φ̈ = A a - γ of
/// each equation, solved densely. It shares with the engine the description of a mechanism, the
/// places of joints in q and v, and nothing else: rotations, kinematics and equations are its own.
///
/// Source: Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems (1989), chapters 9
/// and 11; the equations are differentiated here.
class AbsoluteFormulation {
 public:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  /// Force at a point of a body and torque, both in world axes.
  struct Load {
    std::string body;
    Vector point, force, torque;
  };

  AbsoluteFormulation(const MechanismDescription& description, const Mechanism& places)
      : description_(description), places_(places) {
    for (const BodyDescription& body : description.bodies) {
      const int index = static_cast<int>(bodies_.size());
      index_[body.name] = index;
      Body b;
      b.mass = body.mass;
      b.centre = Convert(body.centre);
      const auto& J = body.central_inertia;
      b.inertia << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
      bodies_.push_back(b);
    }
    index_[kWorld] = -1;
  }

  /// Poses and velocities of all bodies at y, then accelerations and reactions under gravity and
  /// the loads.
  void Solve(const std::vector<double>& y, double time, const std::vector<Load>& loads) {
    placed_.assign(bodies_.size(), 0);
    for (const JointDescription& joint : description_.joints) Place(joint, y);
    MakeRows(time);
    const int n = 6 * static_cast<int>(bodies_.size()), m = static_cast<int>(rows_.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n + m);
    for (size_t i = 0; i < bodies_.size(); ++i) {
      const Body& b = bodies_[i];
      const Matrix J = b.R * b.inertia * b.R.transpose();
      const int at = 6 * static_cast<int>(i);
      K.block<3, 3>(at, at) = b.mass * Matrix::Identity();
      K.block<3, 3>(at + 3, at + 3) = J;
      right.segment<3>(at) = b.mass * Convert(description_.gravity);
      right.segment<3>(at + 3) = -b.w.cross(J * b.w);
    }
    for (const Load& load : loads) {
      const int i = index_.at(load.body);
      const Body& b = bodies_[i];
      right.segment<3>(6 * i) += load.force;
      right.segment<3>(6 * i + 3) +=
          load.torque + (b.R * (load.point - b.centre)).cross(load.force);
    }
    for (int r = 0; r < m; ++r) {
      for (const Entry& entry : rows_[r].entries) {
        if (entry.body < 0) continue;
        K.block<1, 6>(n + r, 6 * entry.body) += entry.gradient.transpose();
        K.block<6, 1>(6 * entry.body, n + r) += entry.gradient;
      }
      right[n + r] = rows_[r].right;
    }
    // units in which masses are one; complete orthogonal decomposition: dependent rows share their
    // reaction, the accelerations are unique
    Eigen::VectorXd unit = Eigen::VectorXd::Ones(n + m);
    unit.head(n) = K.diagonal().head(n).cwiseSqrt().cwiseInverse();
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(unit.asDiagonal() * K *
                                                                   unit.asDiagonal());
    rank_ = static_cast<int>(solver.rank()) - n;
    const Eigen::VectorXd pivots = solver.matrixQTZ().diagonal().head(solver.rank()).cwiseAbs();
    condition_ = pivots.maxCoeff() / pivots.minCoeff();
    const Eigen::MatrixXd scaled = unit.asDiagonal() * K * unit.asDiagonal();
    Eigen::VectorXd x = solver.solve(unit.asDiagonal() * right);
    x += solver.solve(unit.asDiagonal() * right - scaled * x);
    x = unit.asDiagonal() * x;
    acceleration_ = x.head(n);
    reaction_ = -x.tail(m);
  }

  /// Number of constraint equations less their rank.
  int CountDependentRows() const { return static_cast<int>(rows_.size()) - rank_; }

  /// Largest over smallest pivot of the equations in units that make masses one: what rounding is
  /// magnified by.
  double condition() const { return condition_; }

  /// dv/dt in the engine's coordinates, from the bodies' accelerations.
  Eigen::VectorXd CalcJointAccelerations() const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(places_.system.model.velocities);
    for (const JointDescription& joint : description_.joints) {
      if (joint.type == JointType::kFixed) continue;
      const Mechanism::JointPlace& place = places_.GetJoint(joint.name);
      const Point P = CalcPoint(joint.parent), C = CalcPoint(joint.child);
      const Vector d = C.p - P.p, wrel = C.w - P.w, alpha = C.alpha - P.alpha;
      const Vector u = C.v - P.v - P.w.cross(d);
      const Vector u_dot = C.a - P.a - P.alpha.cross(d) - P.w.cross(C.v - P.v);
      if (joint.type == JointType::kSpherical) {
        result.segment<3>(place.v) = C.R.transpose() * (alpha - C.w.cross(wrel));
      } else if (joint.type == JointType::kFree) {
        result.segment<3>(place.v) = C.R.transpose() * (u_dot - C.w.cross(u));
        result.segment<3>(place.v + 3) = C.R.transpose() * (alpha - C.w.cross(wrel));
      } else {
        for (int i = 0; i < place.velocities; ++i) {
          Row row;
          AddCoordinate(joint, i, 1, row);
          double sum = -row.right;
          for (const Entry& entry : row.entries) {
            if (entry.body < 0) continue;
            sum += entry.gradient.dot(acceleration_.segment<6>(6 * entry.body));
          }
          result[place.v + i] = sum;
        }
      }
    }
    return result;
  }

  /// R of a closure, coupling or motion.
  std::vector<double> GetReaction(const std::string& name) const {
    std::vector<double> values;
    for (size_t r = 0; r < rows_.size(); ++r) {
      if (rows_[r].name == name) values.push_back(reaction_[static_cast<int>(r)]);
    }
    return values;
  }

  /// What a joint exerts on its child: torque about the world's origin, and force, world axes.
  Eigen::Matrix<double, 6, 1> CalcJointWrench(const JointDescription& joint) const {
    Eigen::Matrix<double, 6, 1> wrench = Eigen::Matrix<double, 6, 1>::Zero();
    const int child = index_.at(joint.child.body);
    const Vector centre = bodies_[child].CalcCentre();
    for (size_t r = 0; r < rows_.size(); ++r) {
      for (const Entry& entry : rows_[r].entries) {
        if (entry.joint != &joint || entry.body != child) continue;
        const Vector force = reaction_[static_cast<int>(r)] * entry.gradient.head<3>();
        const Vector torque = reaction_[static_cast<int>(r)] * entry.gradient.tail<3>();
        wrench.head<3>() += torque + centre.cross(force);
        wrench.tail<3>() += force;
      }
    }
    return wrench;
  }

  /// Pose of a frame, by this formulation's own kinematics, after Solve or `Move`.
  std::pair<Matrix, Vector> CalcPose(const FrameDescription& frame) const {
    const Point point = CalcPoint(frame);
    return {point.R, point.p};
  }
  void Move(const std::vector<double>& y) {
    placed_.assign(bodies_.size(), 0);
    acceleration_ = Eigen::VectorXd::Zero(6 * static_cast<int>(bodies_.size()));
    for (const JointDescription& joint : description_.joints) Place(joint, y);
  }

 private:
  struct Body {
    double mass = 0;
    Vector centre = Vector::Zero();  // in the body
    Matrix inertia = Matrix::Identity(), R = Matrix::Identity();
    Vector p = Vector::Zero(), v = Vector::Zero(), w = Vector::Zero();  // of the frame's origin
    Vector CalcCentre() const { return p + R * centre; }
  };
  // A frame of a body: pose, velocity, acceleration of its origin.
  struct Point {
    Matrix R = Matrix::Identity();
    Vector p = Vector::Zero(), v = Vector::Zero(), w = Vector::Zero(), a = Vector::Zero(),
           alpha = Vector::Zero();
    Vector arm = Vector::Zero();          // from the centre of mass
    Vector centripetal = Vector::Zero();  // ω×(ω×arm)
    int body = -1;
  };
  struct Entry {
    int body;
    const JointDescription* joint;  // through which it acts
    Eigen::Matrix<double, 6, 1> gradient;
  };
  struct Row {
    std::string name;
    std::vector<Entry> entries;
    double right = 0;
  };

  static Vector Convert(const Vector3<double>& a) { return {a.x, a.y, a.z}; }
  static Matrix Convert(const Rotation<double>& R) {
    Matrix m;
    m << Convert(R.x), Convert(R.y), Convert(R.z);
    return m;
  }
  static Matrix Turn(const Vector& axis, double angle) {
    Matrix hat;
    hat << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
    return Matrix::Identity() + std::sin(angle) * hat + (1 - std::cos(angle)) * hat * hat;
  }
  static Matrix MakeFromQuaternion(const double* e) {
    const double w = e[0], x = e[1], y = e[2], z = e[3];
    Matrix R;
    R << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
    return R;
  }

  Point CalcPoint(const FrameDescription& frame) const {
    Point point;
    const Matrix R = Convert(frame.X_BF.R);
    const Vector r = Convert(frame.X_BF.p);
    point.body = index_.at(frame.body);
    if (point.body < 0) {
      point.R = R, point.p = r;
      return point;
    }
    const Body& b = bodies_[point.body];
    point.R = b.R * R;
    point.p = b.p + b.R * r;
    point.w = b.w;
    point.v = b.v + b.w.cross(b.R * r);
    point.arm = b.R * (r - b.centre);
    point.centripetal = b.w.cross(b.w.cross(point.arm));
    if (acceleration_.size() > 0) {
      point.alpha = acceleration_.segment<3>(6 * point.body + 3);
      point.a = acceleration_.segment<3>(6 * point.body) + point.alpha.cross(point.arm) +
                point.centripetal;
    }
    return point;
  }

  void Place(const JointDescription& joint, const std::vector<double>& y) {
    const int child = index_.at(joint.child.body), parent = index_.at(joint.parent.body);
    if (placed_[child]) return;
    if (parent >= 0 && !placed_[parent]) {
      for (const JointDescription& other : description_.joints) {
        if (other.child.body == joint.parent.body) Place(other, y);
      }
    }
    const Point P = CalcPoint(joint.parent);
    const double *q = nullptr, *v = nullptr;
    if (joint.type != JointType::kFixed) {
      const Mechanism::JointPlace& place = places_.GetJoint(joint.name);
      q = &y[place.q];
      v = &y[places_.system.model.positions + place.v];
    }
    const Vector n = Convert(joint.axis), n2 = Convert(joint.second_axis), z(0, 0, 1);
    // of frame C in P: rotation, translation, and their rates
    Matrix R = Matrix::Identity();
    Vector p = Vector::Zero(), w = Vector::Zero(), u = Vector::Zero();
    switch (joint.type) {
      case JointType::kFixed:
        break;
      case JointType::kRevolute:
        R = Turn(n, q[0]), w = n * v[0];
        break;
      case JointType::kPrismatic:
        p = n * q[0], u = n * v[0];
        break;
      case JointType::kScrew:
        R = Turn(n, q[0]), w = n * v[0], p = joint.pitch * q[0] * n, u = joint.pitch * v[0] * n;
        break;
      case JointType::kCylindrical:
        p = n * q[0], u = n * v[0], R = Turn(n, q[1]), w = n * v[1];
        break;
      case JointType::kUniversal:
        R = Turn(n, q[0]) * Turn(n2, q[1]), w = n * v[0] + Turn(n, q[0]) * n2 * v[1];
        break;
      case JointType::kPlanar:
        p = Vector(q[0], q[1], 0), u = Vector(v[0], v[1], 0), R = Turn(z, q[2]), w = z * v[2];
        break;
      case JointType::kSpherical:
        R = MakeFromQuaternion(q), w = R * Vector(v[0], v[1], v[2]);
        break;
      case JointType::kFree:
        R = MakeFromQuaternion(q + 3), w = R * Vector(v[3], v[4], v[5]);
        p = Vector(q[0], q[1], q[2]), u = R * Vector(v[0], v[1], v[2]);
        break;
    }
    Body& b = bodies_[child];
    const Matrix R_WC = P.R * R;
    b.R = R_WC * Convert(joint.child.X_BF.R).transpose();
    b.w = P.w + P.R * w;
    const Vector r = b.R * Convert(joint.child.X_BF.p);
    const Vector d = P.R * p;
    b.p = P.p + d - r;
    b.v = P.v + P.w.cross(d) + P.R * u - b.w.cross(r);
    placed_[child] = 1;
  }

  static void AddEntry(Row& row, const JointDescription* joint, const Point& at,
                       const Vector& force, const Vector& torque) {
    Entry entry{at.body, joint, {}};
    entry.gradient << force, at.arm.cross(force) + torque;
    row.entries.push_back(entry);
  }

  // factor n·(p_C - p_P), n fixed with P.
  static void AddDisplacement(const JointDescription* joint, const Point& P, const Point& C,
                              const Vector& n, double factor, Row& row) {
    const Vector d = C.p - P.p, f = factor * n;
    AddEntry(row, joint, C, f, Vector::Zero());
    AddEntry(row, joint, P, -f, -d.cross(f));  // (α×n)·d = α·(n×d)
    row.right -= f.dot(C.centripetal - P.centripetal) + 2 * P.w.cross(f).dot(C.v - P.v) +
                 P.w.cross(P.w.cross(f)).dot(d);
  }
  // u·w = 0, u fixed with A, w with B.
  static void AddPerpendicular(const JointDescription* joint, const Point& A, const Point& B,
                               const Vector& u, const Vector& w, Row& row) {
    AddEntry(row, joint, A, Vector::Zero(), u.cross(w));
    AddEntry(row, joint, B, Vector::Zero(), w.cross(u));
    row.right -= A.w.cross(A.w.cross(u)).dot(w) + 2 * A.w.cross(u).dot(B.w.cross(w)) +
                 u.dot(B.w.cross(B.w.cross(w)));
  }
  // factor times the rate of turn of C against P about n, which turns with `carrier`.
  static void AddTurn(const JointDescription* joint, const Point& P, const Point& C,
                      const Vector& n, const Vector& carrier, double factor, Row& row) {
    AddEntry(row, joint, C, Vector::Zero(), factor * n);
    AddEntry(row, joint, P, Vector::Zero(), -factor * n);
    row.right -= factor * carrier.cross(n).dot(C.w - P.w);
  }

  // factor times a joint's coordinate.
  void AddCoordinate(const JointDescription& joint, int coordinate, double factor, Row& row) const {
    const Point P = CalcPoint(joint.parent), C = CalcPoint(joint.child);
    const Vector n = P.R * Convert(joint.axis);
    const auto slide = [&](const Vector& axis) {
      AddDisplacement(&joint, P, C, axis, factor, row);
    };
    const auto turn = [&](const Vector& axis) { AddTurn(&joint, P, C, axis, P.w, factor, row); };
    switch (joint.type) {
      case JointType::kRevolute:
      case JointType::kScrew:
        turn(n);
        break;
      case JointType::kPrismatic:
        slide(n);
        break;
      case JointType::kCylindrical:
        coordinate == 0 ? slide(n) : turn(n);
        break;
      case JointType::kUniversal:
        if (coordinate == 0) {
          turn(n);
        } else {
          AddTurn(&joint, P, C, C.R * Convert(joint.second_axis), C.w, factor, row);
        }
        break;
      case JointType::kPlanar:
        if (coordinate < 2) {
          slide(P.R.col(coordinate));
        } else {
          turn(P.R.col(2));
        }
        break;
      default:
        break;
    }
  }

  void MakeRows(double time) {
    rows_.clear();
    for (const JointDescription& joint : description_.joints) AddJoint(joint);
    for (const ClosureDescription& closure : description_.closures) AddClosure(closure);
    for (const CouplingDescription& coupling : description_.couplings) {
      Row row;
      row.name = coupling.name;
      for (const CouplingDescription::Term& term : coupling.terms) {
        AddCoordinate(FindJoint(term.joint), term.coordinate, term.factor, row);
      }
      rows_.push_back(row);
    }
    for (const MotionDescription& motion : description_.motions) {
      Row row;
      row.name = motion.name;
      AddCoordinate(FindJoint(motion.joint), motion.coordinate, 1, row);
      row.right += motion.motion(time)[2];
      rows_.push_back(row);
    }
  }

  const JointDescription& FindJoint(const std::string& name) const {
    for (const JointDescription& joint : description_.joints) {
      if (joint.name == name) return joint;
    }
    throw std::out_of_range(name);
  }

  void AddJoint(const JointDescription& joint) {
    const Point P = CalcPoint(joint.parent), C = CalcPoint(joint.child);
    const bool planar = joint.type == JointType::kPlanar;
    const Vector n = planar ? Vector(P.R.col(2)) : Vector(P.R * Convert(joint.axis));
    const Vector s = n.unitOrthogonal(), t = n.cross(s);
    const Vector n_C = planar ? Vector(C.R.col(2)) : Vector(C.R * Convert(joint.axis));
    const auto slide = [&](const Vector& axis) {
      Row row;
      AddDisplacement(&joint, P, C, axis, 1, row);
      rows_.push_back(row);
    };
    const auto square = [&](const Vector& in_C, const Vector& in_P) {
      Row row;
      AddPerpendicular(&joint, C, P, in_C, in_P, row);
      rows_.push_back(row);
    };
    const auto point = [&] { slide(n), slide(s), slide(t); };
    const auto parallel = [&] { square(n_C, s), square(n_C, t); };
    const auto fixed_turn = [&] {
      square(C.R.col(0), P.R.col(1)), square(C.R.col(1), P.R.col(2));
      square(C.R.col(2), P.R.col(0));
    };
    switch (joint.type) {
      case JointType::kFixed:
        point(), fixed_turn();
        break;
      case JointType::kRevolute:
        point(), parallel();
        break;
      case JointType::kPrismatic:
        slide(s), slide(t), fixed_turn();
        break;
      case JointType::kScrew: {
        slide(s), slide(t), parallel();
        Row row;
        AddDisplacement(&joint, P, C, n, 1, row);
        AddTurn(&joint, P, C, n, P.w, -joint.pitch, row);
        rows_.push_back(row);
        break;
      }
      case JointType::kCylindrical:
        slide(s), slide(t), parallel();
        break;
      case JointType::kUniversal:
        point(), square(C.R * Convert(joint.second_axis), n);
        break;
      case JointType::kPlanar:
        slide(n), parallel();
        break;
      case JointType::kSpherical:
        point();
        break;
      case JointType::kFree:
        break;
    }
  }

  void AddClosure(const ClosureDescription& closure) {
    const Point A = CalcPoint(closure.a), B = CalcPoint(closure.b);
    const auto add = [&](auto&& fill) {
      Row row;
      row.name = closure.name;
      fill(row);
      rows_.push_back(row);
    };
    const auto slide = [&](int axis) {
      add([&](Row& row) { AddDisplacement(nullptr, B, A, B.R.col(axis), 1, row); });
    };
    const auto square = [&](int a, int b) {
      add([&](Row& row) { AddPerpendicular(nullptr, A, B, A.R.col(a), B.R.col(b), row); });
    };
    // the torques are about x and y of b's frame: z × -y and z × x
    const auto parallel = [&] {
      add([&](Row& row) { AddPerpendicular(nullptr, A, B, A.R.col(2), -B.R.col(1), row); });
      square(2, 0);
    };
    const auto point = [&] { slide(0), slide(1), slide(2); };
    switch (closure.type) {
      case ClosureType::kSpherical:
        point();
        break;
      case ClosureType::kPointOnLine:
        slide(0), slide(1);
        break;
      case ClosureType::kPointOnPlane:
        slide(2);
        break;
      case ClosureType::kDistance:
        add([&](Row& row) {
          const Vector d = A.p - B.p, n = d.normalized(), u = A.v - B.v;
          AddEntry(row, nullptr, A, n, Vector::Zero());
          AddEntry(row, nullptr, B, -n, Vector::Zero());
          row.right -= u.squaredNorm() / d.norm() + n.dot(A.centripetal - B.centripetal);
        });
        break;
      case ClosureType::kParallelAxes:
        parallel();
        break;
      case ClosureType::kPerpendicular:
        square(2, 0);
        break;
      case ClosureType::kRevolute:
        point(), parallel();
        break;
      case ClosureType::kPrismatic:
        slide(0), slide(1), parallel(), square(0, 1);
        break;
      case ClosureType::kCylindrical:
        slide(0), slide(1), parallel();
        break;
      case ClosureType::kUniversal:
        point(), square(2, 0);
        break;
      case ClosureType::kFixed:
        point(), parallel(), square(0, 1);
        break;
      case ClosureType::kRollingDisc:
        throw std::invalid_argument("rolling discs are not written in this formulation");
    }
  }

  const MechanismDescription& description_;
  const Mechanism& places_;
  std::map<std::string, int> index_;
  std::vector<Body> bodies_;
  std::vector<char> placed_;
  std::vector<Row> rows_;
  Eigen::VectorXd acceleration_, reaction_;
  int rank_ = 0;
  double condition_ = 1;
};

}  // namespace kingpin::joints
