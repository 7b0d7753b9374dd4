#include "optimisation/report/case_facts.h"

#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/html.h"
#include "optimisation/report/number_format.h"

namespace kingpin::report {

double GetValue(const std::vector<double>& values, size_t i) {
  return i < values.size() ? values[i] : kMissing;
}

double CalcWeightedRatios(const std::vector<Measure>& measures, const Design& reference,
                          const Design& design) {
  double sum = 0.0;
  bool any = false;
  for (size_t i = 0; i < measures.size(); ++i) {
    if (measures[i].weight == 0.0) continue;
    any = true;
    sum += measures[i].weight * GetValue(design.measures, i) / GetValue(reference.measures, i);
  }
  return any ? sum : kMissing;
}

std::optional<size_t> FindChosenDesign(const std::vector<Measure>& measures, const Case& c) {
  if (c.designs.empty()) return std::nullopt;
  if (c.chosen >= 0 && static_cast<size_t>(c.chosen) < c.designs.size()) {
    return static_cast<size_t>(c.chosen);
  }
  std::optional<size_t> best;
  double lowest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < c.designs.size(); ++i) {
    const double value = CalcWeightedRatios(measures, c.designs[0], c.designs[i]);
    if (std::isfinite(value) && value < lowest) {
      lowest = value;
      best = i;
    }
  }
  return best ? best : c.designs.size() - 1;
}

std::string FormatWithUnit(double si, const DisplayUnit& unit, int significant) {
  std::string out = FormatNumber(si * unit.per_si, significant);
  if (!unit.text.empty()) out += "\u00a0" + PrettyUnit(unit.text);
  return out;
}

std::string MakeVerdict(const std::vector<Measure>& measures, const Case& c) {
  if (!c.verdict.empty()) return c.verdict;
  const std::optional<size_t> chosen = FindChosenDesign(measures, c);
  if (!chosen || *chosen == 0) {
    return c.designs.size() > 1 ? "No design betters the initial one." : std::string();
  }
  const Design& reference = c.designs[0];
  const Design& design = c.designs[*chosen];
  std::string out;
  const double before = CalcWeightedRatios(measures, reference, reference);
  const double after = CalcWeightedRatios(measures, reference, design);
  if (std::isfinite(before) && std::isfinite(after)) {
    out = fmt::format("Design “{}” {} the kickback index from {} to {} ({}).", design.name,
                      after <= before ? "lowers" : "raises", FormatNumber(before, 3),
                      FormatNumber(after, 3), FormatChange(after / before));
  } else {
    out = fmt::format("Design “{}” compared with “{}”.", design.name, reference.name);
  }
  std::string losses;
  for (size_t i = 0; i < measures.size(); ++i) {
    const Measure& m = measures[i];
    const double a = GetValue(reference.measures, i);
    const double b = GetValue(design.measures, i);
    if (!m.headline || !std::isfinite(a) || !std::isfinite(b)) continue;
    out += fmt::format(" {}: {} → {} ({}).", m.name, FormatNumber(a * m.unit.per_si, 3),
                       FormatWithUnit(b, m.unit), FormatChange(b / a));
    if (m.preference == Preference::kHigher && b / a < 0.8) {
      losses +=
          fmt::format(" Part of the gain is paid for: {} falls by more than a fifth.", m.name);
    }
  }
  return out + losses;
}

}  // namespace kingpin::report
