#pragma once

#include <optional>
#include <string>

#include "optimisation/report/study_report_data.h"

namespace kingpin::report {

/// values[i], or NaN when there is none.
double GetValue(const std::vector<double>& values, size_t i);

/// I_V = Σ ε_k Γ_k / Γ_k(reference) over the measures with a weight; NaN when there is no weight or
/// a weighted measure is missing.
double CalcWeightedRatios(const std::vector<Measure>& measures, const Design& reference,
                          const Design& design);

/// The design the verdict is about: Case::chosen, else the one with the lowest I_V relative to the
/// first design, else the last. (Objectives of searches may be relative to other designs.) Absent
/// when there are no designs.
std::optional<size_t> FindChosenDesign(const std::vector<Measure>& measures, const Case& c);

/// One or two sentences from the numbers, or Case::verdict.
std::string MakeVerdict(const std::vector<Measure>& measures, const Case& c);

/// A value in its display unit, with the unit: `3.30 N·m`.
std::string FormatWithUnit(double si, const DisplayUnit& unit, int significant = 3);

}  // namespace kingpin::report
