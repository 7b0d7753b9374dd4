#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/common_options.h"
#include "apps/run_support.h"
#include "core/io/csv.h"
#include "core/io/error.h"
#include "core/io/json_text.h"
#include "core/io/output_file.h"
#include "core/io/units.h"
#include "optimisation/measures/conventions.h"
#include "optimisation/measures/recorded_signal.h"

namespace kingpin::apps {

namespace {

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

std::string CalcMetrics(const MetricsOptions& options) {
  const measures::Conventions conventions = ReadConventions(options);
  measures::RecordedSignalOptions recorded;
  recorded.channel = options.channel;
  recorded.torque = options.torque;
  recorded.rack_force = options.rack_force;
  recorded.tie_rod_force = options.tie_rod_force;
  recorded.radius = ReadOption(options.radius, "--radius", "m");
  recorded.from = ReadOption(options.from, "--from", "s");
  recorded.to = ReadOption(options.to, "--to", "s");
  recorded.linear = options.linear;
  const auto read = [](double* target, const std::string& text, const char* option) {
    const auto value = ReadOption(text, option, "s");
    if (!value) return;
    if (*value <= 0.0) {
      Reject("command line", option, fmt::format("{:g} s", *value), "a positive time");
    }
    *target = *value;
  };
  read(&recorded.step, options.step, "--step");
  read(&recorded.short_window, options.short_window, "--short-window");
  return io::FormatJson(
      measures::EvaluateSignal(io::ReadSignals(options.file), conventions, recorded));
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
    CheckOutputFile(common, {options->file, options->weighting});
    const std::string text = CalcMetrics(*options);
    if (!common.output.empty()) {
      io::WriteFileAtomically(common.output, text);
    } else {
      io::WriteStandardOutput(text);
    }
  });
}

}  // namespace kingpin::apps
