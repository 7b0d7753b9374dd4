#include "optimisation/measures/gammas.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "core/math/dual.h"
#include "core/signal/resample.h"

namespace kingpin::measures {
namespace {

using signal::Quadrature;
using signal::Weighting;
using testing::HasSubstr;

constexpr double kTurn = 2.0 * std::numbers::pi;

std::vector<double> MakeRecord(std::size_t samples, double time_step,
                               const std::function<double(double)>& function) {
  std::vector<double> record(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    record[i] = function(static_cast<double>(i) * time_step);
  }
  return record;
}

Gammas<double> Calc(const std::vector<double>& record, double time_step,
                    const Conventions& conventions = {}) {
  const GammaPlan plan(record.size(), time_step, conventions);
  GammaWorkspace workspace(plan);
  return CalcGammas(record, workspace);
}

/// Like a kickback: a knock and two decaying oscillations.
double CalcKnock(double t) {
  if (t < 0.12) return 0.0;
  const double s = t - 0.12;
  return 18.0 * std::exp(-8.0 * s) * std::sin(kTurn * 17.0 * s) +
         6.0 * std::exp(-20.0 * s) * std::sin(kTurn * 71.0 * s);
}

/// 1 within [from, to], with the samples outside at 0. Under the trapezoidal rule that lasts
/// to − from + dt.
std::vector<double> MakeBurst(std::size_t samples, double time_step, double from, double to) {
  return MakeRecord(samples, time_step, [=](double t) {
    return t > from - 0.5 * time_step && t < to + 0.5 * time_step ? 1.0 : 0.0;
  });
}

TEST(Gammas, ASineOfWholePeriodsHasItsClosedForms) {
  const double amplitude = 3.0, frequency = 20.0;
  const auto record =
      MakeRecord(1001, 1e-3, [&](double t) { return amplitude * std::sin(kTurn * frequency * t); });
  const auto gammas = Calc(record, 1e-3);
  // Peaks half way between samples: the parabola's vertex is low by 3 ε⁴/128, ε = ω dt, and O(ε⁶).
  const double step = kTurn * frequency * 1e-3;
  EXPECT_NEAR(gammas[0], 2e3 * amplitude * (1.0 - 3.0 / 128.0 * std::pow(step, 4)),
              2e3 * amplitude * std::pow(step, 6) / 64.0);
  // One spectral line of energy density T/4 amplitude² per line width 1/T.
  EXPECT_NEAR(gammas[2], 1e3 * amplitude / 2.0 * Weighting::Named("Wh").CalcMagnitude(frequency),
              1e-9 * gammas[2]);
  // The trapezoidal rule is exact for sin² over whole periods; the 13/24 rule adds
  // dt (f_1 − f_0)/24 at each end, where the missing neighbour is replaced by the end value.
  const double ends = 2.0 * 1e-3 / 24.0 * std::pow(std::sin(step), 2);
  EXPECT_NEAR(gammas[4], 1e3 * amplitude * std::sqrt(0.5 + ends), 1e-12 * gammas[4]);
}

TEST(Gammas, AnAmplitudeLineOfTheSetsConventionIsItsSquare) {
  // 12 Hz, where the paper shape is 1, and 40 Hz, where it is 0.4; c3 = 2.
  const auto record = MakeRecord(1001, 1e-3, [](double t) {
    return 3.0 * std::sin(kTurn * 12.0 * t) + 5.0 * std::cos(kTurn * 40.0 * t);
  });
  const auto gammas = Calc(record, 1e-3, MakePaperSetConventions(2.0));
  EXPECT_NEAR(gammas[2], 2.0 * (9.0 + 25.0 * 0.16), 1e-11);
  // Lines above 100 Hz do not count.
  const auto high = MakeRecord(1001, 1e-3, [](double t) { return std::sin(kTurn * 101.0 * t); });
  EXPECT_NEAR(Calc(high, 1e-3, MakePaperSetConventions(2.0))[2], 0.0, 1e-20);
}

TEST(Gammas, ParsevalTiesGamma3ToGamma5) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Conventions conventions;
  conventions.weighting = Weighting::Named("none");
  conventions.f1 = 0.0;
  conventions.f2 = 1e9;
  conventions.quadrature = Quadrature::kTrapezoid;
  for (const std::size_t samples : {1001u, 1000u, 754u}) {
    std::vector<double> record(samples);
    for (double& x : record) x = normal(random);
    record.back() = record.front();  // one period; otherwise the two differ by dt (a_0 − a_N)²/4
    const double time_step = 1.3e-3;
    const double duration = time_step * static_cast<double>(samples - 1);
    const auto gammas = Calc(record, time_step, conventions);
    EXPECT_NEAR(gammas[2], gammas[4] * std::sqrt(duration / 2.0), 1e-12 * gammas[2]) << samples;
  }
}

TEST(Gammas, TheBandEdgesOfGamma3CutThroughLines) {
  // White record: every line between 0 and Nyquist has the same weight, so Γ_3² is proportional to
  // the band's width, whatever its edges.
  std::vector<double> record(1001, 0.0);
  record[400] = 1.0;
  Conventions conventions;
  conventions.weighting = Weighting::Named("none");
  const auto calc = [&](double f1, double f2) {
    conventions.f1 = f1;
    conventions.f2 = f2;
    const double gamma = Calc(record, 1e-3, conventions)[2];
    return gamma * gamma;
  };
  const double whole = calc(0.0, 500.0);
  EXPECT_NEAR(whole, 1e6 * 1e-6 * 500.0, 1e-9);
  EXPECT_NEAR(calc(1.0, 500.0) / whole, 499.0 / 500.0, 1e-12);
  EXPECT_NEAR(calc(3.3, 77.1) / whole, (77.1 - 3.3) / 500.0, 1e-12);
  EXPECT_NEAR(calc(100.0, 4000.0) / whole, 400.0 / 500.0, 1e-12);
}

TEST(Gammas, ARectangularBurstHasItsClosedForms) {
  // Burst of length d < Δ away from the ends: g rises linearly over d, stays for Δ − d, falls over
  // d.
  const double dt = 1e-4, d = 0.1, window = 0.3;
  const auto record = MakeBurst(10001, dt, 0.4, 0.5 - dt);
  Conventions conventions;
  conventions.window = window;
  conventions.quadrature = Quadrature::kTrapezoid;
  conventions.refine_peaks = false;  // a parabola through a jump overshoots by an eighth of it
  const auto gammas = Calc(record, dt, conventions);
  // ∫ √ is 2/3 of its box over the rise; the rule loses about (dt/d)^1.5 at its vertical tangent.
  EXPECT_NEAR(gammas[1], 1e3 * std::sqrt(d / window) * (window + d / 3.0), 1e3 * 3e-5);
  EXPECT_NEAR(gammas[3], window + d / 2.0, 1e-9);
  EXPECT_NEAR(gammas[4], 1e3 * std::sqrt(d), 1e-9 * gammas[4]);
  EXPECT_NEAR(gammas[0], 1e3, 1e-9);
}

TEST(Gammas, AConstantShowsWhatTheWindowDoesAtTheEnds) {
  const std::vector<double> record(1001, 2.0);
  Conventions conventions;
  // Normalised: the window energy is the same everywhere.
  conventions.window_ends = WindowEnds::kNormalised;
  EXPECT_NEAR(Calc(record, 1e-3, conventions)[1], 2e3, 1e-8);
  EXPECT_DOUBLE_EQ(Calc(record, 1e-3, conventions)[3], 1.0);
  // Truncated: √((0.3 + t)/0.6) over the first 0.3 s, the mirror image at the end.
  conventions.window_ends = WindowEnds::kTruncated;
  const double expected = 2e3 * (0.4 + 2.0 * 0.4 * (1.0 - std::pow(0.5, 1.5)));
  EXPECT_NEAR(Calc(record, 1e-3, conventions)[1], expected, 1e-6 * expected);
}

TEST(Gammas, TheDecayTimeOfAnExponentialIsThatOfItsEnergy) {
  // g is largest at Δ/2, then falls as e^{−2λt}; at the start it is already above a quarter.
  const double decay = 10.0, window = 0.05;
  const auto record = MakeRecord(10001, 1e-4, [&](double t) { return std::exp(-decay * t); });
  Conventions conventions;
  conventions.window = window;
  const auto gammas = Calc(record, 1e-4, conventions);
  EXPECT_NEAR(gammas[3], window / 2.0 + std::log(4.0) / (2.0 * decay), 1e-6);
  EXPECT_NEAR(gammas[4], 1e3 * std::sqrt((1.0 - std::exp(-2.0 * decay)) / (2.0 * decay)),
              1e-6 * gammas[4]);
}

TEST(Gammas, Gamma4OfAnImpulseIsTheOverlapOfWindowAndRecord) {
  // The floor of Γ_4: it moves with the start time of one and the same knock.
  for (const auto& [start, floor] : {std::pair(0.05, 0.35), {0.2, 0.5}, {0.5, 0.6}, {0.95, 0.35}}) {
    const auto record = MakeBurst(1001, 1e-3, start, start);
    EXPECT_NEAR(Calc(record, 1e-3)[3], floor, 1.1e-3) << start;  // the burst is one step wide
  }
}

TEST(Gammas, TheMeasureOfTheSetLeavesOutTheGap) {
  auto record = MakeBurst(1001, 1e-3, 0.2, 0.2);
  record[700] = 1.0;
  Conventions conventions;
  conventions.window = 0.1;
  conventions.quadrature = Quadrature::kTrapezoid;
  const double across = Calc(record, 1e-3, conventions)[3];
  conventions.decay_time = DecayTime::kMeasureOfSet;
  const double set = Calc(record, 1e-3, conventions)[3];
  record[700] = 0.0;
  const double one = Calc(record, 1e-3, conventions)[3];
  EXPECT_NEAR(set, 2.0 * one, 1e-12);
  EXPECT_NEAR(across, 0.5 + one, 1e-12);
}

TEST(Gammas, AWindowBetweenSamplesIntegratesTheBrokenLine) {
  // Half width 25.37 steps. Second route: the broken line of a² integrated piece by piece.
  const double dt = 1e-3, half = 0.02537;
  const auto record = MakeRecord(501, dt, CalcKnock);
  const auto square = [&](double t) {
    const double u = std::clamp(t / dt, 0.0, 500.0);
    const auto i = std::min<std::size_t>(499, static_cast<std::size_t>(u));
    const double s = u - static_cast<double>(i);
    return (1.0 - s) * record[i] * record[i] + s * record[i + 1] * record[i + 1];
  };
  const auto integrate = [&](double from, double to) {
    double sum = 0.0;
    while (from < to - 1e-15) {
      const double next = std::min(to, dt * (std::floor(from / dt + 1e-9) + 1.0));
      sum += 0.5 * (next - from) * (square(from) + square(next));
      from = next;
    }
    return sum;
  };
  double expected = 0.0;
  for (int i = 0; i <= 500; ++i) {
    const double t = i * dt;
    const double energy = integrate(std::max(0.0, t - half), std::min(0.5, t + half));
    expected += (i == 0 || i == 500 ? 0.5 : 1.0) * dt * std::sqrt(energy / (2.0 * half));
  }
  Conventions conventions;
  conventions.window = 2.0 * half;
  conventions.quadrature = Quadrature::kTrapezoid;
  EXPECT_NEAR(Calc(record, dt, conventions)[1], 1e3 * expected, 1e-9 * 1e3 * expected);
}

TEST(Gammas, EqualAnIndependentEvaluationOfThePaperSetsRules) {
  // Written out from the definition, without sharing code: sums for the transform, running sums
  // with the 13/24 rule, crossings.
  const auto a = MakeRecord(1001, 1e-3, CalcKnock);
  const int n = 1000;
  const auto f = [&](int i) {
    i = std::clamp(i, 0, n);
    return a[static_cast<std::size_t>(i)] * a[static_cast<std::size_t>(i)];
  };
  std::vector<double> c(n + 1, 0.0), g, root;
  for (int i = 0; i < n; ++i) {
    c[i + 1] = c[i] + 1e-3 * (13.0 * (f(i) + f(i + 1)) - (f(i - 1) + f(i + 2))) / 24.0;
  }
  for (int i = 0; i <= n; ++i) {
    g.push_back(std::max(0.0, c[std::min(i + 300, n)] - c[std::max(i - 300, 0)]));
  }
  double gamma_2 = 0.0;
  for (int i = 0; i < n; ++i) {
    gamma_2 += 0.5e-3 * (std::sqrt(g[i] / 0.6) + std::sqrt(g[i + 1] / 0.6));
  }
  const double level = 0.25 * *std::max_element(g.begin(), g.end());
  int first = 0, last = n;
  while (g[first] < level) ++first;
  while (g[last] < level) --last;
  const double start =
      first == 0 ? 0.0 : first - 1 + (level - g[first - 1]) / (g[first] - g[first - 1]);
  const double end = last == n ? n : last + (g[last] - level) / (g[last] - g[last + 1]);
  double gamma_3 = 0.0;
  for (int k = 1; k <= 100; ++k) {
    double re = 0.0, im = 0.0;
    for (int i = 0; i < n; ++i) {
      re += a[i] * std::cos(kTurn * k * i / n);
      im += a[i] * std::sin(kTurn * k * i / n);
    }
    const double w = k < 8 ? k / 8.0 : (k > 16 ? 16.0 / k : 1.0);
    gamma_3 += 4.0 * (re * re + im * im) / (double(n) * n) * w * w;
  }
  const auto gammas = Calc(a, 1e-3, MakePaperSetConventions(7.5));
  EXPECT_NEAR(gammas[1], 1e3 * gamma_2, 1e-10 * gammas[1]);
  EXPECT_NEAR(gammas[2], 7.5 * gamma_3, 1e-10 * gammas[2]);
  EXPECT_NEAR(gammas[3], 1e-3 * (end - start), 1e-10);
  EXPECT_NEAR(gammas[4], 1e3 * std::sqrt(c[n]), 1e-10 * gammas[4]);
}

TEST(Gammas, TheParabolaMovesGamma1FromSecondToFourthOrder) {
  const auto calc = [](double dt, bool refine) {
    Conventions conventions;
    conventions.refine_peaks = refine;
    const auto samples = static_cast<std::size_t>(std::lround(0.7 / dt)) + 1;
    // All peaks 0.3 of a step off the samples at every step used.
    const auto record = MakeRecord(
        samples, dt, [=](double t) { return std::cos(kTurn * 2.0 * (t - 0.1 - 0.3 * dt)); });
    return std::abs(Calc(record, dt, conventions)[0] - 2e3);
  };
  EXPECT_NEAR(calc(2e-3, false) / calc(1e-3, false), 4.0, 0.05);
  EXPECT_NEAR(calc(1e-2, true) / calc(5e-3, true), 16.0, 0.5);
}

TEST(Gammas, Gamma2NeverExceedsTheDurationTimesGamma5) {
  std::mt19937_64 random(23);
  std::normal_distribution<double> normal;
  for (int run = 0; run < 50; ++run) {
    std::vector<double> record(301);
    const double decay = 10.0 * normal(random);
    for (std::size_t i = 0; i < record.size(); ++i) {
      record[i] = normal(random) * std::exp(decay * double(i) / 300.0);
    }
    Conventions conventions;
    conventions.window = std::abs(0.2 * normal(random)) + 1e-3;
    conventions.quadrature = Quadrature::kTrapezoid;
    const auto gammas = Calc(record, 2e-3, conventions);
    EXPECT_LE(gammas[1], 0.6 * gammas[4] * (1.0 + 1e-3));  // the root's own trapezoidal rule
  }
}

TEST(Gammas, UniformAndNonUniformSamplingAgreeToTheInterpolantsOrder) {
  const auto exact = Calc(
      MakeRecord(
          8001, 1.25e-4,
          [](double t) { return std::exp(-30.0 * (t - 0.4) * (t - 0.4)) * std::sin(60.0 * t); }),
      1.25e-4);
  std::array<double, 2> error{};
  for (int pass = 0; pass < 2; ++pass) {
    const int intervals = pass == 0 ? 400 : 800;
    std::vector<double> time, value;
    for (int i = 0; i <= intervals; ++i) {
      const double u = double(i) / intervals;
      const double t = i == intervals ? 1.0 : u + 0.1 * std::sin(kTurn * u);
      time.push_back(t);
      value.push_back(std::exp(-30.0 * (t - 0.4) * (t - 0.4)) * std::sin(60.0 * t));
    }
    const auto record = signal::MakeUniform(time, value, signal::Interpolant::kCubic, 1.25e-4);
    ASSERT_TRUE(record.resampled);
    const auto gammas = Calc(record.value, record.time_step);
    for (const int k : {1, 2, 4}) {
      error[pass] = std::max(error[pass], std::abs(gammas[k] / exact[k] - 1.0));
    }
    EXPECT_NEAR(gammas[0], exact[0], 2e-5 * exact[0]);
    EXPECT_NEAR(gammas[3], exact[3], 1e-4);
  }
  EXPECT_LT(error[0], 1e-4);
  EXPECT_GT(std::log2(error[0] / error[1]), 2.9);
}

TEST(Gammas, ScaleWithTheRecordAndNotWithItsSign) {
  const auto record = MakeRecord(1001, 1e-3, CalcKnock);
  auto scaled = record;
  for (double& x : scaled) x *= -2.0;
  const auto a = Calc(record, 1e-3), b = Calc(scaled, 1e-3);
  for (const int k : {0, 1, 2, 4}) EXPECT_NEAR(b[k], 2.0 * a[k], 1e-12 * b[k]);
  EXPECT_DOUBLE_EQ(b[3], a[3]);
}

TEST(Gammas, ARecordOfZerosGivesZeros) {
  const GammaPlan plan(101, 1e-2, {});
  GammaWorkspace workspace(plan);
  const std::vector<double> zeros(101, 0.0);
  EXPECT_EQ(workspace.UpdateWithGradient(zeros), Gammas<double>{});
  for (int k = 0; k < kMeasureCount; ++k) {
    for (const double slope : workspace.gradient(k)) EXPECT_TRUE(std::isfinite(slope));
  }
}

TEST(Gammas, WhatIsNotFiniteGivesNaNAndNoException) {
  const GammaPlan plan(101, 1e-2, {});
  GammaWorkspace workspace(plan);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    std::vector<double> record(101, 1.0);
    record[50] = bad;
    for (const double gamma : workspace.UpdateWithGradient(record)) EXPECT_TRUE(std::isnan(gamma));
    EXPECT_TRUE(std::isnan(workspace.gradient(3)[0]));
  }
  // The workspace is not spoilt by it.
  const auto record = MakeRecord(101, 1e-2, CalcKnock);
  EXPECT_EQ(workspace.Update(record), Calc(record, 1e-2));
}

