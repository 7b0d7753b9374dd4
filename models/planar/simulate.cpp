#include "models/planar/simulate.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/io/error.h"
#include "models/planar/accelerations.h"
#include "models/planar/events.h"
#include "models/planar/exponential_adams.h"
#include "models/planar/exponential_runge_kutta.h"
#include "models/planar/runge_kutta.h"
#include "models/planar/schedule.h"
#include "models/planar/validate.h"

namespace kingpin::planar {
namespace {

void CheckOption(bool good, const char* key, double found, const char* expected) {
  if (good && std::isfinite(found)) return;
  io::InputProblem problem;
  problem.key = key;
  problem.found = fmt::format("{}", found);
  problem.expected = expected;
  throw io::InputError(problem);
}

struct Extended {
  State<double> state{};
  Ledger<double> ledger;
};

/// One run, step by step.
class Run {
 public:
  Run(const Parameters<double>& parameters, const Excitation& excitation,
      const SimulationOptions& options)
      : model_(MakeModel(parameters)), excitation_(excitation), options_(options) {
    switches_ =
        MakeSwitches(model_.structure, model_.constants, now_.state, excitation_.CalcForce(0));
  }

  /// From t0 to t1, which lie in one sample interval and have no kink between them.
  void Advance(double t0, double t1) {
    const int steps = std::max(1, static_cast<int>(std::ceil((t1 - t0) / options_.step - 1e-9)));
    const double h = (t1 - t0) / steps;
    steps_ += steps;
    for (int i = 0; i < steps; ++i) {
      const double t = t0 + i * h;
      if (!model_.structure.has_events()) {
        StepOnce(now_, t, h, 0);
        continue;
      }
      // The event location repeats steps; the ledger goes with the step that is kept.
      const auto step = [&](const State<double>& x, double begin, double since, double length,
                            double slip) {
        Extended trial{x, now_.ledger};
        StepOnce(trial, begin + since, length, slip);
        return trial.state;
      };
      const auto force = [&](double begin, double since) {
        return excitation_.CalcForce(begin + since);
      };
      AdvanceWithLedger(t, h, step, force);
    }
  }

  const Extended& now() const { return now_; }
  const Model<double>& model() const { return model_; }
  double slip() const { return switches_.slip; }
  long steps() const { return steps_; }

 private:
  void StepOnce(Extended& y, double t, double h, double slip) const {
    StepRungeKutta4<true>(model_.structure, model_.constants, h, excitation_.CalcForce(t),
                          excitation_.CalcForce(t + 0.5 * h), excitation_.CalcForce(t + h), slip,
                          y.state, y.ledger);
  }

  template <class Step, class Force>
  void AdvanceWithLedger(double t, double h, const Step& step, const Force& force) {
    // Pieces between events: the last accepted length is replayed with the ledger.
    Extended replay = now_;
    double done = 0;
    const auto on_accept = [&](double until, double slip) {
      if (until > done) StepOnce(replay, t + done, until - done, slip);
      done = until;
    };
    State<double> x = now_.state;
    if (!AdvanceThroughEvents(model_.structure, model_.constants, t, h, x, switches_, step, force,
                              on_accept)) {
      throw io::RunError(
          fmt::format("the planar model switches without end at t = {:.6f} s (friction, stops or "
                      "free play); use a smaller step",
                      t));
    }
    now_.state = x;
    now_.ledger = replay.ledger;
  }

  Model<double> model_;
  const Excitation& excitation_;
  SimulationOptions options_;
  Extended now_;
  Switches<double> switches_;
  long steps_ = 0;
};

/// One run with the fast method. The powers are integrated with the corrector's weights, or by
/// Simpson's rule over one-step pieces.
class FastRun {
 public:
  FastRun(const Model<double>& model, const Schedule& schedule)
      : st_(model.structure), k_(model.constants), rod_(MakeRodMode(st_, k_, false)) {
    MakeAdamsWeights(rod_, schedule.adams_step, adams_);
    MakeCorrectorWeights(corrector_);
  }

