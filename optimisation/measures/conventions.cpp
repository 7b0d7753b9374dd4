#include "optimisation/measures/conventions.h"

#include <cmath>

#include <fmt/format.h>

#include "core/io/error.h"

namespace kingpin::measures {

Conventions MakeDefaultConventions() { return Conventions{}; }

Conventions MakePaperSetConventions(double gamma_3_scale) {
  Conventions conventions;
  conventions.f1 = 1.0;
  conventions.f2 = 100.0;
  conventions.weighting = signal::Weighting::Named("paper");
  conventions.spectrum_scaling = SpectrumScaling::kAmplitudeLines;
  conventions.end_sample = EndSample::kDropped;
  conventions.gamma_3_scale = gamma_3_scale;
  conventions.gamma_3_root = false;
  return conventions;
}

void CheckConventions(const Conventions& conventions) {
  const auto check = [](bool good, const char* key, double found, const char* expected) {
    if (good) return;
    throw io::InputError({.file = {},
                          .line = 0,
                          .key = key,
                          .found = fmt::format("{:g}", found),
                          .expected = expected,
                          .suggestion = {}});
  };
  const Conventions& c = conventions;
  check(std::isfinite(c.window) && c.window > 0.0, "window", c.window, "a positive time [s]");
  check(c.decay_level > 0.0 && c.decay_level < 1.0, "decay_level", c.decay_level,
        "a share of the largest window energy, between 0 and 1");
  check(std::isfinite(c.f1) && c.f1 >= 0.0, "f1", c.f1, "a frequency of 0 Hz or more");
  check(std::isfinite(c.f2) && c.f2 > c.f1, "f2", c.f2, "a frequency above f1 [Hz]");
  check(std::isfinite(c.gamma_3_scale) && c.gamma_3_scale > 0.0, "gamma_3_scale", c.gamma_3_scale,
        "a positive factor");
}

std::array<std::string, 5> DescribeUnits(const Conventions& conventions) {
  const bool lines = conventions.spectrum_scaling == SpectrumScaling::kAmplitudeLines;
  std::string gamma_3;
  if (conventions.gamma_3_root) {
    gamma_3 = lines ? "mm/s^2" : "mm/s^1.5";
  } else {
    gamma_3 = lines ? "m^2/s^4" : "mm^2/s^3";
  }
  return {"mm/s^2", "mm/s", gamma_3, "s", "mm/s^2"};
}

std::array<std::string, 5> DescribeMeasures(const Conventions& c) {
  const auto units = DescribeUnits(c);
  const std::string ends = c.window_ends == WindowEnds::kTruncated
                               ? "truncated at the record's ends"
                               : "scaled up by window/overlap at the record's ends";
  const std::string rule(signal::ToString(c.quadrature));
  std::string spectrum;
  if (c.spectrum_scaling == SpectrumScaling::kFourierIntegral) {
    spectrum = fmt::format(
        "integral of |A(f) W(f)|^2 over {:g} to {:g} Hz (at most the Nyquist frequency), A = dt "
        "FFT, "
        "one-sided, lines at k/T",
        c.f1, c.f2);
  } else {
    spectrum = fmt::format(
        "sum of (2|X_k|/N)^2 W(f_k)^2 over the lines k/T from {:g} to {:g} Hz, acceleration in {}",
        c.f1, c.f2, c.gamma_3_root ? "mm/s^2" : "m/s^2");
  }
  const std::string end_sample = c.end_sample == EndSample::kFolded
                                     ? "first and last sample averaged into one"
                                     : "last sample dropped";
  const std::string scale =
      c.gamma_3_scale == 1.0 ? std::string() : fmt::format(", times c3 = {:g}", c.gamma_3_scale);
  const std::string crossing = c.decay_time == DecayTime::kFirstToLastCrossing
                                   ? "from the first to the last crossing, linear between samples, "
                                     "an end of the record counts "
                                     "as a crossing"
                                   : "measure of the set, linear between samples";
  return {
      fmt::format("peak-to-peak rim acceleration [{}], (3.10): largest minus smallest sample{}",
                  units[0],
                  c.refine_peaks ? ", each refined by the parabola through three samples" : ""),
      fmt::format(
          "integral over the record of sqrt(g(t)/{:g} s) [{}], (3.11): g = integral of a^2 "
          "over a window of {:g} s centred at t, {}; {} for a^2, trapezoidal rule for the root",
          c.window, units[1], c.window, ends, rule),
      fmt::format("{}{}{} [{}], (3.12){}: {}; weighting {}",
                  c.gamma_3_root ? "square root of the " : "", spectrum, scale, units[2],
                  c.gamma_3_root ? "" : " without its square root", end_sample,
                  c.weighting.description()),
      fmt::format("time with g >= {:g} max g [{}], (3.13): {}; g as in gamma_2", c.decay_level,
                  units[3], crossing),
      fmt::format("root mean square over the record [{}], (3.14): {}", units[4], rule),
  };
}

}  // namespace kingpin::measures
