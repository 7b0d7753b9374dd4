#include "models/planar/reference_simulation.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "models/planar/planar_model.h"
#include "tests/models/planar/paper_sets.h"
#include "tests/models/planar/planar_car.h"

namespace kingpin::planar {
namespace {

constexpr double kPi = std::numbers::pi;

double CalcLargest(const std::vector<double>& a) {
  double largest = 0.0;
  for (const double x : a) largest = std::max(largest, std::abs(x));
  return largest;
}

// Largest difference over the largest value.
double CalcDistance(const std::vector<double>& a, const std::vector<double>& reference) {
  EXPECT_EQ(a.size(), reference.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), reference.size()); ++i) {
    worst = std::max(worst, std::abs(a[i] - reference[i]));
  }
  return worst / std::max(CalcLargest(reference), 1e-300);
}

double CalcWorstDistance(const History& a, const History& reference) {
  double worst = std::max({CalcDistance(a.rim_acceleration, reference.rim_acceleration),
                           CalcDistance(a.torsion_torque, reference.torsion_torque),
                           CalcDistance(a.tie_rod_force, reference.tie_rod_force)});
  for (int i = 0; i < 5; ++i) {
    worst = std::max(
        {worst, CalcDistance(a.q[i], reference.q[i]), CalcDistance(a.v[i], reference.v[i])});
  }
  return worst;
}

double Bisect(const std::function<double(double)>& f, double low, double high) {
  const bool sign = f(low) > 0.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0.0) == sign ? low : high) = middle;
  }
  return high;
}

TEST(ReferenceSimulation, AgreesWithRungeKutta) {
  for (const auto& set : sets::AllSets()) {
    const Excitation excitation(set.pulses);
    const ReferenceRun run = SimulateReference(set.parameters, excitation);
    SimulationOptions options;
    options.method = Method::kRungeKutta4;
    options.step = 1e-5;
    // At the paper's step Runge-Kutta itself is off by 1e-8 of the maximum in the stiff set B.
    EXPECT_LT(CalcWorstDistance(run.history, Simulate(set.parameters, excitation, options)), 2e-8)
        << set.name;
    // At a quarter of it what remains is the reference's own tolerance, summed over 15000 steps.
    options.step = 2.5e-6;
    EXPECT_LT(CalcWorstDistance(run.history, Simulate(set.parameters, excitation, options)), 4e-9)
        << set.name;
    EXPECT_LT(run.history.CalcEnergyResidual(), 1e-9) << set.name;
  }
}

TEST(ReferenceSimulation, AgreesWithTheFastMethod) {
  for (const auto& set : sets::AllSets()) {
    const Excitation excitation(set.pulses);
    // Pointwise, in the largest value; see FastMethodAgreesWithFineRungeKuttaInEverySignal.
    EXPECT_LT(CalcWorstDistance(Simulate(set.parameters, excitation, {}),
                                SimulateReference(set.parameters, excitation).history),
              2e-5)
        << set.name;
  }
}

TEST(ReferenceSimulation, TighterTolerancesComeNearerToRungeKutta) {
  const auto set = sets::SetA();
  const Excitation excitation(set.pulses);
  SimulationOptions options;
  options.method = Method::kRungeKutta4;
  options.step = 2.5e-6;
  const History fine = Simulate(set.parameters, excitation, options);
  ReferenceOptions tight;
  tight.relative_tolerance = 1e-13;
  tight.absolute_tolerance = 1e-15;
  EXPECT_LT(CalcWorstDistance(SimulateReference(set.parameters, excitation, tight).history, fine),
            1e-10);
}

TEST(ReferenceSimulation, AdamsAndBdfAgree) {
  const auto set = sets::SetC();
  const Excitation excitation(set.pulses);
  ReferenceOptions options;
  options.method = Multistep::kAdams;
  const auto adams = SimulateReference(set.parameters, excitation, options);
  options.method = Multistep::kBdf;
  const auto bdf = SimulateReference(set.parameters, excitation, options);
  EXPECT_EQ(adams.statistics.method, Multistep::kAdams);
  const double distance = CalcWorstDistance(adams.history, bdf.history);
  EXPECT_LT(distance, 1e-8);
}

