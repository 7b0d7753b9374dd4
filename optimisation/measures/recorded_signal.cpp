#include "optimisation/measures/recorded_signal.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/io/error.h"
#include "core/io/units.h"
#include "core/signal/resample.h"
#include "optimisation/measures/companions.h"
#include "optimisation/measures/gammas.h"

namespace kingpin::measures {
namespace {

[[noreturn]] void Reject(std::string file, std::string key, std::string found, std::string expected,
                         std::string suggestion = {}) {
  throw io::InputError({.file = std::move(file),
                        .line = 0,
                        .key = std::move(key),
                        .found = std::move(found),
                        .expected = std::move(expected),
                        .suggestion = std::move(suggestion)});
}

bool HasDimension(const io::Signals::Channel& channel, const char* unit) {
  return !channel.unit.empty() &&
         io::IsUsableAs(io::ParseUnit(channel.unit).dimension, io::ParseUnit(unit).dimension);
}

/// Factor from the channel's SI values to the rim's acceleration in m/s².
double CalcRimFactor(const io::Signals& signals, const io::Signals::Channel& channel,
                     const std::optional<double>& radius) {
  const char* expected =
      "an acceleration of the rim (m/s^2, mm/s^2 or g), or of the steering wheel (rad/s^2) with "
      "--radius";
  if (channel.unit == "g") {
    // Read as grams by the table of units; among accelerations it is the standard gravity.
    if (radius)
      Reject(signals.file, channel.name, "unit 'g'", "no --radius with a rim acceleration");
    return 1000.0 * io::kStandardGravity;
  }
  if (HasDimension(channel, "m/s^2")) {
    if (radius) {
      Reject(signals.file, channel.name, fmt::format("unit '{}'", channel.unit),
             "no --radius with a rim acceleration");
    }
    return 1.0;
  }
  if (HasDimension(channel, "rad/s^2")) {
    if (!radius) {
      Reject(signals.file, channel.name, fmt::format("unit '{}'", channel.unit), expected,
             "give the radius of the rim, e.g. --radius '185 mm'");
    }
    if (*radius <= 0.0) {
      Reject("command line", "--radius", fmt::format("{:g} m", *radius), "a positive length");
    }
    return *radius;
  }
  Reject(signals.file, channel.name,
         channel.unit.empty() ? std::string("no unit") : fmt::format("unit '{}'", channel.unit),
         expected,
         channel.unit.empty() ? std::string("write the unit in row 2, below the name")
                              : std::string());
}

nlohmann::ordered_json MakeJson(const VibrationStatistics& statistics) {
  return {{"peak", statistics.peak},
          {"rms", statistics.rms},
          {"rmq", statistics.rmq},
          {"vdv", statistics.vdv},
          {"mtvv_1s", statistics.mtvv},
          {"mtvv_125ms", statistics.mtvv_eighth},
          {"crest_factor", statistics.crest_factor}};
}

/// `start` is the time of the first sample: times are given as the file counts them.
nlohmann::ordered_json MakeJson(const Extremes& extremes, const std::string& unit, double start) {
  return {{"unit", unit},
          {"peak", extremes.peak},
          {"time_of_peak", start + extremes.time_of_peak},
          {"maximum", extremes.maximum},
          {"minimum", extremes.minimum},
          {"peak_to_peak", extremes.peak_to_peak},
          {"impulse", extremes.impulse}};
}

/// The part of the record that is evaluated: indices [begin, end) of the file's samples.
struct Section {
  std::size_t begin = 0, end = 0;
};

Section FindSection(const io::Signals& signals, const std::optional<double>& from,
                    const std::optional<double>& to) {
  const std::vector<double>& time = signals.time;
  // A thousandth of a nanosecond lets 0.1 s find the sample that is printed as 0.1.
  const double slack = 1e-12 * std::max(1.0, time.back() - time.front());
  Section section{0, time.size()};
  if (from) {
    section.begin = static_cast<std::size_t>(
        std::lower_bound(time.begin(), time.end(), *from - slack) - time.begin());
  }
  if (to) {
    section.end = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), *to + slack) -
                                           time.begin());
  }
  if (section.end < section.begin + 2) {
    Reject(signals.file, "time",
           fmt::format("{} samples from {:g} to {:g} s",
                       section.end > section.begin ? section.end - section.begin : 0,
                       from.value_or(time.front()), to.value_or(time.back())),
           "at least two",
           fmt::format("the record lasts from {:g} to {:g} s", time.front(), time.back()));
  }
  return section;
}

}  // namespace

