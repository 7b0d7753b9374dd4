#include "models/planar/reference_simulation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "core/io/error.h"
#include "core/math/dual.h"
#include "models/planar/accelerations.h"
#include "models/planar/linear_modes.h"
#include "models/planar/linear_promotion.h"
#include "models/planar/planar_forces.h"
#include "models/planar/validate.h"

namespace kingpin::planar {
namespace {

// State vector: q, q̇, extra states, dissipated energy, supplied energy.
constexpr int kExtra = 2 * kCoordinates;
constexpr int kMechanical = kExtra + kExtraStates;
constexpr int kDissipated = kMechanical;
constexpr int kSupplied = kMechanical + 1;
constexpr int kStates = kMechanical + 2;
constexpr int kRackSpeed = kCoordinates + 3;

using StateArray = std::array<double, kStates>;
using Scalar = math::Dual<double, kMechanical>;

// Which branch every switching element is on.
struct Mode {
  bool coulomb = false;
  double slip = 0.0;    // sign of sliding, 0: sticks
  int stop = 0;         // −1, 0, 1: which stop is in contact
  int play = 0;         // −1 compression, 0 gap, 1 tension
  int normal_sign = 0;  // of F_R e_x; 0: not watched
};

enum Switch { kFriction, kUpperStop, kLowerStop, kUpperPlay, kLowerPlay, kNormal, kSwitchCount };

template <class S>
State<S> MakeState(const double* y) {
  State<S> x{};
  for (int i = 0; i < kCoordinates; ++i) {
    x.q[i] = S(y[i]);
    x.v[i] = S(y[kCoordinates + i]);
  }
  for (int i = 0; i < kExtraStates; ++i) x.extra[i] = S(y[kExtra + i]);
  return x;
}

class Integration {
 public:
  Integration(const Parameters<double>& parameters, const Excitation& excitation,
              const ReferenceOptions& options)
      : options_(options),
        excitation_(excitation),
        samples_(CalcSampleIntervals(options.duration, options.sample_interval, 1.0)),
        model_(MakeModel(parameters)),
        constants_(PromoteConstants<Scalar>(model_.constants)) {
    CheckTolerance("relative_tolerance", options.relative_tolerance);
    CheckTolerance("absolute_tolerance", options.absolute_tolerance);
    result_.statistics.method = options.method;
    if (options.method == Multistep::kAuto) result_.statistics.method = ChooseMethod(parameters);
    for (std::size_t i = 0; i < kCoordinates; ++i) {
      y_[i] = options.initial_position[i];
      y_[kCoordinates + i] = options.initial_velocity[i];
    }
  }

  ReferenceRun Run() {
    Create();
    std::vector<double> cuts = excitation_.MakeKinks(options_.duration);
    cuts.push_back(options_.duration);
    std::sort(cuts.begin(), cuts.end());
    SetInitialMode();
    Sample(0.0, y_.data());
    time_ = 0.0;
    for (const double cut : cuts) {
      // Two cuts nearer than this are one: CVODE cannot start a piece that short.
      if (cut - time_ < 1e-12) continue;
      IntegrateTo(cut);
    }
    // The last sample may be missing by rounding of the sample times.
    while (next_sample_ <= samples_) Sample(options_.duration, y_.data());
    CollectCounters();
    return std::move(result_);
  }

  int CalcRate(double t, const double* y, double* rate) const {
    Dynamics<double> d{};
    CalcDynamics<double>(model_.structure, model_.constants, MakeState<double>(y),
                         excitation_.CalcForce(t), mode_.slip, d);
    for (int i = 0; i < kCoordinates; ++i) {
      rate[i] = y[kCoordinates + i];
      rate[kCoordinates + i] = d.a[i];
    }
    for (int i = 0; i < kExtraStates; ++i) rate[kExtra + i] = d.extra_rate[i];
    rate[kDissipated] = d.dissipated_power;
    rate[kSupplied] = d.supplied_power;
    for (int i = 0; i < kStates; ++i) {
      if (!std::isfinite(rate[i])) return 1;  // CVODE tries a shorter step
    }
    return 0;
  }

