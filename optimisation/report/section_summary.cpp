#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/case_facts.h"
#include "optimisation/report/html.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/sections.h"
#include "optimisation/report/table.h"

namespace kingpin::report {
namespace {

/// One row per case: kickback index and headline measures, start → chosen design.
std::string MakeOverview(const StudyReportData& data) {
  std::vector<size_t> headlines;
  for (size_t i = 0; i < data.measures.size(); ++i) {
    if (data.measures[i].headline) headlines.push_back(i);
  }
  Table table;
  std::vector<Cell> names = {TextCell("Case"), TextCell("Best design")};
  std::vector<Cell> columns = {TextCell(""), TextCell("")};
  const auto add_group = [&](std::string name) {
    Cell cell = HtmlCell(std::move(name), "group c");
    cell.span = 3;
    names.push_back(cell);
    columns.push_back(TextCell("initial", "n group"));
    columns.push_back(TextCell("best", "n"));
    columns.push_back(TextCell("change", "n"));
  };
  add_group("Kickback index");
  for (const size_t i : headlines) {
    add_group(WithUnit(data.measures[i].name, data.measures[i].unit.text));
  }
  table.AddHeader(names);
  table.AddHeader(columns);
  for (const Case& c : data.cases) {
    const std::optional<size_t> chosen = FindChosenDesign(data.measures, c);
    if (!chosen) continue;
    const Design& reference = c.designs[0];
    const Design& design = c.designs[*chosen];
    std::vector<Cell> row = {TextCell(c.name, "b"), TextCell(design.name)};
    const auto add_values = [&](double a, double b, Preference preference) {
      row.push_back(NumberCell(a, 3));
      row.back().css += " group";
      row.push_back(NumberCell(b, 3));
      Cell change = RatioCell(b / a, preference);
      change.html = FormatChange(b / a);
      row.push_back(change);
    };
    add_values(CalcWeightedRatios(data.measures, reference, reference),
               CalcWeightedRatios(data.measures, reference, design), Preference::kLower);
    for (const size_t i : headlines) {
      const Measure& m = data.measures[i];
      add_values(GetValue(reference.measures, i) * m.unit.per_si,
                 GetValue(design.measures, i) * m.unit.per_si, m.preference);
    }
    table.AddRow(row);
  }
  return table.empty() ? std::string() : table.MakeHtml();
}

}  // namespace

void AddSummary(const StudyReportData& data, Page& page) {
  page.Add(
      fmt::format("<h1>{}</h1>\n", EscapeHtml(data.title.empty() ? "Kingpin report" : data.title)));
  page.AddParagraph(data.subtitle, "sub");
  std::vector<std::string> meta;
  if (!data.created.empty()) meta.push_back(EscapeHtml(data.created));
  if (!data.program.empty()) meta.push_back(EscapeHtml(data.program));
  if (std::isfinite(data.run_seconds)) {
    meta.push_back("run time " + FormatDuration(data.run_seconds));
  }
  if (!data.command.empty()) meta.push_back("<code>" + EscapeHtml(data.command) + "</code>");
  if (!meta.empty()) page.Add(fmt::format("<p class=\"meta\">{}</p>\n", fmt::join(meta, " · ")));

  page.AddHeading(2, "Summary", "first");
  std::string list;
  for (const Case& c : data.cases) {
    const std::string verdict = MakeVerdict(data.measures, c);
    if (verdict.empty()) continue;
    list += fmt::format("<li><b>{}.</b> {}</li>\n", EscapeHtml(c.name), SymbolHtml(verdict));
  }
  for (const std::string& text : data.summary) list += "<li>" + SymbolHtml(text) + "</li>\n";
  if (!list.empty()) page.Add("<ul class=\"lead\">" + list + "</ul>\n");
  page.Add(MakeOverview(data));
  std::vector<std::string> warnings = data.warnings;
  for (const Case& c : data.cases) {
    for (const std::string& warning : c.warnings) {
      warnings.push_back(c.name.empty() ? warning : c.name + ": " + warning);
    }
  }
  page.Add(MakeCallout(CalloutKind::kWarning, "Read with care", warnings));
}

}  // namespace kingpin::report
