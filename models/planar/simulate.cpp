#include "models/planar/simulate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/io/error.h"
#include "models/planar/accelerations.h"
#include "models/planar/events.h"
#include "models/planar/runge_kutta.h"
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
};

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
  const int n = CalcSampleIntervals(options.duration, options.sample_interval, options.step);
  const std::vector<double> kinks = excitation.MakeKinks(options.duration);
  Run run(parameters, excitation, options);
  const Model<double>& model = run.model();

  History h;
  const auto reserve = [&](std::vector<double>& list) { list.reserve(static_cast<size_t>(n) + 1); };
  for (int i = 0; i < kCoordinates; ++i) {
    reserve(h.q[i]);
    reserve(h.v[i]);
    reserve(h.a[i]);
  }
  for (std::vector<double>* list :
       {&h.time, &h.rim_acceleration, &h.torsion_torque, &h.tie_rod_force, &h.rack_force,
        &h.friction_force, &h.assist_force, &h.road_force, &h.kinetic_energy, &h.potential_energy,
        &h.dissipated_energy, &h.supplied_energy}) {
    reserve(*list);
  }
  const auto sample = [&](double t) {
    const State<double>& x = run.now().state;
    const double force = excitation.CalcForce(t);
    const Dynamics<double> d = CalcForces(model, x, force, run.slip());
    h.time.push_back(t);
    for (int i = 0; i < kCoordinates; ++i) {
      h.q[i].push_back(x.q[i]);
      h.v[i].push_back(x.v[i]);
      h.a[i].push_back(d.a[i]);
    }
    h.rim_acceleration.push_back(d.a[4] * model.constants.rim_radius);
    h.torsion_torque.push_back(d.torsion_torque);
    h.tie_rod_force.push_back(d.rod_force);
    h.rack_force.push_back(d.rack_rod_force);
    h.friction_force.push_back(d.friction_force);
    h.assist_force.push_back(d.assist_force);
    h.road_force.push_back(force);
    h.kinetic_energy.push_back(CalcKineticEnergy(model, x));
    h.potential_energy.push_back(CalcPotentialEnergy(model, x));
    h.dissipated_energy.push_back(run.now().ledger.dissipated);
    h.supplied_energy.push_back(run.now().ledger.supplied);
  };

  sample(0);
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
      if (diverged >= 0) {
        throw io::RunError(fmt::format(
            "the planar model diverges at t = {:.4f} s in coordinate {} = {:g}, rate {:g}; with "
            "step {:g} s",
            t1, kCoordinateNames[diverged], run.now().state.q[diverged],
            run.now().state.v[diverged], options.step));
      }
    }
    sample(t1);
  }
  return h;
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
