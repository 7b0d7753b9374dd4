#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "models/planar/excitation.h"
#include "models/planar/parameters.h"
#include "models/planar/simulate.h"

/// The planar model integrated by CVODE (variable order and step, error per component controlled):
/// the solution every fast method is compared with.
///
/// A run is cut into pieces on which the right side is smooth. Cuts are the kinks of the
/// excitation (stop times) and the events of switching elements:
///
/// - set-valued Coulomb friction, a machine of three states. Sliding (+ or −) ends when the speed
///   crosses zero; the rack then sticks if the reaction that holds it stays within the limit,
///   else slides on in the direction of the push. Sticking ends when |reaction| exceeds the limit.
///   While it sticks, speed and acceleration of the rack are exactly zero
/// - torsion-bar stops: twist crosses ±θ_s
/// - free play: elongation crosses ±s/2
/// - the sign of the normal force |F_R e_x|, where the limit has a kink
///
/// Each step is searched for the earliest crossing by sign at five points of its dense output and
/// by bisection to neighbouring numbers; the integration restarts there. CVODE's own root finder is
/// not used: version 6.4.1 looks at the ends of steps only, and gives up ("root found at and very
/// near t") where an element switches right after a restart, as a rattling joint does. Where it did
/// not give up, the two agreed to 1e-13 s.
///
/// The Jacobian is exact (`math::Dual`). One SUNDIALS context per run: runs may go in parallel.
namespace kingpin::planar {

enum class Multistep {
  kAuto,   ///< kBdf when the fastest pole decays much faster than anything oscillates
  kAdams,  ///< orders 1 to 12, for damping that is not stiff
  kBdf,    ///< orders 1 to 5
};

std::string_view ToString(Multistep method);

struct ReferenceOptions {
  double duration = 1.0;          ///< [s]
  double sample_interval = 1e-3;  ///< [s], as in SimulationOptions
  double relative_tolerance = 1e-11;
  /// The absolute tolerance is this times a typical size of each state (1 mm, 10 mrad, ...).
  double absolute_tolerance = 1e-13;
  Multistep method = Multistep::kAuto;
  std::array<double, 5> initial_position{};  ///< q at t = 0
  std::array<double, 5> initial_velocity{};
};

enum class EventKind {
  kStick,
  kSlip,
  kStopContact,
  kStopRelease,
  kPlayContact,
  kPlayRelease,
  kNormalForceSign
};

std::string_view ToString(EventKind kind);

struct Event {
  double time = 0.0;  ///< [s]
  EventKind kind = EventKind::kStick;
  /// kSlip: direction of sliding; stops and play: side; else 0.
  int direction = 0;
};

struct ReferenceStatistics {
  Multistep method = Multistep::kBdf;  ///< the one used
  long steps = 0;
  long force_evaluations = 0;
  long jacobians = 0;
  long error_test_failures = 0;
  long nonlinear_failures = 0;
  long restarts = 0;           ///< cuts: kinks and events
  std::vector<Event> events;   ///< in the order of time
  double sticking_time = 0.0;  ///< [s]
};

struct ReferenceRun {
  History history;
  ReferenceStatistics statistics;
};

/// @throws io::InputError as Simulate does, and for tolerances that are not positive.
/// @throws io::RunError when CVODE gives up, the state diverges or events do not end; with the
/// time.
ReferenceRun SimulateReference(const Parameters<double>& parameters, const Excitation& excitation,
                               const ReferenceOptions& options = {});

}  // namespace kingpin::planar