  void Advance(const ScheduleStep& step) {
    if (step.kind == StepKind::kAdams) {
      AdamsEnd<double> end;
      StepAdams(st_, k_, rod_, adams_, step.force[2], curves_, history_, now_.state, error_, end);
      PushPower(step.force[2]);
      for (int j = 0; j < kAdamsOrder; ++j) {
        const Ledger<double>& power = powers_[(head_ + j) & 7];
        now_.ledger.dissipated += step.h * corrector_[j] * power.dissipated;
        now_.ledger.supplied += step.h * corrector_[j] * power.supplied;
      }
      return;
    }
    history_.rod_known = false;
    State<double> middle = now_.state;
    OneStepWeights<double, double> half, whole;
    MakeOneStepWeights(rod_, 0.5 * step.h, half);
    MakeOneStepWeights(rod_, step.h, whole);
    // Its own middle force lies at a quarter of the step; linear between is good enough for a state
    // that only weighs power.
    StepOneStep(st_, k_, rod_, half, step.force[0], 0.5 * (step.force[0] + step.force[1]),
                step.force[1], 0.0, middle);
    AddPower(now_.state, step.force[0], step.h / 6);
    AddPower(middle, step.force[1], 4 * step.h / 6);
    StepOneStep(st_, k_, rod_, whole, step.force[0], step.force[1], step.force[2], 0.0, now_.state);
    AddPower(now_.state, step.force[2], step.h / 6);
    if (step.kind == StepKind::kOneStepRemembered) {
      Dynamics<double> d;
      CalcDynamics(st_, k_, now_.state, step.force[2], 0.0, d);
      SplitRemainder(rod_, now_.state, d, st_.has_extra_states(), history_.Push());
      PushPower(step.force[2]);
    }
  }

  void UpdateFastest() {
    for (int i = 0; i < kCoordinates; ++i) {
      fastest_[i] = std::max(fastest_[i], std::abs(now_.state.v[i]));
    }
  }

  double CalcErrorEstimate() const {
    double worst = 0;
    for (int i = 0; i < kCoordinates; ++i) {
      worst = std::max(worst, error_[i] / std::max(fastest_[i], 1e-300));
    }
    return worst * kAdamsErrorConstant * adams_.h;
  }

  const Extended& now() const { return now_; }

 private:
  /// ∫_0^1 of the Lagrange polynomials on the nodes 1, 0, −1, ...
  static void MakeCorrectorWeights(double (&weight)[kAdamsOrder]) {
    constexpr double kNumerators[kAdamsOrder] = {19087, 65112, -46461, 37504, -20211, 6312, -863};
    for (int j = 0; j < kAdamsOrder; ++j) weight[j] = kNumerators[j] / 60480;
  }

  Ledger<double> CalcPower(const State<double>& x, double force) const {
    Dynamics<double> d;
    CalcDynamics(st_, k_, x, force, 0.0, d);
    return {d.dissipated_power, d.supplied_power};
  }
  void PushPower(double force) {
    head_ = (head_ - 1) & 7;
    powers_[head_] = CalcPower(now_.state, force);
  }
  void AddPower(const State<double>& x, double force, double weight) {
    const Ledger<double> power = CalcPower(x, force);
    now_.ledger.dissipated += weight * power.dissipated;
    now_.ledger.supplied += weight * power.supplied;
  }

  const Structure& st_;
  const Constants<double>& k_;
  RodMode<double> rod_;
  AdamsWeights<double> adams_;
  AdamsHistory<double> history_{};
  SegmentCurves<double> curves_;
  double corrector_[kAdamsOrder];
  Ledger<double> powers_[8] = {};
  int head_ = 0;
  Extended now_;
  double error_[kCoordinates] = {}, fastest_[kCoordinates] = {};
};

class Recorder {
 public:
  Recorder(const Model<double>& model, const Excitation& excitation, int intervals)
      : model_(model), excitation_(excitation) {
    const auto reserve = [&](std::vector<double>& list) {
      list.reserve(static_cast<size_t>(intervals) + 1);
    };
    for (int i = 0; i < kCoordinates; ++i) {
      reserve(h_.q[i]);
      reserve(h_.v[i]);
      reserve(h_.a[i]);
    }
    for (std::vector<double>* list :
         {&h_.time, &h_.rim_acceleration, &h_.torsion_torque, &h_.tie_rod_force, &h_.rack_force,
          &h_.friction_force, &h_.assist_force, &h_.road_force, &h_.kinetic_energy,
          &h_.potential_energy, &h_.dissipated_energy, &h_.supplied_energy}) {
      reserve(*list);
    }
  }