struct Variant {
  std::string name;
  Conventions conventions;
};

std::vector<Variant> MakeVariants() {
  Conventions trapezoid;
  trapezoid.quadrature = Quadrature::kTrapezoid;
  trapezoid.refine_peaks = false;
  Conventions normalised;
  normalised.window = 0.0777;
  normalised.window_ends = WindowEnds::kNormalised;
  Conventions set;
  set.window = 0.05;
  set.decay_time = DecayTime::kMeasureOfSet;
  set.gamma_3_root = false;
  Conventions lines = MakePaperSetConventions(3.0);
  lines.gamma_3_root = true;
  return {{"default", {}},
          {"paper", MakePaperSetConventions(7.5)},
          {"trapezoid", trapezoid},
          {"normalised", normalised},
          {"set", set},
          {"lines", lines}};
}

TEST(GammaGradient, EqualsCentralDifferencesInEveryConvention) {
  for (const auto& [name, conventions] : MakeVariants()) {
    for (const std::size_t samples : {401u, 402u}) {
      std::vector<double> record = MakeRecord(samples, 2.5e-3, CalcKnock);
      record.front() += 0.3;  // so that the ends count
      record.back() -= 0.4;
      const GammaPlan plan(samples, 2.5e-3, conventions);
      GammaWorkspace workspace(plan), other(plan);
      const auto gammas = workspace.UpdateWithGradient(record);
      EXPECT_EQ(gammas, other.Update(record));
      for (const std::size_t i : {0u, 1u, 2u, 49u, 54u, 55u, 56u, 60u, 200u, 399u, 400u}) {
        // Error of the difference: h² times a third derivative of size 1 per unit, and rounding
        // 1e-16/h, both below 1e-8 of the measure.
        const double h = 1e-5, kept = record[i];
        record[i] = kept + h;
        const auto plus = other.Update(record);
        record[i] = kept - h;
        const auto minus = other.Update(record);
        record[i] = kept;
        for (int k = 0; k < kMeasureCount; ++k) {
          EXPECT_NEAR(workspace.gradient(k)[i], (plus[k] - minus[k]) / (2.0 * h), 1e-7 * gammas[k])
              << name << " gamma_" << k + 1 << " sample " << i << " of " << samples;
        }
      }
    }
  }
}