  void CalcJacobian(double t, const double* y, SUNMatrix jacobian) const {
    State<Scalar> x = MakeState<Scalar>(y);
    for (int i = 0; i < kCoordinates; ++i) {
      x.q[i].d[i] = 1.0;
      x.v[i].d[kCoordinates + i] = 1.0;
    }
    for (int i = 0; i < kExtraStates; ++i) x.extra[i].d[kExtra + i] = 1.0;
    Dynamics<Scalar> d{};
    CalcDynamics<Scalar>(model_.structure, constants_, x, Scalar(excitation_.CalcForce(t)),
                         Scalar(mode_.slip), d);
    for (int j = 0; j < kStates; ++j) {
      sunrealtype* column = SUNDenseMatrix_Column(jacobian, j);
      std::fill_n(column, kStates, 0.0);
      if (j >= kMechanical) continue;
      if (j >= kCoordinates && j < kExtra) column[j - kCoordinates] = 1.0;
      for (int i = 0; i < kCoordinates; ++i) column[kCoordinates + i] = d.a[i].d[j];
      for (int i = 0; i < kExtraStates; ++i) column[kExtra + i] = d.extra_rate[i].d[j];
      column[kDissipated] = d.dissipated_power.d[j];
      column[kSupplied] = d.supplied_power.d[j];
    }
  }

  // Switching functions, positive as long as the present mode holds; 1 where unused.
  void CalcSwitches(double t, const double* y, double* g) const {
    std::fill_n(g, static_cast<int>(kSwitchCount), 1.0);
    const Structure& st = model_.structure;
    const Constants<double>& k = model_.constants;
    if (mode_.coulomb) {
      if (mode_.slip != 0.0 && mode_.normal_sign == 0) {
        g[kFriction] = mode_.slip * y[kRackSpeed];
      } else {
        const Dynamics<double> d =
            CalcForces(model_, MakeState<double>(y), excitation_.CalcForce(t), mode_.slip);
        g[kFriction] = mode_.slip != 0.0 ? mode_.slip * y[kRackSpeed]
                                         : d.friction_limit - std::abs(d.friction_force);
        if (mode_.normal_sign != 0)
          g[kNormal] = mode_.normal_sign * d.rod_force * d.rod_direction_x;
      }
    }
    if (st.has_stops) {
      const double twist = y[4] - k.gear_ratio * y[3];
      g[kUpperStop] = (k.stop_angle - twist) * (mode_.stop > 0 ? -1.0 : 1.0);
      g[kLowerStop] = (k.stop_angle + twist) * (mode_.stop < 0 ? -1.0 : 1.0);
    }
    if (st.has_free_play) {
      const double elongation = CalcElongation(y);
      g[kUpperPlay] = (k.rod_half_play - elongation) * (mode_.play > 0 ? -1.0 : 1.0);
      g[kLowerPlay] = (k.rod_half_play + elongation) * (mode_.play < 0 ? -1.0 : 1.0);
    }
  }

 private:
  static void CheckTolerance(const char* key, double value) {
    if (std::isfinite(value) && value > 0.0) return;
    io::InputProblem problem;
    problem.key = key;
    problem.found = fmt::format("{}", value);
    problem.expected = "a tolerance > 0";
    throw io::InputError(problem);
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw io::RunError(fmt::format("reference integration at t = {:.9g} s: {}", time_, what));
  }

  void Check(int flag, const char* function) const {
    if (flag < 0) Fail(fmt::format("{} returned {}", function, flag));
  }

  static Multistep ChooseMethod(const Parameters<double>& parameters) {
    const Modes modes = CalcModes(MakeLinearModel(parameters));
    double fastest_swing = 0.0;
    for (const auto& mode : modes.modes) {
      if (mode.kind == ModeKind::kOscillatory && mode.damping_ratio < 0.5) {
        fastest_swing = std::max(fastest_swing, std::abs(mode.eigenvalue));
      }
    }
    // Adams is held by its stability at about 0.5/|λ|; BDF of order 5 needs about 100 steps per
    // period of what still swings for 11 digits.
    return modes.fastest_rate > 30.0 * fastest_swing ? Multistep::kBdf : Multistep::kAdams;
  }