// ---------------------------------------------------------------------------------------------
// Closed forms: the model reduced to one moving part by very large inertias elsewhere.

constexpr double kHuge = 1e15;

Parameters<double> Reduced() {
  Parameters<double> p = PlanarCar();
  p.carrier_mass = p.carrier_yaw_inertia = p.wheel_inertia = kHuge;
  p.rod_compliance = 1e9;  // next to nothing
  p.damping_time = p.longitudinal_damping = 0.0;
  p.assist_force.count = 0;
  return p;
}

TEST(ReferenceSimulation, CoulombOscillatorTurnsAndStopsWhereItShould) {
  auto p = Reduced();
  p.friction_law = FrictionLaw::kCoulomb;
  p.friction_constant = 100.0;
  const double stiffness = p.column_stiffness * p.gear_ratio * p.gear_ratio;
  const double omega = std::sqrt(stiffness / p.rack_mass);
  const double start = 7.3 * p.friction_constant / stiffness;
  ReferenceOptions options;
  options.duration = 0.1;
  options.initial_position[3] = start;
  const ReferenceRun run = SimulateReference(p, Excitation(), options);
  // Half swings of π/ω, each 2 L/k shorter: 7.3, 5.3, 3.3, 1.3, then |0.7| < 1 sticks.
  const auto& events = run.statistics.events;
  ASSERT_EQ(events.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(events[i].time, static_cast<double>(i + 1) * kPi / omega, 1e-8);
    EXPECT_EQ(events[i].kind, i < 3 ? EventKind::kSlip : EventKind::kStick);
  }
  const double rest = start - 8.0 * p.friction_constant / stiffness;
  EXPECT_NEAR(run.history.q[3].back(), rest, 1e-9 * start);
  // It sticks exactly: not one bit moves after the last event.
  std::size_t held = 0;
  for (std::size_t i = 0; i < run.history.size(); ++i) {
    if (run.history.time[i] <= events.back().time) continue;
    ++held;
    EXPECT_EQ(run.history.q[3][i], run.history.q[3].back());
    EXPECT_EQ(run.history.v[3][i], 0.0);
    EXPECT_EQ(run.history.a[3][i], 0.0);
    EXPECT_NEAR(run.history.friction_force[i], stiffness * rest, 1e-6);
  }
  EXPECT_GT(held, 50u);
  EXPECT_NEAR(run.statistics.sticking_time, options.duration - 4 * kPi / omega, 1e-8);
  // What friction took is force times path: 2 (7.3 + 5.3 + 3.3 + 1.3 − 4) ... = Σ paths L.
  const double path = (7.3 + 2 * 5.3 + 2 * 3.3 + 2 * 1.3 + -0.7) * p.friction_constant / stiffness;
  EXPECT_NEAR(run.history.dissipated_energy.back(), path * p.friction_constant, 1e-9);
}

TEST(ReferenceSimulation, DrivenRackBreaksAwayAndStopsWhereItShould) {
  // The steering wheel, far heavier than the rest, swings φ = φ0 sin Ωt on stiff hands and drags
  // the rack through the column against Coulomb friction.
  auto p = Reduced();
  const double drive = 2.0 * kPi * 5.0;
  const double swing = 0.5;
  p.wheel_inertia = 1e12;
  p.hands_stiffness = p.wheel_inertia * drive * drive;
  p.friction_law = FrictionLaw::kCoulomb;
  p.friction_constant = 1500.0;
  p.rack_mass = 50.0;
  ReferenceOptions options;
  options.duration = 0.2;
  options.initial_velocity[4] = swing * drive;
  const ReferenceRun run = SimulateReference(p, Excitation(), options);

  const double k = p.column_stiffness * p.gear_ratio * p.gear_ratio;
  const double omega = std::sqrt(k / p.rack_mass);
  const double limit = p.friction_constant;
  // Sticks at y = 0 until c_k i_U φ = L.
  const double t1 = std::asin(limit / (p.column_stiffness * p.gear_ratio * swing)) / drive;
  // Slides: y'' + ω² y = ω² (φ0/i_U) sin Ωt − L/m.
  const double forced = swing / p.gear_ratio * omega * omega / (omega * omega - drive * drive);
  const double a = -(forced * std::sin(drive * t1) - limit / k);    // y(t1) = 0
  const double b = -forced * drive * std::cos(drive * t1) / omega;  // y'(t1) = 0
  const auto speed = [&](double t) {
    const double tau = t - t1;
    return forced * drive * std::cos(drive * t) +
           omega * (-a * std::sin(omega * tau) + b * std::cos(omega * tau));
  };
  // First return to rest after break-away.
  double low = t1 + 1e-4;
  ASSERT_GT(speed(low), 0.0);
  while (speed(low + 1e-5) > 0.0) low += 1e-5;
  const double t2 = Bisect(speed, low, low + 1e-5);

  const auto& events = run.statistics.events;
  ASSERT_GE(events.size(), 2u);
  EXPECT_EQ(events[0].kind, EventKind::kSlip);
  EXPECT_EQ(events[0].direction, 1);
  EXPECT_NEAR(events[0].time, t1, 1e-8);
  EXPECT_NEAR(events[1].time, t2, 1e-8);
  for (std::size_t i = 0; i < run.history.size() && run.history.time[i] < t1; ++i) {
    EXPECT_EQ(run.history.q[3][i], 0.0);
  }
}