TEST(GammaDual, CarriesTheDerivativesOfTheRecord) {
  // a(t; p) with amplitude, decay and frequency as variables: the channels against differences of
  // whole records, and against the chain rule with the gradient.
  const auto make = [](std::array<double, 3> p) {
    return MakeRecord(1001, 1e-3, [=](double t) {
      const double s = t - 0.1;
      return s < 0.0 ? 0.0 : p[0] * std::exp(-p[1] * s) * std::sin(kTurn * p[2] * s);
    });
  };
  const std::array<double, 3> centre = {18.0, 8.0, 17.0};
  const GammaPlan plan(1001, 1e-3, {});
  GammaWorkspace workspace(plan);
  using Dual = math::Dual<double, 3>;
  std::vector<Dual> record;
  for (const double x : make(centre)) record.emplace_back(x);
  for (int j = 0; j < 3; ++j) {
    // Of the record itself, by formula.
    for (std::size_t i = 100; i < record.size(); ++i) {
      const double s = 1e-3 * static_cast<double>(i) - 0.1, phase = kTurn * centre[2] * s;
      const double envelope = std::exp(-centre[1] * s);
      record[i].d[j] = j == 0   ? envelope * std::sin(phase)
                       : j == 1 ? -s * centre[0] * envelope * std::sin(phase)
                                : kTurn * s * centre[0] * envelope * std::cos(phase);
    }
  }
  const auto gammas = CalcGammas(std::span<const Dual>(record), workspace);
  for (int j = 0; j < 3; ++j) {
    auto plus = centre, minus = centre;
    const double h = 1e-5 * centre[j];
    plus[j] += h;
    minus[j] -= h;
    const auto high = Calc(make(plus), 1e-3), low = Calc(make(minus), 1e-3);
    for (int k = 0; k < kMeasureCount; ++k) {
      // h² times third derivatives, and rounding 1e-16/1e-5, relative to Γ/p.
      EXPECT_NEAR(gammas[k].d[j], (high[k] - low[k]) / (2.0 * h), 1e-7 * gammas[k].v / centre[j])
          << "gamma_" << k + 1 << " variable " << j;
    }
  }
  // Amplitude: Γ_1, 2, 3, 5 are proportional to it, Γ_4 does not know it.
  for (const int k : {0, 1, 2, 4})
    EXPECT_NEAR(gammas[k].d[0] * 18.0, gammas[k].v, 1e-9 * gammas[k].v);
  EXPECT_NEAR(gammas[3].d[0], 0.0, 1e-12);
  const auto objective = CalcObjective(gammas, Calc(make(centre), 1e-3));
  EXPECT_NEAR(objective.v, 5.0, 1e-12);
  EXPECT_NEAR(objective.d[0], 4.0 / 18.0, 1e-10);
}

