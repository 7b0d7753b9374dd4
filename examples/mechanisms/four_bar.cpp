#include <cstdio>

#include "core/io/error.h"
#include "core/solve/simulate.h"
#include "joints/mechanism_builder.h"

int main() try {
  using namespace kingpin;
  using joints::At;
  joints::MechanismBuilder m("four-bar linkage");
  // mass, centre of mass, moments and products about it; SI throughout
  m.AddBody("crank", {1, {0.15, 0, 0}, {0, 0.01, 0.01, 0, 0, 0}});
  m.AddBody("coupler", {2, {0.5, 0, 0}, {0, 0.2, 0.2, 0, 0, 0}});
  m.AddBody("rocker", {1.5, {0.4, 0, 0}, {0, 0.1, 0.1, 0, 0, 0}});
  const math::Vector3<double> axis{0, -1, 0};
  m.AddRevolute("A", At("world"), At("crank"), axis).Position(1.0471975511965976).Velocity(5);
  m.AddRevolute("B", At("crank", {0.3, 0, 0}), At("coupler"), axis);
  m.AddRevolute("D", At("world", {0.9, 0, 0}), At("rocker"), axis);
  m.AddClosure("C", joints::ClosureType::kSpherical, At("coupler", {1, 0, 0}),
               At("rocker", {0.8, 0, 0}));
  const joints::Mechanism mechanism = m.Make();

  solve::SimulationOptions options;
  options.stepper.method = solve::Method::kExplicit8;
  options.duration = 2;
  options.sample_interval = 0.5;
  std::vector<double> y = mechanism.start;  // positions, then velocities
  const int a = mechanism.GetJoint("A").q;
  const solve::Ledger ledger =
      solve::Simulate(mechanism.system, options, y,
                      [a](double time, std::span<const double> y, mechanism::Evaluator& evaluator) {
                        std::printf("%.1f s: A %8.4f rad, reaction C.x %9.3f N\n", time, y[a],
                                    evaluator.reactions()[0]);
                      });
  std::printf("energy %.6g J, then %.6g J\n", ledger.energy_start, ledger.energy_end);
} catch (const kingpin::io::InputError& error) {
  std::fprintf(stderr, "%s\n", error.what());  // which part is wrong, what was expected
  return 2;
}
