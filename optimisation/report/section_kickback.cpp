#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/case_facts.h"
#include "optimisation/report/html.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/sections.h"
#include "optimisation/report/table.h"

namespace kingpin::report {
namespace {

/// Marks a value that meets its target or is poor; with characters, so that greyscale shows it.
std::string MakeTargetMark(const Measure& m, double value) {
  if (!std::isfinite(value)) return {};
  const bool lower = m.preference != Preference::kHigher;
  if (std::isfinite(m.good) && (lower ? value <= m.good : value >= m.good)) {
    return "<span class=\"mark\">✓</span>";
  }
  if (std::isfinite(m.poor) && (lower ? value >= m.poor : value <= m.poor)) {
    return "<span class=\"mark\">▲</span>";
  }
  return {};
}

bool HasTarget(const Measure& m) { return std::isfinite(m.good) || std::isfinite(m.poor); }

void AddTargetNote(const std::vector<Measure>& measures, Page& page) {
  std::vector<std::string> texts;
  for (const Measure& m : measures) {
    if (!HasTarget(m)) continue;
    std::string text = m.name + ":";
    const bool lower = m.preference != Preference::kHigher;
    if (std::isfinite(m.good)) {
      text +=
          fmt::format(" ✓ {} {}", lower ? "up to" : "from", FormatShort(m.good * m.unit.per_si, 3));
    }
    if (std::isfinite(m.poor)) {
      text += fmt::format("{} ▲ {} {}", std::isfinite(m.good) ? "," : "", lower ? "from" : "up to",
                          FormatShort(m.poor * m.unit.per_si, 3));
    }
    texts.push_back(text + " " + PrettyUnit(m.unit.text));
  }
  if (texts.empty()) return;
  page.AddParagraph(
      fmt::format("Orientation targets (engineering judgement, no published source): {}.",
                  fmt::join(texts, "; ")),
      "meta");
}

}  // namespace

void AddKickbackCard(const std::vector<Measure>& measures, const Case& c, Page& page) {
  const bool any = std::any_of(c.designs.begin(), c.designs.end(),
                               [](const Design& d) { return !d.measures.empty(); });
  if (!any || measures.empty()) return;
  page.AddHeading(3, "Kickback card");
  const std::string verdict = MakeVerdict(measures, c);
  if (!verdict.empty()) page.Add(MakeCallout(CalloutKind::kVerdict, "", {verdict}));
  page.Add(MakeCallout(CalloutKind::kWarning, "Read with care", c.warnings));

  const Design& reference = c.designs[0];
  Table table;
  std::vector<Cell> names = {TextCell("Measure"), TextCell(""), TextCell("Unit"),
                             TextCell(reference.name, "n group")};
  std::vector<Cell> columns = {TextCell(""), TextCell(""), TextCell(""),
                               TextCell("value", "n group")};
  for (size_t d = 1; d < c.designs.size(); ++d) {
    Cell cell = TextCell(c.designs[d].name, "group c");
    cell.span = 2;
    names.push_back(cell);
    columns.push_back(TextCell("value", "n group"));
    columns.push_back(TextCell("ratio", "n"));
  }
  table.AddHeader(names);
  table.AddHeader(columns);

  bool weighted_before = false;
  for (size_t i = 0; i < measures.size(); ++i) {
    const Measure& m = measures[i];
    const bool present = std::any_of(c.designs.begin(), c.designs.end(), [&](const Design& d) {
      return !std::isnan(GetValue(d.measures, i));
    });
    if (!present) continue;
    std::vector<Cell> row = {HtmlCell(SymbolHtml(m.symbol), "sym"), TextCell(m.name),
                             TextCell(PrettyUnit(m.unit.text), "muted")};
    std::vector<double> shown;
    for (const Design& d : c.designs) shown.push_back(GetValue(d.measures, i) * m.unit.per_si);
    const RowFormat format(shown);
    for (size_t d = 0; d < c.designs.size(); ++d) {
      const double value = GetValue(c.designs[d].measures, i);
      Cell cell = HtmlCell(format.Format(shown[d]), "n");
      cell.html += MakeTargetMark(m, value);
      cell.css += " group";
      row.push_back(cell);
      if (d > 0) row.push_back(RatioCell(value / GetValue(reference.measures, i), m.preference));
    }
    const bool separate = weighted_before && m.weight == 0.0;
    weighted_before = m.weight != 0.0;
    table.AddRow(row, separate ? "sep" : "");
  }

  const auto add_total = [&](const char* symbol, const char* name, bool with_ratios,
                             const auto& value_of) {
    const double before = value_of(reference);
    if (!std::isfinite(before)) return;
    std::vector<Cell> row = {HtmlCell(symbol, "sym"), TextCell(name), TextCell("–", "muted")};
    for (size_t d = 0; d < c.designs.size(); ++d) {
      const double value = value_of(c.designs[d]);
      row.push_back(NumberCell(value));
      row.back().css += " group";
      if (d == 0) continue;
      row.push_back(with_ratios ? RatioCell(value / before, Preference::kLower) : TextCell(""));
    }
    table.AddRow(row, "total");
  };
  add_total("<i>I</i><sub>V</sub>", "Kickback index: weighted sum of the ratios", true,
            [&](const Design& d) { return CalcWeightedRatios(measures, reference, d); });
  const bool other = std::any_of(c.designs.begin(), c.designs.end(), [&](const Design& d) {
    const double sum = CalcWeightedRatios(measures, reference, d);
    return std::isfinite(d.objective) && !(std::abs(d.objective - sum) <= 1e-6 * std::abs(sum));
  });
  if (other) {
    // Relative to the design its note names, so that a ratio to the first one would mean nothing.
    add_total("", "Objective of the search, with its own reference", false,
              [](const Design& d) { return d.objective; });
  }
  page.Add(table.MakeHtml("card"));
  page.AddParagraph(
      fmt::format(
          "Ratio: value divided by that of “{}”. Shading: blue is better, orange worse, the "
          "deeper the further from 1.",
          reference.name),
      "meta");
  AddTargetNote(measures, page);
  for (const Design& d : c.designs) {
    if (!d.note.empty()) page.AddParagraph(d.name + ": " + d.note, "meta");
  }
}

void AddDesignVariables(const Case& c, Page& page) {
  const bool any = std::any_of(c.designs.begin(), c.designs.end(),
                               [](const Design& d) { return !d.variables.empty(); });
  if (!any || c.variables.empty()) return;
  page.AddHeading(3, "Design variables");
  Table table;
  std::vector<Cell> header = {TextCell("Variable"), TextCell(""), TextCell("Unit"),
                              TextCell("lower bound", "n"), TextCell("upper bound", "n")};
  for (const Design& d : c.designs) header.push_back(TextCell(d.name, "n group"));
  table.AddHeader(header);
  bool at_bound = false;
  for (size_t i = 0; i < c.variables.size(); ++i) {
    const Variable& v = c.variables[i];
    std::vector<Cell> row = {HtmlCell(SymbolHtml(v.symbol), "sym"),
                             TextCell(v.locked ? v.name + " (held)" : v.name),
                             TextCell(PrettyUnit(v.unit.text), "muted"),
                             HtmlCell(v.locked ? "–" : FormatShort(v.lower * v.unit.per_si), "n"),
                             HtmlCell(v.locked ? "–" : FormatShort(v.upper * v.unit.per_si), "n")};
    std::vector<double> shown;
    for (const Design& d : c.designs) shown.push_back(GetValue(d.variables, i) * v.unit.per_si);
    const RowFormat format(shown, 5);
    for (size_t d = 0; d < c.designs.size(); ++d) {
      const double value = GetValue(c.designs[d].variables, i);
      Cell cell = HtmlCell(format.Format(shown[d]), "n");
      cell.css += " group";
      const Design& design = c.designs[d];
      const double lower = i < design.lower.size() ? design.lower[i] : v.lower;
      const double upper = i < design.upper.size() ? design.upper[i] : v.upper;
      const double slack = 1e-6 * (upper - lower);
      if (!v.locked && (value - lower <= slack || upper - value <= slack)) {
        cell.html +=
            fmt::format("<span class=\"mark\">{}</span>", value - lower <= slack ? "⊥" : "⊤");
        cell.css += " b";
        at_bound = true;
      }
      row.push_back(cell);
    }
    table.AddRow(row);
  }
  page.Add(table.MakeHtml());
  if (at_bound)
    page.AddParagraph(
        "⊥ on the lower bound of its stage, ⊤ on the upper one. The bounds listed are the widest "
        "of "
        "all stages.",
        "meta");
}

}  // namespace kingpin::report