TEST(Objective, IsTheWeightedSumOfRatios) {
  const Gammas<double> gammas = {1.0, 2.0, 3.0, 4.0, 5.0}, reference = {2.0, 2.0, 2.0, 2.0, 2.0};
  EXPECT_DOUBLE_EQ(CalcObjective(gammas, reference), 7.5);
  EXPECT_DOUBLE_EQ(CalcObjective(gammas, reference, {2.0, 0.0, 0.0, 0.0, 1.0}), 3.5);
  // A measure without weight may have no reference.
  EXPECT_DOUBLE_EQ(CalcObjective(gammas, {0.0, 2.0, 2.0, 2.0, 2.0}, {0.0, 1.0, 0.0, 0.0, 0.0}),
                   1.0);
}

TEST(GammaPlan, RefusesWhatMakesNoSense) {
  const auto message = [](std::size_t samples, double step, auto change) {
    Conventions conventions;
    change(conventions);
    try {
      GammaPlan plan(samples, step, conventions);
    } catch (const io::InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const auto nothing = [](Conventions&) {};
  EXPECT_EQ(message(1, 1e-3, nothing), "record: found 1 samples, expected at least two");
  EXPECT_THAT(message(9, 0.0, nothing), HasSubstr("a time step of 0 s"));
  EXPECT_THAT(message(9, 1.0, [](auto& c) { c.window = -1.0; }), HasSubstr("window: found -1"));
  EXPECT_THAT(message(9, 1.0, [](auto& c) { c.decay_level = 1.0; }), HasSubstr("decay_level"));
  EXPECT_THAT(message(9, 1.0, [](auto& c) { c.f2 = 0.5; }), HasSubstr("a frequency above f1"));
  EXPECT_THAT(message(9, 1.0, [](auto& c) { c.gamma_3_scale = 0.0; }), HasSubstr("positive"));
  const GammaPlan plan(9, 1.0, {});
  GammaWorkspace workspace(plan);
  const std::vector<double> record(8);
  EXPECT_THROW(workspace.Update(record), std::invalid_argument);
}

TEST(Conventions, AreSpelledOutWithTheirNumbers) {
  const auto words = DescribeMeasures(MakePaperSetConventions(7.56));
  EXPECT_THAT(words[0], HasSubstr("refined by the parabola"));
  EXPECT_THAT(words[1], HasSubstr("window of 0.6 s centred at t, truncated at the record's ends"));
  EXPECT_THAT(words[2], HasSubstr("lines k/T from 1 to 100 Hz"));
  EXPECT_THAT(words[2], HasSubstr("times c3 = 7.56"));
  EXPECT_THAT(words[2], HasSubstr("without its square root"));
  EXPECT_THAT(words[3], HasSubstr("g >= 0.25 max g"));
  EXPECT_EQ(DescribeUnits(MakePaperSetConventions(7.56))[2], "m^2/s^4");
  EXPECT_EQ(DescribeUnits({})[2], "mm/s^1.5");
  EXPECT_THAT(DescribeMeasures({})[2], HasSubstr("weighting Wh: hand and arm"));
}

}  // namespace
}  // namespace kingpin::measures