TEST(ReferenceSimulation, TorsionBarMeetsItsStopOnTime) {
  auto p = Reduced();
  p.wheel_inertia = 0.04;
  p.rack_mass = kHuge;
  p.stop_angle = 0.02;
  p.stop_stiffness = 800.0;
  ReferenceOptions options;
  options.duration = 0.2;
  const double speed = 2.0;
  options.initial_velocity[4] = speed;
  const ReferenceRun run = SimulateReference(p, Excitation(), options);
  const double w1 = std::sqrt(p.column_stiffness / p.wheel_inertia);
  const double w2 = std::sqrt(p.stop_stiffness / p.wheel_inertia);
  const double t1 = std::asin(p.stop_angle * w1 / speed) / w1;
  // In the stop the spring pulls towards θ_c = θ_s (1 − c_k/c_s).
  const double arm = p.stop_angle * p.column_stiffness / p.stop_stiffness;
  const double entry = speed * std::cos(w1 * t1);
  const double t2 = t1 + 2.0 / w2 * (kPi / 2 - std::atan2(arm * w2, entry));
  const double t3 = t2 + 2.0 * t1;  // through the middle to the other stop
  const auto& events = run.statistics.events;
  ASSERT_GE(events.size(), 3u);
  EXPECT_NEAR(events[0].time, t1, 1e-8);
  EXPECT_EQ(events[0].kind, EventKind::kStopContact);
  EXPECT_EQ(events[0].direction, 1);
  EXPECT_NEAR(events[1].time, t2, 1e-8);
  EXPECT_EQ(events[1].kind, EventKind::kStopRelease);
  EXPECT_NEAR(events[2].time, t3, 1e-8);
  EXPECT_EQ(events[2].direction, -1);
  // No damping anywhere: energy stays, up to what 11 digits per step let drift.
  const double energy = 0.5 * p.wheel_inertia * speed * speed;
  EXPECT_NEAR(run.history.kinetic_energy.back() + run.history.potential_energy.back(), energy,
              1e-8 * energy);
}

TEST(ReferenceSimulation, RackRattlesInItsFreePlayOnTime) {
  auto p = Reduced();
  p.column_stiffness = 1e-12;
  p.rod_compliance = 2e-7;
  p.rod_free_play = 2e-4;
  // The rod along y: its elongation is −y exactly.
  p.rack_position = p.outer_joint_x;
  ReferenceOptions options;
  options.duration = 0.05;
  const double speed = 0.05;
  options.initial_velocity[3] = speed;
  const ReferenceRun run = SimulateReference(p, Excitation(), options);
  const double c = MakeModel(p).constants.rod_stiffness;
  const double contact = kPi / std::sqrt(c / p.rack_mass);
  const double flight = p.rod_free_play / speed;
  const auto& events = run.statistics.events;
  ASSERT_GE(events.size(), 6u);
  double t = 0.5 * flight;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(events[i].time, t, 1e-8) << i;
    EXPECT_EQ(events[i].kind, i % 2 == 0 ? EventKind::kPlayContact : EventKind::kPlayRelease);
    // Moving to the left presses the rod first.
    EXPECT_EQ(events[i].direction, i % 4 < 2 ? -1 : 1);
    t += i % 2 == 0 ? contact : flight;
  }
  EXPECT_NEAR(std::abs(run.history.v[3].front()), speed, 0.0);
}