  void Create() {
    vector_.reset(N_VNew_Serial(kStates, context_));
    tolerance_.reset(N_VNew_Serial(kStates, context_));
    dense_.reset(N_VNew_Serial(kStates, context_));
    matrix_.reset(SUNDenseMatrix(kStates, kStates, context_));
    if (!vector_ || !tolerance_ || !dense_ || !matrix_) Fail("out of memory");
    solver_.reset(SUNLinSol_Dense(vector_.get(), matrix_.get(), context_));
    const bool bdf = result_.statistics.method == Multistep::kBdf;
    memory_.reset(CVodeCreate(bdf ? CV_BDF : CV_ADAMS, context_));
    if (!solver_ || !memory_) Fail("out of memory");
    std::copy(y_.begin(), y_.end(), N_VGetArrayPointer(vector_.get()));
    // Typical sizes: 1 mm, 10 mrad, 0.1 mm of rack, 0.1 rad of wheel; 0.1 m/s and so on; lagged
    // yaw, assistance, its rate; energies.
    constexpr StateArray kTypical{1e-3, 1e-3, 1e-2, 1e-4, 1e-1, 1e-1, 1e-1, 1.0,
                                  1e-2, 1e1,  1e-2, 1e2,  1e4,  1.0,  1.0};
    for (int i = 0; i < kStates; ++i) {
      N_VGetArrayPointer(tolerance_.get())[i] =
          options_.absolute_tolerance * kTypical[static_cast<std::size_t>(i)];
    }
    void* memory = memory_.get();
    Check(CVodeInit(memory, &RateCallback, 0.0, vector_.get()), "CVodeInit");
    Check(CVodeSetErrHandlerFn(memory, &ErrorCallback, this), "CVodeSetErrHandlerFn");
    Check(CVodeSetUserData(memory, this), "CVodeSetUserData");
    Check(CVodeSVtolerances(memory, options_.relative_tolerance, tolerance_.get()),
          "CVodeSVtolerances");
    Check(CVodeSetLinearSolver(memory, solver_.get(), matrix_.get()), "CVodeSetLinearSolver");
    Check(CVodeSetJacFn(memory, &JacobianCallback), "CVodeSetJacFn");
    Check(CVodeSetMaxErrTestFails(memory, 30), "CVodeSetMaxErrTestFails");
  }

  double CalcElongation(const double* y) const {
    const Constants<double>& k = model_.constants;
    const double s = std::sin(y[2]);
    const double half = std::sin(0.5 * y[2]);
    const double c1 = -2.0 * half * half;  // cos ψ − 1 without cancellation
    const double mx = y[0] + (c1 * k.outer_x - s * k.outer_y);
    const double my =
        y[1] + (s * k.outer_x + c1 * k.outer_y) - (model_.structure.two_way ? y[3] : 0.0);
    const double growth = mx * (2.0 * k.rod_x + mx) + my * (2.0 * k.rod_y + my);
    return growth / (std::sqrt(k.rod_length_squared + growth) + k.rod_length);
  }

  void SetInitialMode() {
    const Structure& st = model_.structure;
    const Constants<double>& k = model_.constants;
    mode_.coulomb = st.friction_law == FrictionLaw::kCoulomb;
    if (st.has_stops) {
      const double twist = y_[4] - k.gear_ratio * y_[3];
      mode_.stop = twist > k.stop_angle ? 1 : twist < -k.stop_angle ? -1 : 0;
    }
    if (st.has_free_play) {
      const double elongation = CalcElongation(y_.data());
      mode_.play = elongation > k.rod_half_play ? 1 : elongation < -k.rod_half_play ? -1 : 0;
    }
    if (mode_.coulomb) {
      mode_.slip = CalcSlip(model_, MakeState<double>(y_.data()), excitation_.CalcForce(0.0));
    }
    WatchNormalForce();
  }

  void WatchNormalForce() {
    mode_.normal_sign = 0;
    if (!mode_.coulomb || !(model_.constants.friction_coefficient > 0.0)) return;
    const Dynamics<double> d =
        CalcForces(model_, MakeState<double>(y_.data()), excitation_.CalcForce(time_), mode_.slip);
    const double normal = d.rod_force * d.rod_direction_x;
    // At rest there is no side to be on: wait until there is a force.
    mode_.normal_sign = normal > 0.0 ? 1 : normal < 0.0 ? -1 : 0;
  }

  void Restart() {
    std::copy(y_.begin(), y_.end(), N_VGetArrayPointer(vector_.get()));
    CollectCounters();
    Check(CVodeReInit(memory_.get(), time_, vector_.get()), "CVodeReInit");
    ++result_.statistics.restarts;
  }

  // CVodeReInit sets the counters back.
  void CollectCounters() {
    void* memory = memory_.get();
    long steps = 0, rates = 0, jacobians = 0, failures = 0, nonlinear = 0;
    CVodeGetNumSteps(memory, &steps);
    CVodeGetNumRhsEvals(memory, &rates);
    CVodeGetNumJacEvals(memory, &jacobians);
    CVodeGetNumErrTestFails(memory, &failures);
    CVodeGetNumNonlinSolvConvFails(memory, &nonlinear);
    ReferenceStatistics& s = result_.statistics;
    s.steps += steps;
    s.force_evaluations += rates;
    s.jacobians += jacobians;
    s.error_test_failures += failures;
    s.nonlinear_failures += nonlinear;
  }

