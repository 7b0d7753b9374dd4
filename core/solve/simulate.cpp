#include "core/solve/simulate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "core/mechanism/project.h"

namespace kingpin::solve {

namespace {

// A row slower than this against its counterpart is still [m/s, rad/s]; it only decides the first
// modes, later ones change at located events.
constexpr double kStill = 1e-9;

class Run {
 public:
  Run(const mechanism::System& system, const SimulationOptions& options, std::span<double> y,
      const Observer& observe, Ledger& ledger)
      : system_(system),
        options_(options),
        observe_(observe),
        y_(y),
        evaluator_(system),
        stepper_(MakeStepper(evaluator_, options.stepper)),
        before_(y.begin(), y.end()),
        trial_(y.size()),
        rate_(y.size()),
        rate_before_(y.size()),
        middle_(y.size()),
        switches_(system.friction.size()),
        modes_(system.friction.size()),
        ledger_(ledger) {
    ledger_ = {};
    if (!system.friction.empty()) ledger_.events.reserve(Ledger::kMostEvents);
  }

  void Execute() {
    evaluator_.Project(0, y_, options_.stepper.projection_tolerance, 0);  // friction is out
    evaluator_.UpdateModes(0, y_, kStill);
    evaluator_.Project(0, y_, options_.stepper.projection_tolerance, 0);
    for (size_t f = 0; f < modes_.size(); ++f) NoteMode(0, f);
    OpenBooks();
    observe_(0, y_, evaluator_);
    long sample = 1;
    std::vector<double> kinks = options_.kinks;
    std::sort(kinks.begin(), kinks.end());
    size_t kink = 0;
    double time = 0;
    while (time < options_.duration) {
      double limit = options_.duration;
      if (options_.sample_interval > 0) {
        limit = std::min(limit, static_cast<double>(sample) * options_.sample_interval);
      }
      while (kink < kinks.size() && kinks[kink] <= time * (1 + 1e-12)) ++kink;
      const bool at_kink = kink < kinks.size() && kinks[kink] < limit;
      if (at_kink) limit = kinks[kink];
      time = Step(time, limit);
      if (time >= limit && at_kink) {
        stepper_->Restart();
        evaluator_.CalcRates(time, y_, rate_);
      }
      const bool sampled = options_.sample_interval <= 0 ||
                           time >= static_cast<double>(sample) * options_.sample_interval ||
                           time >= options_.duration;
      if (sampled) {
        observe_(time, y_, evaluator_);
        if (options_.sample_interval > 0 && !at_kink) ++sample;
      }
    }
    ledger_.steps = stepper_->steps;
    ledger_.jacobians = stepper_->jacobians;
  }

 private:
  // One step, cut short where friction switches.
  double Step(double time, double limit) {
    // no method can make a step of a few units in the last place
    if (limit - time <= 8 * std::numeric_limits<double>::epsilon() * limit) return limit;
    std::copy(y_.begin(), y_.end(), before_.begin());
    std::copy(rate_.begin(), rate_.end(), rate_before_.begin());
    double end = stepper_->Advance(time, limit, y_);
    bool switched = false;
    if (!system_.friction.empty() && CalcSmallestSwitch(end) < 0) {
      end = LocateSwitch(time, end);
      switched = true;
    }
    evaluator_.CalcRates(end, y_, rate_);
    Book(time, end);
    if (switched) Switch(end);
    return end;
  }

  double CalcSmallestSwitch(double time) {
    evaluator_.CalcRates(time, y_, rate_);
    evaluator_.CalcSwitches(y_, switches_);
    return *std::min_element(switches_.begin(), switches_.end());
  }

  double CalcSwitchAt(double start, double time) {
    std::copy(before_.begin(), before_.end(), y_.begin());
    stepper_->Redo(start, time, y_);
    return CalcSmallestSwitch(time);
  }

  // The first instant in (start, end] at which some mode no longer holds: bisection and regula
  // falsi (Illinois) on the smallest of the switching functions. y ends just beyond it, rates
  // there.
  double LocateSwitch(double start, double end) {
    constexpr int kIterations = 100;
    double low = start, high = end;
    double g_low = 0, g_high = CalcSwitchAt(start, end);
    bool low_known = false;
    if (!(g_high < 0)) return end;
    for (int k = 0; k < kIterations && high - low > 1e-13 * std::max(end, 1e-3); ++k) {
      double middle = 0.5 * (low + high);
      if (low_known && k % 3 != 2) {
        const double cut = low + (high - low) * g_low / (g_low - g_high);
        if (cut > low && cut < high) middle = cut;
      }
      const double g = CalcSwitchAt(start, middle);
      if (g < 0) {
        high = middle;
        g_high = g;
        if (low_known) g_low *= 0.5;
      } else {
        low = middle;
        g_low = g;
        g_high *= low_known ? 0.5 : 1.0;
        low_known = true;
        if (g == 0) {
          high = middle;
          break;
        }
      }
    }
    CalcSwitchAt(start, high);
    return high;
  }

  // The laws of friction and the motion may leave no way on (no acceleration agrees with the
  // modes): modes then change without end at one instant.
  void CountAtInstant(double time) {
    constexpr int kMost = 200;
    constexpr double kInstant = 1e-9;  // [s]
    if (time - instant_ > kInstant) {
      instant_ = time;
      switches_at_instant_ = 0;
    }
    if (++switches_at_instant_ < kMost) return;
    int culprit = 0;
    for (size_t f = 0; f < switches_.size(); ++f) {
      if (switches_[f] < switches_[culprit]) culprit = static_cast<int>(f);
    }
    throw std::runtime_error(fmt::format(
        "dry friction '{}' switches without end at t = {:g} s: no motion agrees with its law",
        system_.model.row_names[system_.friction[culprit].row], time));
  }

