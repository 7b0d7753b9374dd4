#pragma once

#include <Eigen/LU>
#include <span>
#include <vector>

#include "core/mechanism/box_problem.h"
#include "core/mechanism/system.h"

namespace kingpin::mechanism {

/// Energy of the whole system at an instant [J], [W].
struct Energy {
  double kinetic = 0;
  double potential = 0;   ///< of gravity (zero at the world's origin) and of all force elements
  double dissipated = 0;  ///< rate
  double supplied = 0;    ///< rate: by outside forces and by drives
};

/// One thread's evaluations of a system at states y = (q, v, states). Owns every scratch value;
/// nothing is allocated after construction on the regular path.
class Evaluator {
 public:
  /// Rate below which an element that sticks along with others counts as still [m/s, rad/s].
  static constexpr double kCreep = 1e-7;

  explicit Evaluator(const System& system);

  const System& system() const { return system_; }

  /// Kinematics, closures and forces at (time, y), and the accelerations and reactions that follow.
  /// @param rate out: dy/dt
  /// @throws std::runtime_error if the constraints contradict each other there, or if a force, a
  /// motion or the state is not a finite number; the message names the culprit
  void CalcRates(double time, std::span<const double> y, std::span<double> rate);

  /// R of the last CalcRates, per row: on link a of the closure, in the row's direction [N, N m].
  /// Of a row of dry friction that slides, the friction force.
  std::span<const double> reactions() const { return reaction_; }
  std::span<const double> accelerations() const { return acceleration_; }
  const Workspace<double>& workspace() const { return w_; }

  /// Dry friction: what each element of `system().friction` does, 0 sticks, ±1 slides that way.
  /// Until the first UpdateModes, friction is left out.
  std::span<const int> modes() const { return modes_; }
  /// Chooses the modes at (time, y): elements with a rate above `still` slide. The others hold each
  /// other and the mechanism at rest if their static limits allow it, in whatever distribution;
  /// those that cannot begin to slide the way the forces drive them.
  ///
  /// Of elements that stick together, a largest independent set becomes rows with reactions; the
  /// rest exerts constant forces until the next choice.
  void UpdateModes(double time, std::span<const double> y, double still);
  /// Takes dry friction out until the next UpdateModes.
  void ReleaseFriction();
  /// Per friction element, a function of the state that is positive as long as its mode holds:
  /// sliding, the rate in the direction of sliding; sticking, the static limit minus the size of
  /// its force, and, of one that is not a row, what its rate is below kCreep. After CalcRates at
  /// (time, y).
  void CalcSwitches(std::span<const double> y, std::span<double> switches) const;
  /// Rate of the row of friction element f [m/s, rad/s].
  double CalcSlip(int f, std::span<const double> y) const;

  /// What each joint of the tree transmits: the wrench on link l by its parent through the joint,
  /// world axes, about the reference point, the applied forces of drives, motors and friction along
  /// the joint's own coordinates included. After CalcRates.
  std::span<const Wrench<double>> CalcJointWrenches();

  /// Largest |Φ| [m or rad] and largest |Dᵀv - ṡ| [m/s or rad/s] at (time, y); redundant rows
  /// count, too.
  struct Residuals {
    double position = 0, velocity = 0;
  };
  Residuals CalcResiduals(double time, std::span<const double> y);

  /// Moves q, by the least kinetic-energy distance, until |Φ| <= position_tolerance, at least once
  /// unless |Φ| is rounding already; corrects v once if |Dᵀv - ṡ| > velocity_tolerance (which
  /// leaves rounding), and brings quaternions back to unit length. Rows that are not active keep
  /// what they have.
  /// @throws std::runtime_error if that fails; the message names the worst row
  void Project(double time, std::span<double> y, double position_tolerance,
               double velocity_tolerance);

  /// At (time, y) after CalcRates there.
  Energy CalcEnergy(double time, std::span<const double> y);

  /// Momentum about the world's origin, world axes: linear in f [N s], angular in t [N m s]. After
  /// CalcRates.
  Wrench<double> CalcMomentum() const;
  /// Rate of the momentum by what acts from outside, about the world's origin, world axes: gravity,
  /// the world's force elements, and its supports through joints and closures. After CalcRates.
  Wrench<double> CalcExternalWrench();

 private:
  void CalcRatesAt(double time, std::span<const double> y, std::span<double> rate);
  void ProjectPositions(double time, std::span<double> y, double tolerance);
  // dry friction: friction_modes.cpp
  void SolveWithFriction();
  void SolveAtNormals(std::span<double> found);
  bool AgreeWith(std::span<const double> found) const;
  void ImproveNormals(std::span<double> found);
  double CalcForce(int f) const;
  double CalcHighestForce(int f, bool kinetic) const;
  double CalcSlipAcceleration(const Friction& friction, std::span<const double> acceleration) const;
  void SetUpBox(double time, std::span<const double> y);
  void HoldAtRest(double time, std::span<const double> y);
  void ThrowIfNotFinite(double time, std::span<const double> y, std::span<double> rate);
  double CalcNormalForce(const Friction& friction) const;
  double CalcStaticLimit(const Friction& friction, double normal) const;
  double CalcKineticLimit(const Friction& friction, double normal, double slip) const;
  const LinearRow& GetRow(const Friction& friction) const;
  void SetMode(int f, int mode, bool held);
  void SetHeldRows(double active);
  void UpdateKinematics(double time, std::span<const double> y);
  void UpdateDrives(double time);
  double CalcPositionResiduals(const double* q);  // into residual_
  double CalcVelocityResiduals(const double* v);  // into residual_
  int FindWorstRow() const;
  void SolveForCorrection();  // correction_ from residual_

  const System& system_;
  Workspace<double> w_;
  std::vector<double> drive_, drive_rate_, drive_acceleration_;
  std::vector<int> modes_;
  bool friction_released_ = true;
  bool of_joints_ = false;             // some normal force is that of a joint of the tree
  bool depends_on_normals_ = false;    // some limit depends on one
  std::vector<double> normal_, slip_;  // per friction element
  std::vector<int> friction_row_;      // index into model.linear
  std::vector<Wrench<double>> applied_, joint_;
  std::vector<double> applied_generalised_;
  std::vector<Motion<double>> link_acceleration_;
  std::vector<double> acceleration_, reaction_, residual_, correction_, none_;
  std::vector<double> nearest_;     // y moved onto the constraints
  double largest_force_ = 0;        // of the sums that joint wrenches are the differences of
  std::vector<double> mode_rate_;   // rates while modes are chosen
  std::vector<char> held_;          // per friction element: sticks as a row
  std::vector<double> held_force_;  // that it exerts if it sticks and is no row
  std::vector<double> normal_now_, normal_base_;
  Eigen::VectorXd normal_mismatch_, normal_change_;
  Eigen::MatrixXd normal_jacobian_;
  Eigen::PartialPivLU<Eigen::MatrixXd> normal_lu_;
  BoxProblem box_;
  std::vector<int> at_rest_;  // friction elements in the box problem
  std::vector<char> moves_, candidates_;
};

}  // namespace kingpin::mechanism
