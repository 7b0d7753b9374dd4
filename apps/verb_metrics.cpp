#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/common_options.h"
#include "core/io/csv.h"
#include "core/io/error.h"
#include "core/io/json_text.h"
#include "core/io/output_file.h"
#include "core/io/units.h"
#include "core/signal/resample.h"
#include "optimisation/measures/companions.h"
#include "optimisation/measures/gammas.h"

namespace kingpin::apps {

namespace {

constexpr double kStandardGravity = 9.80665;  // [m/s²]

/// Options as typed; quantities keep their text until they are read with their unit.
struct MetricsOptions {
  std::string file;
  std::string channel, torque, rack_force, tie_rod_force;
  std::string radius;
  std::string from, to, step;
  std::string weighting;
  std::string f1, f2, window, decay_level, short_window = "0.05";
  std::optional<double> paper_set;
  bool without_root = false;
  bool normalise_window = false;
  bool decay_of_set = false;
  bool sampled_peaks = false;
  bool linear = false;
};

[[noreturn]] void Reject(std::string file, std::string key, std::string found, std::string expected,
                         std::string suggestion = {}) {
  throw io::InputError({.file = std::move(file),
                        .line = 0,
                        .key = std::move(key),
                        .found = std::move(found),
                        .expected = std::move(expected),
                        .suggestion = std::move(suggestion)});
}

/// The quantity in SI if the option was given.
std::optional<double> ReadOption(const std::string& text, const char* option, const char* unit) {
  if (text.empty()) return std::nullopt;
  try {
    return io::ParseQuantity(text, io::ParseUnit(unit));
  } catch (const io::InputError& error) {
    io::InputProblem problem = error.problem();
    problem.file = "command line";
    problem.key = option;
    throw io::InputError(problem);
  }
}

bool HasDimension(const io::Signals::Channel& channel, const char* unit) {
  return !channel.unit.empty() &&
         io::IsUsableAs(io::ParseUnit(channel.unit).dimension, io::ParseUnit(unit).dimension);
}

signal::Weighting ReadWeighting(const std::string& name) {
  const std::filesystem::path path(name);
  if (path.extension() == ".csv" || path.has_parent_path())
    return signal::Weighting::FromFile(path);
  return signal::Weighting::Named(name);
}

measures::Conventions ReadConventions(const MetricsOptions& options) {
  measures::Conventions conventions = options.paper_set
                                          ? measures::MakePaperSetConventions(*options.paper_set)
                                          : measures::MakeDefaultConventions();
  if (!options.weighting.empty()) conventions.weighting = ReadWeighting(options.weighting);
  const auto read = [](double* target, const std::string& text, const char* key, const char* unit) {
    if (const auto value = ReadOption(text, key, unit)) *target = *value;
  };
  read(&conventions.f1, options.f1, "--f1", "Hz");
  read(&conventions.f2, options.f2, "--f2", "Hz");
  read(&conventions.window, options.window, "--window", "s");
  read(&conventions.decay_level, options.decay_level, "--decay-level", "-");
  if (options.without_root) conventions.gamma_3_root = false;
  if (options.normalise_window) conventions.window_ends = measures::WindowEnds::kNormalised;
  if (options.decay_of_set) conventions.decay_time = measures::DecayTime::kMeasureOfSet;
  if (options.sampled_peaks) conventions.refine_peaks = false;
  measures::CheckConventions(conventions);
  return conventions;
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
    return 1000.0 * kStandardGravity;
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

nlohmann::ordered_json MakeJson(const measures::VibrationStatistics& statistics) {
  return {{"peak", statistics.peak},
          {"rms", statistics.rms},
          {"rmq", statistics.rmq},
          {"vdv", statistics.vdv},
          {"mtvv_1s", statistics.mtvv},
          {"mtvv_125ms", statistics.mtvv_eighth},
          {"crest_factor", statistics.crest_factor}};
}

/// `start` is the time of the first sample: times are given as the file counts them.
nlohmann::ordered_json MakeJson(const measures::Extremes& extremes, const std::string& unit,
                                double start) {
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

std::string CalcMetrics(const MetricsOptions& options) {
  const measures::Conventions conventions = ReadConventions(options);
  const auto radius = ReadOption(options.radius, "--radius", "m");
  const auto step = ReadOption(options.step, "--step", "s");
  if (step && *step <= 0.0) {
    Reject("command line", "--step", fmt::format("{:g} s", *step), "a positive time");
  }
  const auto short_window = ReadOption(options.short_window, "--short-window", "s");
  if (*short_window <= 0.0) {
    Reject("command line", "--short-window", fmt::format("{:g} s", *short_window),
           "a positive time");
  }

  const io::Signals signals = io::ReadSignals(options.file);
  if (options.channel.empty() && signals.channels.size() != 1) {
    std::vector<std::string> names;
    for (const auto& channel : signals.channels) names.push_back(channel.name);
    Reject(signals.file, "--channel", fmt::format("{} channels", names.size()),
           "the name of one of them", fmt::format("channels: {}", fmt::join(names, ", ")));
  }
  const io::Signals::Channel& channel =
      options.channel.empty() ? signals.channels.front() : io::GetChannel(signals, options.channel);
  const double factor = CalcRimFactor(signals, channel, radius);
  const Section section = FindSection(signals, ReadOption(options.from, "--from", "s"),
                                      ReadOption(options.to, "--to", "s"));
  const auto interpolant =
      options.linear ? signal::Interpolant::kLinear : signal::Interpolant::kCubic;
  const std::size_t count = section.end - section.begin;
  const std::span<const double> time = std::span(signals.time).subspan(section.begin, count);
  if (step && (time.back() - time.front()) / *step > 1e7) {
    Reject("command line", "--step", fmt::format("{:g} s", *step),
           fmt::format("at most ten million steps in {:g} s", time.back() - time.front()));
  }
  const auto make_uniform = [&](const io::Signals::Channel& from) {
    return signal::MakeUniform(time, std::span(from.values).subspan(section.begin, count),
                               interpolant, step.value_or(0.0));
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

  const measures::GammaPlan plan(record.value.size(), record.time_step, conventions);
  measures::GammaWorkspace workspace(plan);
  const measures::Gammas<double> gammas = measures::CalcGammas(record.value, workspace);
  measures::CompanionOptions companion_options;
  companion_options.weighting = conventions.weighting;
  companion_options.short_window = *short_window;
  companion_options.decay_level = conventions.decay_level;
  const measures::Companions companions =
      measures::CalcCompanions({.rim_acceleration = record.value,
                                .torsion_torque = torque,
                                .rack_force = rack_force,
                                .tie_rod_force = tie_rod_force},
                               record.time_step, companion_options);

  const auto units = measures::DescribeUnits(conventions);
  const auto words = measures::DescribeMeasures(conventions);
  nlohmann::ordered_json json;
  nlohmann::ordered_json unit_json, word_json;
  for (std::size_t k = 0; k < measures::kMeasureCount; ++k) {
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
  if (radius) json["record"]["radius"] = *radius;
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
  beside["short_decay_window"] = *short_window;
  if (companions.torsion_torque) {
    beside["torsion_torque"] = MakeJson(*companions.torsion_torque, "N m, N m s, s", record.start);
  }
  if (companions.rack_force)
    beside["rack_force"] = MakeJson(*companions.rack_force, "N, N s, s", record.start);
  if (companions.tie_rod_force) {
    beside["tie_rod_force"] = MakeJson(*companions.tie_rod_force, "N, N s, s", record.start);
  }
  return io::FormatJson(json);
}

}  // namespace

void AddVerbMetrics(CLI::App& app, CommonOptions& common) {
  CLI::App* verb = app.add_subcommand(
      "metrics", "The vibration measures of any recorded signal, as JSON on standard output");
  const auto options = std::make_shared<MetricsOptions>();
  verb->add_option("FILE", options->file,
                   "signals.csv: row 1 names, row 2 units, first column time")
      ->required();
  verb->add_option("--channel", options->channel,
                   "Acceleration to evaluate; may be left out when the file has only one channel");
  verb->add_option("--radius", options->radius,
                   "Rim radius, for a channel in rad/s^2, e.g. '185 mm'");
  verb->add_option(
      "--weighting", options->weighting,
      "Wb .. Wm, Wh (default), Ws, paper, none, or a CSV table of frequency and factor");
  verb->add_option("--from", options->from, "Start of the part to evaluate [s]");
  verb->add_option("--to", options->to, "End of the part to evaluate [s]");
  verb->add_option("--f1", options->f1, "Lower limit of gamma_3 [Hz] (1)");
  verb->add_option("--f2", options->f2, "Upper limit of gamma_3 [Hz] (500)");
  verb->add_option("--window", options->window, "Window of gamma_2 and gamma_4 [s] (0.6)");
  verb->add_option("--decay-level", options->decay_level,
                   "Level of gamma_4 as a share of the largest window energy (0.25)");
  verb->add_option("--short-window", options->short_window,
                   "Window of the short decay time [s] (0.05)");
  verb->add_option("--paper-set", options->paper_set,
                   "Conventions of the identified paper sets, with this c3")
      ->check(CLI::PositiveNumber);
  verb->add_flag("--gamma3-without-root", options->without_root,
                 "Leave out the square root of (3.12), as the paper evidently did");
  verb->add_flag("--normalise-window", options->normalise_window,
                 "Scale the window energy up where the window reaches beyond the record");
  verb->add_flag("--decay-of-set", options->decay_of_set,
                 "gamma_4: time spent above the level instead of first to last crossing");
  verb->add_flag("--sampled-peaks", options->sampled_peaks,
                 "gamma_1: samples as they are, without the parabola");
  verb->add_option("--step", options->step, "Resample to at most this step [s]");
  verb->add_flag("--linear", options->linear, "Resample by straight lines instead of cubics");
  verb->add_option("--torque", options->torque, "Torsion torque channel [N m]");
  verb->add_option("--rack-force", options->rack_force, "Rack force channel [N]");
  verb->add_option("--tie-rod-force", options->tie_rod_force, "Tie-rod force channel [N]");
  AddOutputOption(*verb, common, "File instead of standard output");
  verb->callback([options, &common] {
    const std::string text = CalcMetrics(*options);
    if (!common.output.empty()) {
      io::WriteFileAtomically(common.output, text);
    } else {
      io::WriteStandardOutput(text);
    }
  });
}

}  // namespace kingpin::apps