TEST(ReferenceSimulation, DampedContactTakesEnergyOutAtEveryImpact) {
  auto p = Reduced();
  p.column_stiffness = 1e-12;
  p.rod_compliance = 2e-7;
  p.rod_free_play = 2e-4;
  p.rack_position = p.outer_joint_x;
  p.damping_time = 1e-4;
  ReferenceOptions options;
  options.duration = 0.05;
  const double speed = 0.05;
  options.initial_velocity[3] = speed;
  const ReferenceRun run = SimulateReference(p, Excitation(), options);
  // Damped half swing from δ = 0 to δ = 0 with speed −e v: the spring-damper may pull at the end,
  // as the law says: e = exp(−ζ π/sqrt(1 − ζ²)).
  const double c = MakeModel(p).constants.rod_stiffness;
  const double zeta = 0.5 * p.damping_time * std::sqrt(c / p.rack_mass);
  const double e = std::exp(-zeta * kPi / std::sqrt(1.0 - zeta * zeta));
  const auto& events = run.statistics.events;
  ASSERT_GE(events.size(), 3u);
  EXPECT_NEAR(events[2].time - events[1].time, p.rod_free_play / (e * speed), 1e-8);
}

// ---------------------------------------------------------------------------------------------
// Whole models with friction.

Parameters<double> WithFriction(Parameters<double> p) {
  p.friction_law = FrictionLaw::kCoulomb;
  p.friction_coefficient = 0.08;
  p.friction_preload = 1200.0;
  return p;
}

TEST(ReferenceSimulation, EnergyLedgerClosesWithFrictionStopsAndFreePlay) {
  auto all = std::vector<Parameters<double>>{WithFriction(PlanarCar())};
  all.push_back(all[0]);
  all[1].stop_angle = 0.01;
  all[1].stop_stiffness = 800.0;
  all[1].rod_free_play = 1e-4;
  all.push_back(all[1]);
  all[2].assist_lag = AssistLag::kFirstOrder;
  all[2].assist_time = 0.012;
  all[2].aligning_stiffness = 2700.0;
  all[2].aligning_lag = 0.05;
  Pulse pulse;
  pulse.amplitude = 3000.0;
  pulse.start = 0.1;
  pulse.duration = 0.02;
  for (const auto& p : all) {
    const ReferenceRun run = SimulateReference(p, Excitation({pulse}));
    EXPECT_LT(run.history.CalcEnergyResidual(), 1e-9);
    EXPECT_GT(run.statistics.events.size(), 2u);
    for (std::size_t i = 1; i < run.history.size(); ++i) {
      EXPECT_GE(run.history.dissipated_energy[i], run.history.dissipated_energy[i - 1] - 1e-12);
      // Friction never pushes, and never exceeds its limit.
      EXPECT_LE(run.history.friction_force[i] * run.history.v[3][i], 0.0);
    }
  }
}

TEST(ReferenceSimulation, CoulombFrictionAgreesWithRungeKutta) {
  for (const auto& set : sets::AllSets()) {
    const auto p = WithFriction(set.parameters);
    const Excitation excitation(set.pulses);
    SimulationOptions options;
    options.method = Method::kRungeKutta4;
    options.step = 1e-5;
    const History expected = Simulate(p, excitation, options);
    const ReferenceRun run = SimulateReference(p, excitation);
    // Runge-Kutta at 1e-5 s is off by 6e-8 of the maximum: about a hundred events per run.
    EXPECT_LT(CalcWorstDistance(run.history, expected), 2e-7) << set.name;
    EXPECT_GT(run.statistics.events.size(), 50u);
    for (std::size_t i = 0; i < run.history.size(); ++i) {
      if (run.history.v[3][i] == 0.0) {
        EXPECT_EQ(run.history.a[3][i], 0.0);
      }
    }
  }
}