  void Switch(double time) {
    CountAtInstant(time);
    // The element that switched has come to rest (or just begins to move): its rate counts as zero.
    evaluator_.CalcSwitches(y_, switches_);
    for (size_t f = 0; f < switches_.size(); ++f) {
      if (evaluator_.modes()[f] != 0 && switches_[f] <= 0)
        at_rest_ = std::max(at_rest_, std::abs(switches_[f]));
    }
    evaluator_.UpdateModes(time, y_, at_rest_ + kStill);
    at_rest_ = 0;
    bool changed = false;  // or those that stick share the load anew
    for (size_t f = 0; f < modes_.size(); ++f) {
      if (evaluator_.modes()[f] == modes_[f]) continue;
      NoteMode(time, f);
      changed = true;
    }
    ledger_.switches += changed;
    evaluator_.Project(time, y_, options_.stepper.projection_tolerance, 0);
    evaluator_.CalcRates(time, y_, rate_);
    energy_ = evaluator_.CalcEnergy(time, y_);  // powers jump with the forces
    external_ = evaluator_.CalcExternalWrench();
    stepper_->Restart();
  }

  void NoteMode(double time, size_t f) {
    modes_[f] = evaluator_.modes()[f];
    if (ledger_.events.size() < Ledger::kMostEvents) {
      ledger_.events.push_back({time, static_cast<int>(f), modes_[f]});
    }
  }

  void OpenBooks() {
    evaluator_.CalcRates(0, y_, rate_);
    energy_ = evaluator_.CalcEnergy(0, y_);
    ledger_.energy_start = ledger_.energy_end = energy_.kinetic + energy_.potential;
    external_ = evaluator_.CalcExternalWrench();
    ledger_.momentum_start = ledger_.momentum_end = evaluator_.CalcMomentum();
    Inspect(0);
  }

  void Inspect(double time) {
    const auto residuals = evaluator_.CalcResiduals(time, y_);
    ledger_.largest_position_residual =
        std::max(ledger_.largest_position_residual, residuals.position);
    ledger_.largest_velocity_residual =
        std::max(ledger_.largest_velocity_residual, residuals.velocity);
    ledger_.largest_kinetic = std::max(ledger_.largest_kinetic, energy_.kinetic);
  }

  // Power and outside forces over the step by Simpson's rule, the middle state by Hermite
  // interpolation: order 4.
  void Book(double start, double end) {
    const double h = end - start;
    const mechanism::Energy before = energy_;
    const math::Wrench<double> external_before = external_;
    energy_ = evaluator_.CalcEnergy(end, y_);
    external_ = evaluator_.CalcExternalWrench();
    ledger_.momentum_end = evaluator_.CalcMomentum();
    for (size_t i = 0; i < y_.size(); ++i) {
      middle_[i] = 0.5 * (before_[i] + y_[i]) + h / 8 * (rate_before_[i] - rate_[i]);
    }
    mechanism::NormaliseQuaternions(system_.model,
                                    {middle_.data(), static_cast<size_t>(system_.model.positions)});
    evaluator_.CalcRates(0.5 * (start + end), middle_, trial_);
    const mechanism::Energy between = evaluator_.CalcEnergy(0.5 * (start + end), middle_);
    ledger_.dissipated += h / 6 * (before.dissipated + 4 * between.dissipated + energy_.dissipated);
    ledger_.supplied += h / 6 * (before.supplied + 4 * between.supplied + energy_.supplied);
    ledger_.energy_end = energy_.kinetic + energy_.potential;
    ledger_.largest_energy_error =
        std::max(ledger_.largest_energy_error, std::abs(ledger_.energy_end - ledger_.energy_start -
                                                        ledger_.supplied + ledger_.dissipated));
    const math::Wrench<double> external_between = evaluator_.CalcExternalWrench();
    ledger_.impulse =
        ledger_.impulse + h / 6 * (external_before + 4.0 * external_between + external_);
    const math::Wrench<double> error =
        ledger_.momentum_end - ledger_.momentum_start - ledger_.impulse;
    ledger_.largest_momentum_error = std::max(ledger_.largest_momentum_error, CalcNorm(error.f));
    ledger_.largest_angular_momentum_error =
        std::max(ledger_.largest_angular_momentum_error, CalcNorm(error.t));
    evaluator_.CalcRates(end, y_, rate_);
    Inspect(end);
  }

  const mechanism::System& system_;
  const SimulationOptions& options_;
  const Observer& observe_;
  std::span<double> y_;
  mechanism::Evaluator evaluator_;
  std::unique_ptr<Stepper> stepper_;
  std::vector<double> before_, trial_, rate_, rate_before_, middle_, switches_;
  std::vector<int> modes_;
  double at_rest_ = 0;
  double instant_ = 0;  // of the last switches
  int switches_at_instant_ = 0;
  mechanism::Energy energy_;
  math::Wrench<double> external_;
  Ledger& ledger_;
};

}  // namespace

void Simulate(const mechanism::System& system, const SimulationOptions& options,
              std::span<double> y, const Observer& observe, Ledger& ledger) {
  Run(system, options, y, observe, ledger).Execute();
}

Ledger Simulate(const mechanism::System& system, const SimulationOptions& options,
                std::span<double> y, const Observer& observe) {
  Ledger ledger;
  Simulate(system, options, y, observe, ledger);
  return ledger;
}

}  // namespace kingpin::solve
