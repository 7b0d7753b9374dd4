#include <algorithm>

#include "optimisation/measures/conventions.h"
#include "optimisation/study/report_parts.h"

namespace kingpin::study {
namespace {

using report::DisplayUnit;
using report::Preference;

template <class Get>
double Largest(const std::vector<measures::Companions>& companions, Get get) {
  double largest = 0.0;
  for (const auto& c : companions) largest = std::max(largest, get(c));
  return largest;
}

}  // namespace

std::vector<report::Measure> MakeMeasures(const StudyResult& study) {
  const auto& conventions = study.cases.front().conventions;
  const auto units = measures::DescribeUnits(conventions);
  const auto definitions = measures::DescribeMeasures(conventions);
  const std::array<const char*, 5> names{
      "Peak-to-peak rim acceleration", "Moving-window vibration level",
      "Frequency-weighted vibration", "Dissipation time", "Root mean square rim acceleration"};
  std::vector<report::Measure> rows;
  for (int k = 0; k < measures::kMeasureCount; ++k) {
    report::Measure row;
    row.symbol = "Γ_" + std::to_string(k + 1);
    row.name = names[k];
    row.unit = {units[k], 1.0};
    row.definition = definitions[k];
    row.weight = study.definition.weights()[k];
    row.headline = k == 0 || k == 4;
    rows.push_back(std::move(row));
  }
  const auto add = [&](const char* name, DisplayUnit unit, const char* definition,
                       Preference preference, double good = report::kMissing,
                       double poor = report::kMissing) {
    report::Measure row;
    row.name = name;
    row.unit = std::move(unit);
    row.definition = definition;
    row.preference = preference;
    row.good = good;
    row.poor = poor;
    rows.push_back(std::move(row));
  };
  const auto lower = Preference::kLower;
  add("Torsion torque, peak-to-peak", {"N*m"},
      "Of the column's torsion torque; largest over the load cases. Orientation only: below 3 N*m "
      "good, above 5.5 N*m disturbing.",
      lower, 3.0, 5.5);
  add("Torsion torque, peak", {"N*m"}, "Largest magnitude over the load cases.", lower);
  add("Rack force, peak", {"kN", 1e-3}, "Of the tie rod on the rack; largest over the load cases.",
      lower);
  add("Tie-rod force, peak", {"kN", 1e-3}, "Axial; largest over the load cases.", lower);
  add("Rim acceleration, r.m.q. (weighted)", {"m/s^2"},
      "Root mean quad of the weighted rim acceleration; largest over the load cases.", lower);
  add("Vibration dose value (weighted)", {"m/s^1.75"},
      "VDV of the weighted rim acceleration, ISO 2631-1; largest over the load cases.", lower);
  add("Decay time, short window", {"ms", 1e3},
      "As Γ_4 with a window of 50 ms; largest over the load cases.", lower);
  add("Road-feel gain", {"N*m/(N*m)"},
      "Torsion torque per moment about the vertical axis on the wheel carrier, steering wheel "
      "held, mean over 0 to 10 Hz.",
      Preference::kHigher);
  add("Steering ratio", {"rad/rad"},
      "Steering wheel angle per road wheel angle at the design position, rigid supports.",
      Preference::kNeutral);
  return rows;
}

std::vector<double> MakeMeasureValues(const DesignResult& design, const DesignDetails& details) {
  std::vector<double> values(design.gammas.begin(), design.gammas.end());
  const auto& c = details.companions;
  using measures::Companions;
  values.push_back(Largest(c, [](const Companions& x) { return x.torsion_torque->peak_to_peak; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.torsion_torque->peak; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.rack_force->peak; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.tie_rod_force->peak; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.weighted.rmq; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.weighted.vdv; }));
  values.push_back(Largest(c, [](const Companions& x) { return x.short_decay_time; }));
  values.push_back(design.road_feel_gain);
  values.push_back(design.steering_ratio);
  return values;
}

}  // namespace kingpin::study
