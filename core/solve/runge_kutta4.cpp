#include "core/solve/runge_kutta4.h"

namespace kingpin::solve {

RungeKutta4::RungeKutta4(const mechanism::System& system)
    : k1_(system.size()),
      k2_(system.size()),
      k3_(system.size()),
      k4_(system.size()),
      stage_(system.size()) {}

void RungeKutta4::Step(mechanism::Evaluator& evaluator, double time, double step,
                       std::span<double> y) {
  const auto move = [&](double h, const std::vector<double>& k) {
    for (size_t i = 0; i < stage_.size(); ++i) stage_[i] = y[i] + h * k[i];
  };
  evaluator.CalcRates(time, y, k1_);
  move(step / 2, k1_);
  evaluator.CalcRates(time + step / 2, stage_, k2_);
  move(step / 2, k2_);
  evaluator.CalcRates(time + step / 2, stage_, k3_);
  move(step, k3_);
  evaluator.CalcRates(time + step, stage_, k4_);
  for (size_t i = 0; i < stage_.size(); ++i) {
    y[i] += step / 6 * (k1_[i] + 2 * (k2_[i] + k3_[i]) + k4_[i]);
  }
}

}  // namespace kingpin::solve
