#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/io/csv.h"
#include "optimisation/measures/conventions.h"

/// The measures of any recorded signal: what `kingpin metrics` prints.
namespace kingpin::measures {

struct RecordedSignalOptions {
  std::string channel;                            ///< may be empty when there is only one
  std::string torque, rack_force, tie_rod_force;  ///< channels beside it; empty: none
  std::optional<double> radius;                   ///< of the rim [m], for a channel in rad/s^2
  std::optional<double> from, to;                 ///< part to evaluate, by the file's time [s]
  double step = 0.0;           ///< resample to at most this step [s]; 0: as the record is
  double short_window = 0.05;  ///< of the short decay time [s]
  bool linear = false;         ///< resample by straight lines instead of cubics
};

/// Cuts the section out, brings the channel to the rim's acceleration in m/s² (a channel in `g` is
/// taken in units of standard gravity, one in rad/s² is multiplied by the radius), resamples it
/// where its time is not uniform, and evaluates Γ_1 to Γ_5 and what stands beside them. Every
/// number has its unit, every convention its words. Throws io::InputError: no such channel, a unit
/// that is no acceleration, fewer than two samples in the section, a frequency limit above half the
/// sampling rate.
nlohmann::ordered_json EvaluateSignal(const io::Signals& signals, const Conventions& conventions,
                                      const RecordedSignalOptions& options);

}  // namespace kingpin::measures