TEST(ReferenceSimulation, CoulombFrictionAgreesWithFineRungeKutta) {
  const auto set = sets::SetB();
  const auto p = WithFriction(set.parameters);
  const Excitation excitation(set.pulses);
  SimulationOptions options;
  options.method = Method::kRungeKutta4;
  options.step = 2.5e-6;
  const ReferenceRun run = SimulateReference(p, excitation);
  EXPECT_LT(CalcWorstDistance(run.history, Simulate(p, excitation, options)), 1e-8);
}

TEST(ReferenceSimulation, StopsAndFreePlayAgreeWithRungeKutta) {
  Pulse pulse;
  pulse.amplitude = 3000.0;
  pulse.start = 0.1;
  pulse.duration = 0.02;
  const Excitation excitation({pulse});
  SimulationOptions options;
  options.method = Method::kRungeKutta4;
  options.step = 5e-6;
  options.duration = 0.3;
  ReferenceOptions reference;
  reference.duration = 0.3;
  auto p = PlanarCar();
  p.stop_angle = 0.01;
  p.stop_stiffness = 800.0;
  EXPECT_LT(CalcWorstDistance(SimulateReference(p, excitation, reference).history,
                              Simulate(p, excitation, options)),
            1e-8);
  // The rod's damper jumps at the end of the free play, and at once breaks the rack away from
  // friction. Stages of a Runge-Kutta step that ends there stand on both sides of the jump: first
  // order in the step, 3e-4 of the maximum here, half of it at half the step.
  p = WithFriction(p);
  p.rod_free_play = 1e-4;
  EXPECT_LT(CalcWorstDistance(SimulateReference(p, excitation, reference).history,
                              Simulate(p, excitation, options)),
            2e-3);
}

TEST(ReferenceSimulation, RackHoldsBelowBreakaway) {
  auto p = WithFriction(PlanarCar());
  p.friction_constant = 1e6;
  Pulse pulse;
  pulse.amplitude = 3000.0;
  pulse.start = 0.1;
  pulse.duration = 0.02;
  const ReferenceRun run = SimulateReference(p, Excitation({pulse}));
  EXPECT_EQ(CalcLargest(run.history.q[3]), 0.0);
  EXPECT_LT(CalcLargest(run.history.q[4]), 1e-20);  // rounding of the linear solver
  EXPECT_GT(CalcLargest(run.history.friction_force), 100.0);
  EXPECT_NEAR(run.statistics.sticking_time, 1.0, 1e-12);
}

TEST(ReferenceSimulation, RunsInParallelBitForBit) {
  const auto set = sets::SetC();
  const auto p = WithFriction(set.parameters);
  const Excitation excitation(set.pulses);
  const auto alone = SimulateReference(p, excitation).history.rim_acceleration;
  std::vector<std::vector<double>> results(4);
  {
    std::vector<std::jthread> threads;
    for (auto& result : results) {
      threads.emplace_back(
          [&] { result = SimulateReference(p, excitation).history.rim_acceleration; });
    }
  }
  for (const auto& result : results) EXPECT_EQ(result, alone);
}

TEST(ReferenceSimulation, ErrorsSayWhatIsWrong) {
  ReferenceOptions options;
  options.relative_tolerance = 0.0;
  EXPECT_THAT([&] { SimulateReference(PlanarCar(), Excitation(), options); },
              testing::ThrowsMessage<io::InputError>(testing::HasSubstr("a tolerance > 0")));
  // A rack that pushes itself: negative stiffness by an assistance that points the wrong way.
  auto p = PlanarCar();
  for (auto& f : p.assist_force.f) f *= -20.0;
  Pulse pulse;
  pulse.amplitude = 3000.0;
  pulse.start = 0.1;
  pulse.duration = 0.02;
  EXPECT_THAT([&] { SimulateReference(p, Excitation({pulse})); },
              testing::ThrowsMessage<io::RunError>(
                  testing::AllOf(testing::HasSubstr("reference integration at t = "),
                                 testing::HasSubstr("diverges in coordinate"))));
}

}  // namespace
}  // namespace kingpin::planar