  void Sample(double t, const Extended& now, double slip) {
    const State<double>& x = now.state;
    const double force = excitation_.CalcForce(t);
    const Dynamics<double> d = CalcForces(model_, x, force, slip);
    h_.Append(t, force, model_, x, d, now.ledger.dissipated, now.ledger.supplied);
  }

  History Take(const IntegrationRecord& integration) {
    h_.integration = integration;
    return std::move(h_);
  }

 private:
  const Model<double>& model_;
  const Excitation& excitation_;
  History h_;
};

[[noreturn]] void FailDiverged(const State<double>& x, int coordinate, double t, double step) {
  throw io::RunError(fmt::format(
      "the run diverges at t = {:.4f} s in coordinate {} = {:g}, rate {:g}, with steps of {:g} s: "
      "they are too long for this model, or the model itself is unstable; 'method: cvode', which "
      "chooses its own steps, tells which",
      t, kCoordinateNames[coordinate], x.q[coordinate], x.v[coordinate], step));
}

History SimulateRungeKutta(const Parameters<double>& parameters, const Model<double>& model,
                           const Excitation& excitation, const SimulationOptions& options, int n) {
  const std::vector<double> kinks = excitation.MakeKinks(options.duration);
  Run run(parameters, excitation, options);
  Recorder recorder(model, excitation, n);
  recorder.Sample(0, run.now(), run.slip());
  size_t next_kink = 0;
  for (int i = 0; i < n; ++i) {
    const double t0 = options.duration * i / n;
    const double t1 = options.duration * (i + 1) / n;
    // At rest nothing moves before the excitation begins.
    if (t1 > excitation.start()) {
      double t = t0;
      while (next_kink < kinks.size() && kinks[next_kink] < t1) {
        if (kinks[next_kink] > t) {
          run.Advance(t, kinks[next_kink]);
          t = kinks[next_kink];
        }
        ++next_kink;
      }
      run.Advance(t, t1);
      const int diverged = FindDivergedCoordinate(run.now().state.q, run.now().state.v);
      if (diverged >= 0) FailDiverged(run.now().state, diverged, t1, options.step);
    }
    recorder.Sample(t1, run.now(), run.slip());
  }
  return recorder.Take({.step = options.step, .steps = run.steps()});
}

/// False when the run diverges or its error estimate exceeds the bound; in the last trial both
/// throw.
bool SimulateFast(const Model<double>& model, const Excitation& excitation,
                  const SimulationOptions& options, bool last, Recorder& recorder,
                  IntegrationRecord& integration) {
  const Schedule schedule =
      MakeAdamsSchedule(excitation, options.duration, options.sample_interval, options.step);
  FastRun run(model, schedule);
  const auto time = [&](int sample) { return options.duration * sample / (schedule.samples - 1); };
  int sample = 0;
  for (; sample <= schedule.first_sample; ++sample) recorder.Sample(time(sample), run.now(), 0);
  for (const ScheduleStep& step : schedule.steps) {
    run.Advance(step);
    if (!step.sample) continue;
    run.UpdateFastest();
    const int diverged = FindDivergedCoordinate(run.now().state.q, run.now().state.v);
    if (diverged >= 0) {
      if (!last) return false;
      FailDiverged(run.now().state, diverged, time(sample), options.step);
    }
    recorder.Sample(time(sample), run.now(), 0);
    ++sample;
  }
  integration.step = schedule.adams_step;
  integration.steps = static_cast<long>(schedule.steps.size());
  integration.error_estimate = run.CalcErrorEstimate();
  integration.error_bound = options.tolerance;
  // Written so that NaN fails.
  const bool good = integration.error_estimate <= options.tolerance;
  if (last && !good) {
    throw io::RunError(fmt::format(
        "the fast method's estimated relative error {:.2g} exceeds its bound {:g} even with steps "
        "of {:g} s: the model is too stiff for it (or its forces drown in rounding); use "
        "'method: cvode', which chooses its own steps",
        integration.error_estimate, options.tolerance, integration.step));
  }
  return good;
}

}  // namespace

int CalcSampleIntervals(double duration, double sample_interval, double step) {
  CheckOption(duration > 0, "duration", duration, "a time > 0 [s]");
  CheckOption(sample_interval > 0 && sample_interval <= duration, "sample_interval",
              sample_interval, "a time > 0 and at most the duration [s]");
  CheckOption(step > 0, "step", step, "a time > 0 [s]");
  const double ratio = duration / sample_interval;
  CheckOption(std::abs(ratio - std::round(ratio)) < 1e-6 * ratio && ratio < 1e8, "sample_interval",
              sample_interval, "a whole fraction of the duration [s]");
  return static_cast<int>(std::lround(ratio));
}

int FindDivergedCoordinate(const double* q, const double* v) {
  for (int i = 0; i < kCoordinates; ++i) {
    // Written so that NaN fails.
    if (!(std::abs(q[i]) < 1e3) || !(std::abs(v[i]) < 1e6)) return i;
  }
  return -1;
}

History Simulate(const Parameters<double>& parameters, const Excitation& excitation,
                 const SimulationOptions& options) {
  ValidateParameters(parameters);
  CheckOption(options.step >= 0, "step", options.step, "a time > 0, or 0 for the default [s]");
  const Model<double> model = MakeModel(parameters);
  const bool fast = options.method == Method::kFast && !model.structure.has_events() &&
                    model.structure.friction_law != FrictionLaw::kSmoothed;
  SimulationOptions used = options;
  // Where the fast method cannot run, its step would be too large for RK4.
  if (used.step == 0) used.step = fast ? 2.5e-4 : 1e-5;
  if (options.method == Method::kFast && !fast) {
    CheckOption(used.step <= 1e-5, "step", used.step,
                "at most 1e-05 s, or none: dry friction, stops and free play are integrated by "
                "Runge-Kutta");
  }
  const int n = CalcSampleIntervals(used.duration, used.sample_interval, used.step);
  if (!fast) return SimulateRungeKutta(parameters, model, excitation, used, n);
  for (int round = 0;; ++round) {
    const bool last = round == 6;
    Recorder recorder(model, excitation, n);
    IntegrationRecord integration;
    if (SimulateFast(model, excitation, used, last, recorder, integration)) {
      return recorder.Take(integration);
    }
    used.step *= 0.5;
  }
}

void History::Append(double t, double force, const Model<double>& model, const State<double>& now,
                     const Dynamics<double>& forces, double dissipated, double supplied) {
  time.push_back(t);
  for (int i = 0; i < kCoordinates; ++i) {
    q[i].push_back(now.q[i]);
    v[i].push_back(now.v[i]);
    a[i].push_back(forces.a[i]);
  }
  rim_acceleration.push_back(forces.a[4] * model.constants.rim_radius);
  torsion_torque.push_back(forces.torsion_torque);
  tie_rod_force.push_back(forces.rod_force);
  rack_force.push_back(forces.rack_rod_force);
  friction_force.push_back(forces.friction_force);
  assist_force.push_back(forces.assist_force);
  road_force.push_back(force);
  kinetic_energy.push_back(CalcKineticEnergy(model, now));
  potential_energy.push_back(CalcPotentialEnergy(model, now));
  dissipated_energy.push_back(dissipated);
  supplied_energy.push_back(supplied);
}

double History::CalcEnergyResidual() const {
  double residual = 0;
  double scale = 0;
  for (size_t i = 0; i < size(); ++i) {
    residual = std::max(residual, std::abs(kinetic_energy[i] + potential_energy[i] +
                                           dissipated_energy[i] - supplied_energy[i]));
    scale = std::max(scale, std::abs(supplied_energy[i]));
  }
  return scale > 0 ? residual / scale : residual;
}

}  // namespace kingpin::planar
