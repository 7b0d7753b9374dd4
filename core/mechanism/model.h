#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math/sparse_ldlt.h"
#include "core/math/vector3.h"

namespace kingpin::mechanism {

using math::Rotation;
using math::Transform;
using math::Vector3;

/// How a link moves against its parent. Every joint of the user's is one of these or a chain of
/// them with massless links between (cylindrical = prismatic and revolute, universal = two
/// revolutes, planar = two prismatic and a revolute).
enum class JointKind : std::uint8_t {
  kRevolute,   ///< q: angle [rad] about z of the joint frame
  kPrismatic,  ///< q: displacement [m] along z
  kScrew,      ///< q: angle [rad] about z, with `pitch` metres along z per radian
  kSpherical,  ///< q: unit quaternion (w, x, y, z); v: angular velocity in the link frame [rad/s]
  kFree,  ///< q: position of the link's origin in the joint frame [m], quaternion; v: velocity of
          ///< the origin [m/s], then angular velocity, both in the link frame
};

constexpr int CountPositions(JointKind kind) {
  return kind == JointKind::kFree ? 7 : kind == JointKind::kSpherical ? 4 : 1;
}
constexpr int CountVelocities(JointKind kind) {
  return kind == JointKind::kFree ? 6 : kind == JointKind::kSpherical ? 3 : 1;
}

/// A rigid body with the joint that carries it. Bodies fixed to each other are one link.
///
/// The link frame coincides with the joint frame F at q = 0; F is fixed in the parent link P, its z
/// axis is the joint axis. Link 0 is the world.
struct Link {
  std::string name;
  int parent = 0;
  JointKind kind = JointKind::kRevolute;
  int q = 0;  ///< first position coordinate
  int v = 0;  ///< first velocity coordinate
  double pitch = 0;
  Transform<double> X_PF;
  double mass = 0;
  Vector3<double> centre;  ///< centre of mass in the link frame [m]
  double
      central_inertia[6]{};  ///< Jxx, Jyy, Jzz, Jxy, Jxz, Jyz about it, in the link frame [kg m^2]
};

/// A frame fixed in a link.
struct Frame {
  int link = 0;
  Transform<double> X_LF;
};

// Constraints. Each has one or more rows; row r asks for Φ_r(q, t) = 0 and, by its time derivative,
// for W_r·(V_a - V_b) = rate_r(t), with V the motions of two links and W_r the wrench that the
// reaction of unit size exerts on link a; link b gets -W_r. Rows of coordinates (LinearRow) act on
// the coordinates themselves.

/// A point of link a stays on the axes of a frame of link b: the rows are the coordinates of the
/// point in that frame, those whose bit is set. xyz is a spherical joint, xy a point on the line
/// along z, x a point on the plane normal to x.
struct PointClosure {
  int a = 0, b = 0;
  Vector3<double> p_A;     ///< in link a
  Transform<double> X_BF;  ///< in link b
  int axes = 7;            ///< bit 0: x, 1: y, 2: z
  int row = 0;             ///< first row
};

/// A direction of link a stays perpendicular to one of link b: one row, u·w = 0.
struct PerpendicularClosure {
  int a = 0, b = 0;
  Vector3<double> u_A, w_B;  ///< unit vectors in link a and in link b
  int row = 0;
};

/// Two points keep their distance: one row, (|d|² - l²)/(2 l) = 0.
struct DistanceClosure {
  int a = 0, b = 0;
  Vector3<double> p_A, p_B;
  double length = 1;
  int row = 0;
};

/// Σ c_i q_i = s(t): gears, rack and pinion, differentials, prescribed motion. The coordinates
/// belong to one-degree-of-freedom joints, or the row is `rate_only`: Σ c_i v_i = ṡ(t).
struct LinearRow {
  struct Term {
    int q = 0, v = 0;
    double factor = 1;
  };
  std::vector<Term> terms;
  bool rate_only = false;
  int row = 0;
};

/// A knife-edged disc of link a rolls without slip on a plane of link b (normal z of the frame):
/// three rows, contact on the plane (z) and no slip along x and y of the frame. The slip rows are
/// nonholonomic: they have no Φ.
struct RollingDisc {
  int a = 0, b = 0;
  Vector3<double> centre_A, axis_A;
  double radius = 1;
  Transform<double> X_BF;
  int row = 0;
};

/// The compiled mechanism: flat arrays in evaluation order (parents before children, subtrees
/// contiguous). Immutable once made, shared by all threads; every scratch value lives in a
/// Workspace.
struct Model {
  std::vector<Link> links;  ///< [0] is the world
  int positions = 0;        ///< size of q
  int velocities = 0;       ///< size of v, F, accelerations
  int rows = 0;             ///< size of R
  Vector3<double> gravity{0, 0, -9.80665};

