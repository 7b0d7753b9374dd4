#pragma once

#include <optional>
#include <span>

#include "core/signal/weighting.h"

/// What stands beside the paper's five measures: numbers that a ride engineer knows, and the
/// forces.
namespace kingpin::measures {

/// Extremes of a force or a torque over a record.
struct Extremes {
  double maximum = 0.0;
  double minimum = 0.0;
  double peak = 0.0;          ///< largest magnitude
  double time_of_peak = 0.0;  ///< from the record's start [s]
  double peak_to_peak = 0.0;
  double impulse = 0.0;  ///< ∫ x dt over the record, with its sign (13/24 rule)
};

/// Statistics of a vibration a [m/s²] of duration T.
struct VibrationStatistics {
  double peak = 0.0;  ///< max |a| [m/s²]
  double rms = 0.0;   ///< (1/T ∫ a² dt)^{1/2} [m/s²]
  double rmq = 0.0;   ///< root mean quad (1/T ∫ a⁴ dt)^{1/4} [m/s²]
  double vdv = 0.0;   ///< vibration dose value (∫ a⁴ dt)^{1/4} [m/s^1.75], ISO 2631-1 (6.3.2)
  double mtvv = 0.0;  ///< largest running r.m.s. over 1 s [m/s²], ISO 2631-1 (6.3.1)
  double mtvv_eighth = 0.0;   ///< the same over 0.125 s [m/s²]
  double crest_factor = 0.0;  ///< peak/rms [-]; 0 for a record of zeros
};

struct Companions {
  VibrationStatistics unweighted;
  VibrationStatistics weighted;  ///< of the record passed through the weighting's H(f)
  /// Γ_4's rule with a short window: time from the first to the last crossing of κ max g [s]. With
  /// the paper's 0.6 s a single knock already gives 0.6 s.
  double short_decay_time = 0.0;
  std::optional<Extremes> torsion_torque;  ///< [N m]
  std::optional<Extremes> rack_force;      ///< [N]
  std::optional<Extremes> tie_rod_force;   ///< [N]
};

/// Records of one run, all with the same step; those that are absent are empty.
struct CompanionRecords {
  std::span<const double> rim_acceleration;  ///< [m/s²]
  std::span<const double> torsion_torque;    ///< [N m]
  std::span<const double> rack_force;        ///< [N]
  std::span<const double> tie_rod_force;     ///< [N]
};

struct CompanionOptions {
  signal::Weighting weighting = signal::Weighting::Named("Wh");
  double short_window = 0.05;  ///< [s]; 0.02 to 0.05 s is usual
  double decay_level = 0.25;   ///< κ_DS
};

/// Values that are not finite give NaN, as in the measures.
Extremes CalcExtremes(std::span<const double> record, double time_step);

/// Running r.m.s. values are linear averages over the window that ends at t (ISO 2631-1, (2)), with
/// zeros before the record.
VibrationStatistics CalcVibrationStatistics(std::span<const double> record, double time_step);

Companions CalcCompanions(const CompanionRecords& records, double time_step,
                          const CompanionOptions& options = {});

/// Mean of the magnitude |H| of a frequency response over [f_low, f_high], (1/Δf) ∫ |H| df with
/// straight lines between the points: how much of the wanted part of the road reaches the hand. H
/// is the response of the torsion torque to a moment about the kingpin with the wheel held. An
/// optimum that lowers kickback by lowering this one has disconnected the driver.
///
/// Frequencies [Hz] strictly increasing; below the first one its value is held.
/// @throws io::InputError when there are no points, they do not increase or end below f_high.
double CalcRoadFeelGain(std::span<const double> frequency, std::span<const double> magnitude,
                        double f_low = 0.0, double f_high = 10.0);

}  // namespace kingpin::measures
