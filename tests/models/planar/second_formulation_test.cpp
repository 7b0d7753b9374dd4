#include "tests/models/planar/second_formulation.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "models/planar/accelerations.h"
#include "models/planar/excitation.h"
#include "models/planar/simulate.h"
#include "tests/models/planar/paper_sets.h"
#include "tests/models/planar/planar_car.h"

namespace kingpin::planar {
namespace {

using Vector = second::Vector5<double>;

struct Variant {
  std::string name;
  Parameters<double> parameters;
};

std::vector<Variant> AllVariants() {
  std::vector<Variant> all;
  for (const auto& set : sets::AllSets()) all.push_back({"set " + set.name, set.parameters});
  all.push_back({"car", PlanarCar()});
  auto p = PlanarCar();
  p.design_origin_x = 0.01;
  p.design_origin_y = -0.012;
  p.outer_joint_y = -0.027;
  p.aligning_stiffness = 700.0;
  p.hands_stiffness = 5.0;
  p.hands_damping = 0.4;
  p.rack_damping = 600.0;
  all.push_back({"car with hands and aligning torque", p});
  p = PlanarCar();
  p.stop_angle = 0.02;
  p.stop_stiffness = 800.0;
  p.rod_free_play = 1e-4;
  all.push_back({"car with stops and free play", p});
  p = sets::SetB().parameters;
  p.two_way = false;
  all.push_back({"one-way B", p});
  p = sets::SetA().parameters;
  p.friction_law = FrictionLaw::kSmoothed;
  p.friction_coefficient = 0.08;
  p.friction_preload = 1200.0;
  p.friction_constant = 20.0;
  all.push_back({"A with friction", p});
  return all;
}

TEST(SecondFormulation, AccelerationsAgreeAtRandomStates) {
  for (const auto& [name, p] : AllVariants()) {
    const second::Model second(p);
    const Model<double> model = MakeModel(p);
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    double worst = 0.0;
    for (int trial = 0; trial < 500; ++trial) {
      // Far beyond what a kick does: 15 mm, 0.1 rad, 2 mm of rack, past both ends of the curves.
      const Vector q{0.015 * uniform(random), 0.005 * uniform(random), 0.1 * uniform(random),
                     0.002 * uniform(random), 0.3 * uniform(random)};
      const Vector v{0.5 * uniform(random), 0.2 * uniform(random), 2.0 * uniform(random),
                     0.1 * uniform(random), 10.0 * uniform(random)};
      const double force = 5000.0 * uniform(random);
      State<double> x{};
      for (std::size_t i = 0; i < 5; ++i) {
        x.q[i] = q[i];
        x.v[i] = v[i];
      }
      std::array<double, 5> a{};
      CalcAccelerations(model, x, force, a.data());
      const Vector b = second.Accelerations(q, v, force);
      for (std::size_t i = 0; i < 5; ++i) {
        // Sums of large forces: relative to the largest acceleration of a unit of inertia.
        const double scale = std::max(std::abs(b[i]), 1.0);
        worst = std::max(worst, std::abs(a[i] - b[i]) / scale);
      }
    }
    EXPECT_LT(worst, 1e-10) << name;
  }
}

TEST(SecondFormulation, CoulombLimitAndReactionAgree) {
  auto p = PlanarCar();
  p.friction_law = FrictionLaw::kCoulomb;
  p.friction_coefficient = 0.08;
  p.friction_preload = 1200.0;
  const second::Model second(p);
  const Model<double> model = MakeModel(p);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const Vector q{0.01 * uniform(random), 0.003 * uniform(random), 0.05 * uniform(random),
                   0.001 * uniform(random), 0.2 * uniform(random)};
    const Vector v{0.5 * uniform(random), 0.2 * uniform(random), 2.0 * uniform(random), 0.0,
                   10.0 * uniform(random)};
    State<double> x{};
    for (std::size_t i = 0; i < 5; ++i) {
      x.q[i] = q[i];
      x.v[i] = v[i];
    }
    const auto held = CalcForces(model, x, 1000.0, 0.0);
    const double push =
        second.Forces(q, v, 1000.0, 0.0)[3] + second.AssistForce(second.BarTorque(q));
    EXPECT_EQ(held.a[3], 0.0);
    EXPECT_NEAR(held.friction_force, -push, 1e-10 * std::max(1.0, std::abs(push)));
    EXPECT_NEAR(held.friction_limit, second.FrictionLimit(q, v), 1e-10 * held.friction_limit);
    const auto sliding = CalcForces(model, x, 1000.0, 1.0);
    EXPECT_NEAR(sliding.a[3] * p.rack_mass, push - held.friction_limit,
                1e-9 * std::max(1.0, std::abs(push)));
  }
}

TEST(SecondFormulation, TrajectoriesAgree) {
  // The same method and step on both derivations; the product also ends steps at the kinks of the
  // excitation (third derivatives jump there).
  for (const auto& set : sets::AllSets()) {
    const Excitation excitation(set.pulses);
    const auto force = [&](double t) {
      double sum = 0.0;
      for (const Pulse& pulse : set.pulses) {
        const double u = (t - pulse.start) / pulse.duration;
        sum += pulse.amplitude * std::pow(std::max(0.0, 4.0 * u * (1.0 - u)), 3);
      }
      return sum;
    };
    const second::Model second(set.parameters);
    Vector q{}, v{};
    constexpr double kStep = 1e-5;
    constexpr int kPerSample = 100;
    const int samples = 300;  // up to 0.3 s, past the first pulses
    std::vector<double> rim{0.0};
    double t = 0.0;
    const auto add = [](Vector x, double h, const Vector& dx) {
      for (std::size_t i = 0; i < 5; ++i) x[i] += h * dx[i];
      return x;
    };
    for (int s = 0; s < samples; ++s) {
      for (int n = 0; n < kPerSample; ++n) {
        t = (s * kPerSample + n) * kStep;
        const Vector a1 = second.Accelerations(q, v, force(t));
        const Vector v2 = add(v, 0.5 * kStep, a1);
        const Vector a2 = second.Accelerations(add(q, 0.5 * kStep, v), v2, force(t + 0.5 * kStep));
        const Vector v3 = add(v, 0.5 * kStep, a2);
        const Vector a3 = second.Accelerations(add(q, 0.5 * kStep, v2), v3, force(t + 0.5 * kStep));
        const Vector v4 = add(v, kStep, a3);
        const Vector a4 = second.Accelerations(add(q, kStep, v3), v4, force(t + kStep));
        for (std::size_t i = 0; i < 5; ++i) {
          q[i] += kStep / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i]);
          v[i] += kStep / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
        }
      }
      rim.push_back(second.Accelerations(q, v, force((s + 1) * kPerSample * kStep))[4] *
                    set.parameters.rim_radius);
    }
    SimulationOptions options;
    options.method = Method::kRungeKutta4;
    options.duration = 0.3;
    options.step = 1e-5;
    const History history = Simulate(set.parameters, excitation, options);
    double worst = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < rim.size(); ++i) {
      worst = std::max(worst, std::abs(rim[i] - history.rim_acceleration[i]));
      largest = std::max(largest, std::abs(rim[i]));
    }
    // What remains is rounding, and how the product cuts its steps at the kinks.
    EXPECT_LT(worst, 1e-11 * largest) << set.name;
  }
}

}  // namespace
}  // namespace kingpin::planar