  std::vector<PointClosure> points;
  std::vector<PerpendicularClosure> perpendiculars;
  std::vector<DistanceClosure> distances;
  std::vector<LinearRow> linear;
  std::vector<RollingDisc> discs;
  std::vector<std::string> row_names;
  std::vector<char> holonomic;  ///< per row: has a Φ
  std::vector<char>
      switching;  ///< per row: comes and goes (dry friction); never stands in for a row that stays

  /// The link whose origin is the point that all motions and wrenches refer to: the first free
  /// root, so that a vehicle far from the world's origin loses no digits; 0 (the world's origin)
  /// without one.
  int reference_link = 0;

  std::vector<int> dof_link;    ///< link of each velocity coordinate
  std::vector<int> dof_parent;  ///< the coordinate before it on the way to the root, or -1

  /// Where the velocity coordinates enter a row: sign +1 on the way from a to the common ancestor,
  /// -1 from b.
  struct Support {
    int dof = 0;
    int sign = 1;
  };
  std::vector<Support> supports;   ///< of all link rows, row by row
  std::vector<int> support_begin;  ///< per row, size rows + 1; empty for linear rows

  // Deep trees are cut, so that the cost of an evaluation grows with the number of links and not
  // with its cube: see segments.h for the equations.

  /// A part of the tree below a cut. [0] is the part that hangs on the world, uncut.
  struct Segment {
    int link = 0;    ///< the link that is cut; its origin is the segment's own reference point
    int parent = 0;  ///< segment of that link's other half
  };
  std::vector<Segment> segments = std::vector<Segment>(1);
  std::vector<int> segment;         ///< per link: of the half that its joint carries
  std::vector<int> starts_segment;  ///< per link: the segment that begins with it, or 0
  /// Per link: what its inertia is handed to: the parent link, links.size() + s - 1 for the half of
  /// the parent that segment s begins with, or 0, the world.
  std::vector<int> carrier;
  std::vector<int> segment_parent;  ///< dof_parent within the segment, else -1

  /// Unknowns of the equations: velocities, then six per cut; then rows, then six per cut.
  int coordinates = 0;
  int CountCuts() const { return static_cast<int>(segments.size()) - 1; }
  int unknowns() const { return coordinates + rows + 6 * CountCuts(); }
  int GetCutCoordinate(int segment) const { return velocities + 6 * (segment - 1); }
  int GetCutRow(int segment) const { return coordinates + rows + 6 * (segment - 1); }

  /// Where velocity coordinates enter a row of the equations: as in `supports`, but only within the
  /// segments of the two links.
  struct RowTerm {
    int dof = 0;
    int sign = 1;
    int slot = 0;  ///< of (dof, row) in the factor's storage
  };
  std::vector<RowTerm> row_terms;
  std::vector<int> row_term_begin;  ///< per row, size rows + 1
  /// Where the six coordinates of a cut enter a row.
  struct CutTerm {
    int row = 0;
    int segment = 0;
    int sign = 1;
    int slots[6]{};
  };
  std::vector<CutTerm> cut_terms;
  std::vector<int> linear_slots;  ///< of all terms of all linear rows
  std::vector<int> fill_slots;    ///< that the assembly leaves alone: zero before an elimination
  std::vector<int> cut_slots;     ///< of everything else that belongs to cuts, as segments.h reads

  /// Slots of M: for coordinate i, of (i, i) and of (i, j) for the ancestors j = segment_parent[i],
  /// ... up to the root of the segment, then of the six coordinates of its cut.
  std::vector<int> mass_slots;
  std::vector<int> mass_begin;  ///< per velocity coordinate, size velocities + 1

  /// Elimination of [M, D; Dᵀ, 0], order chosen once (elimination_order.h). Unknown coordinates + r
  /// is row r.
  math::SparseLdltPattern pattern;
  std::vector<char> redundant;  ///< per row: follows from the others; its reaction is taken as zero
  /// Whether the equations hold R_r = 0 instead of row r, for good: it is redundant and does not
  /// come and go.
  bool IsLeftOut(int r) const { return redundant[r] && !switching[r]; }
  /// Per elimination step, the value that the pivot must lie beyond (positive for coordinates,
  /// negative for rows).
  std::vector<double> pivot_limits;
};

}  // namespace kingpin::mechanism