  void Interpolate(double t, double* y) {
    Check(CVodeGetDky(memory_.get(), t, 0, dense_.get()), "CVodeGetDky");
    std::copy_n(N_VGetArrayPointer(dense_.get()), kStates, y);
    // What sticks, sticks: interpolation of a constant leaves rounding behind.
    if (mode_.coulomb && mode_.slip == 0.0) {
      y[3] = y_[3];
      y[kRackSpeed] = 0.0;
    }
  }

  // Earliest time in (from, to] at which one of the switching functions has left its side; false
  // when none has. `which` receives the switch.
  bool FindEvent(double from, double to, double* when, int* which) {
    constexpr int kPoints = 5;
    double low = from;
    StateArray y{};
    std::array<double, kSwitchCount> g{};
    for (int p = 1; p <= kPoints; ++p) {
      double high = p == kPoints ? to : from + (to - from) * p / kPoints;
      Interpolate(high, y.data());
      CalcSwitches(high, y.data(), g.data());
      if (*std::min_element(g.begin(), g.end()) >= 0.0) {
        low = high;
        continue;
      }
      // Bisection on "some function is negative" down to neighbouring numbers: the earliest
      // crossing of all, which no other switch can hide behind.
      for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        Interpolate(middle, y.data());
        CalcSwitches(middle, y.data(), g.data());
        (*std::min_element(g.begin(), g.end()) < 0.0 ? high : low) = middle;
      }
      Interpolate(high, y.data());
      CalcSwitches(high, y.data(), g.data());
      *which = static_cast<int>(std::min_element(g.begin(), g.end()) - g.begin());
      for (int i = 0; i < kSwitchCount; ++i) {
        if (g[static_cast<std::size_t>(i)] < 0.0) {
          *which = i;
          break;
        }
      }
      *when = high;
      return true;
    }
    return false;
  }

  void AddEvent(EventKind kind, int direction) {
    result_.statistics.events.push_back({time_, kind, direction});
    constexpr std::size_t kMost = 1'000'000;
    if (result_.statistics.events.size() > kMost) Fail("more than a million events");
  }

  void UpdateFriction() {
    const double before = mode_.slip;
    mode_.slip = CalcSlip(model_, MakeState<double>(y_.data()), excitation_.CalcForce(time_));
    if (mode_.slip == 0.0 && before != 0.0) AddEvent(EventKind::kStick, 0);
    if (mode_.slip != 0.0 && mode_.slip != before) {
      AddEvent(EventKind::kSlip, static_cast<int>(mode_.slip));
    }
  }

  void Apply(int which) {
    switch (which) {
      case kFriction:
        if (mode_.slip != 0.0) {
          y_[kRackSpeed] = 0.0;
          UpdateFriction();
        } else {
          // Beyond the limit by construction of the event, be it by one rounding.
          const Dynamics<double> d =
              CalcForces(model_, MakeState<double>(y_.data()), excitation_.CalcForce(time_), 0.0);
          mode_.slip = d.friction_force < 0.0 ? 1.0 : -1.0;
          AddEvent(EventKind::kSlip, static_cast<int>(mode_.slip));
        }
        break;
      case kUpperStop:
      case kLowerStop: {
        const int side = which == kUpperStop ? 1 : -1;
        const bool contact = mode_.stop != side;
        mode_.stop = contact ? side : 0;
        AddEvent(contact ? EventKind::kStopContact : EventKind::kStopRelease, side);
        break;
      }
      case kUpperPlay:
      case kLowerPlay: {
        const int side = which == kUpperPlay ? 1 : -1;
        const bool contact = mode_.play != side;
        mode_.play = contact ? side : 0;
        AddEvent(contact ? EventKind::kPlayContact : EventKind::kPlayRelease, side);
        break;
      }
      case kNormal:
        mode_.normal_sign = -mode_.normal_sign;
        AddEvent(EventKind::kNormalForceSign, mode_.normal_sign);
        return;
      default:
        break;
    }
    // A jump of the rod's damping force can push a resting rack at once, or turn the normal force.
    if (mode_.coulomb && mode_.slip == 0.0) UpdateFriction();
    WatchNormalForce();
  }