nlohmann::ordered_json EvaluateSignal(const io::Signals& signals, const Conventions& conventions,
                                      const RecordedSignalOptions& options) {
  if (options.channel.empty() && signals.channels.size() != 1) {
    std::vector<std::string> names;
    for (const auto& channel : signals.channels) names.push_back(channel.name);
    Reject(signals.file, "--channel", fmt::format("{} channels", names.size()),
           "the name of one of them", fmt::format("channels: {}", fmt::join(names, ", ")));
  }
  const io::Signals::Channel& channel =
      options.channel.empty() ? signals.channels.front() : io::GetChannel(signals, options.channel);
  const double factor = CalcRimFactor(signals, channel, options.radius);
  const Section section = FindSection(signals, options.from, options.to);
  const auto interpolant =
      options.linear ? signal::Interpolant::kLinear : signal::Interpolant::kCubic;
  const std::size_t count = section.end - section.begin;
  const std::span<const double> time = std::span(signals.time).subspan(section.begin, count);
  if (options.step > 0.0 && (time.back() - time.front()) / options.step > 1e7) {
    Reject("command line", "--step", fmt::format("{:g} s", options.step),
           fmt::format("at most ten million steps in {:g} s", time.back() - time.front()));
  }
  const auto make_uniform = [&](const io::Signals::Channel& from) {
    return signal::MakeUniform(time, std::span(from.values).subspan(section.begin, count),
                               interpolant, options.step);
  };
  signal::UniformRecord record = make_uniform(channel);
  for (double& value : record.value) value *= factor;
  const double nyquist = 0.5 / record.time_step;
  if (nyquist <= conventions.f1) {
    Reject(signals.file, "f1", fmt::format("{:g} Hz", conventions.f1),
           fmt::format("a frequency below {:g} Hz, half the rate of the record", nyquist));
  }

  const auto get_force = [&](const std::string& name, const char* unit) -> std::vector<double> {
    if (name.empty()) return {};
    const io::Signals::Channel& force = io::GetChannel(signals, name);
    if (!HasDimension(force, unit)) {
      Reject(signals.file, force.name, fmt::format("unit '{}'", force.unit),
             fmt::format("'{}'", unit));
    }
    return make_uniform(force).value;
  };
  const std::vector<double> torque = get_force(options.torque, "N m");
  const std::vector<double> rack_force = get_force(options.rack_force, "N");
  const std::vector<double> tie_rod_force = get_force(options.tie_rod_force, "N");

  const GammaPlan plan(record.value.size(), record.time_step, conventions);
  GammaWorkspace workspace(plan);
  const Gammas<double> gammas = CalcGammas(record.value, workspace);
  CompanionOptions companion_options;
  companion_options.weighting = conventions.weighting;
  companion_options.short_window = options.short_window;
  companion_options.decay_level = conventions.decay_level;
  const Companions companions = CalcCompanions({.rim_acceleration = record.value,
                                                .torsion_torque = torque,
                                                .rack_force = rack_force,
                                                .tie_rod_force = tie_rod_force},
                                               record.time_step, companion_options);

  const auto units = DescribeUnits(conventions);
  const auto words = DescribeMeasures(conventions);
  nlohmann::ordered_json json;
  nlohmann::ordered_json unit_json, word_json;
  for (std::size_t k = 0; k < kMeasureCount; ++k) {
    const std::string key = fmt::format("gamma_{}", k + 1);
    json[key] = gammas[k];
    unit_json[key] = units[k];
    word_json[key] = words[k];
  }
  json["units"] = unit_json;
  json["record"] = {{"file", signals.file},      {"channel", channel.name},
                    {"unit", channel.unit},      {"from", time.front()},
                    {"to", time.back()},         {"duration", plan.duration()},
                    {"samples", plan.samples()}, {"time_step", plan.time_step()}};
  if (options.radius) json["record"]["radius"] = *options.radius;
  json["record"]["sampling"] = record.resampled ? fmt::format("resampled from {} samples: {}",
                                                              count, signal::ToString(interpolant))
                                                : std::string("as in the file");
  json["conventions"] = word_json;
  nlohmann::ordered_json& beside = json["companions"];
  beside["unweighted"] = MakeJson(companions.unweighted);
  beside["weighted"] = MakeJson(companions.weighted);
  beside["weighting"] = conventions.weighting.description();
  beside["units"] = "m/s^2; vdv m/s^1.75; crest_factor 1";
  beside["short_decay_time"] = companions.short_decay_time;
  beside["short_decay_window"] = options.short_window;
  if (companions.torsion_torque) {
    beside["torsion_torque"] = MakeJson(*companions.torsion_torque, "N m, N m s, s", record.start);
  }
  if (companions.rack_force)
    beside["rack_force"] = MakeJson(*companions.rack_force, "N, N s, s", record.start);
  if (companions.tie_rod_force) {
    beside["tie_rod_force"] = MakeJson(*companions.tie_rod_force, "N, N s, s", record.start);
  }
  return json;
}

}  // namespace kingpin::measures