  void IntegrateTo(double end) {
    void* memory = memory_.get();
    Restart();
    Check(CVodeSetStopTime(memory, end), "CVodeSetStopTime");
    const bool events = model_.structure.has_events();
    while (time_ < end) {
      double reached = time_;
      const int flag = CVode(memory, end, vector_.get(), &reached, CV_ONE_STEP);
      if (flag < 0) Fail(fmt::format("CVODE gave up ({}): {}", flag, message_));
      double event_time = reached;
      int which = -1;
      const bool found = events && FindEvent(time_, reached, &event_time, &which);
      const double until = found ? event_time : reached;
      SampleTo(until);
      StateArray y{};
      Interpolate(until, y.data());
      if (mode_.coulomb && mode_.slip == 0.0) result_.statistics.sticking_time += until - time_;
      y_ = y;
      time_ = until;
      const int diverged = FindDivergedCoordinate(y_.data(), y_.data() + kCoordinates);
      if (diverged >= 0) {
        Fail(fmt::format("the planar model diverges in coordinate {} = {:g}",
                         kCoordinateNames[diverged], y_[static_cast<std::size_t>(diverged)]));
      }
      if (found) {
        Apply(which);
        if (time_ < end) {
          Restart();
          Check(CVodeSetStopTime(memory, end), "CVodeSetStopTime");
        }
      } else if (mode_.coulomb && mode_.normal_sign == 0) {
        WatchNormalForce();
      }
    }
    // A kink of the excitation is no event of the elements: modes stay.
    time_ = end;
  }

  void SampleTo(double until) {
    StateArray y{};
    while (next_sample_ <= samples_) {
      const double t = options_.duration * next_sample_ / samples_;
      if (t > until) return;
      Interpolate(t, y.data());
      Sample(t, y.data());
    }
  }

  void Sample(double t, const double* y) {
    ++next_sample_;
    const State<double> x = MakeState<double>(y);
    const double force = excitation_.CalcForce(t);
    Dynamics<double> d{};
    CalcDynamics<double>(model_.structure, model_.constants, x, force, mode_.slip, d);
    result_.history.Append(t, force, model_, x, d, y[kDissipated], y[kSupplied]);
  }

  static int RateCallback(sunrealtype t, N_Vector y, N_Vector rate, void* self) {
    return static_cast<const Integration*>(self)->CalcRate(t, N_VGetArrayPointer(y),
                                                           N_VGetArrayPointer(rate));
  }
  static int JacobianCallback(sunrealtype t, N_Vector y, N_Vector, SUNMatrix jacobian, void* self,
                              N_Vector, N_Vector, N_Vector) {
    static_cast<const Integration*>(self)->CalcJacobian(t, N_VGetArrayPointer(y), jacobian);
    return 0;
  }
  static void ErrorCallback(int, const char*, const char*, char* message, void* self) {
    static_cast<Integration*>(self)->message_ = message;
  }

  struct FreeVector {
    void operator()(N_Vector v) const { N_VDestroy(v); }
  };
  struct FreeMatrix {
    void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
  };
  struct FreeSolver {
    void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
  };
  struct FreeMemory {
    void operator()(void* memory) const { CVodeFree(&memory); }
  };
  template <class Handle, class Free>
  using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;

  ReferenceOptions options_;
  const Excitation& excitation_;
  int samples_;
  Model<double> model_;
  Constants<Scalar> constants_;  // of the model, for derivatives with respect to the state
  Mode mode_;
  StateArray y_{};
  double time_ = 0.0;
  int next_sample_ = 0;
  ReferenceRun result_;
  std::string message_;
  // Destroyed in reverse order: the context last.
  sundials::Context context_;
  Owned<N_Vector, FreeVector> vector_, tolerance_, dense_;
  Owned<SUNMatrix, FreeMatrix> matrix_;
  Owned<SUNLinearSolver, FreeSolver> solver_;
  std::unique_ptr<void, FreeMemory> memory_;
};

}  // namespace

std::string_view ToString(Multistep method) {
  switch (method) {
    case Multistep::kAuto:
      return "auto";
    case Multistep::kAdams:
      return "Adams";
    case Multistep::kBdf:
      return "BDF";
  }
  return "";
}

std::string_view ToString(EventKind kind) {
  switch (kind) {
    case EventKind::kStick:
      return "stick";
    case EventKind::kSlip:
      return "slip";
    case EventKind::kStopContact:
      return "stop contact";
    case EventKind::kStopRelease:
      return "stop release";
    case EventKind::kPlayContact:
      return "play contact";
    case EventKind::kPlayRelease:
      return "play release";
    case EventKind::kNormalForceSign:
      return "normal force sign";
  }
  return "";
}

ReferenceRun SimulateReference(const Parameters<double>& parameters, const Excitation& excitation,
                               const ReferenceOptions& options) {
  ValidateParameters(parameters);
  return Integration(parameters, excitation, options).Run();
}

}  // namespace kingpin::planar
